"""Bad input to ``snowshed slide``: exit code 2, error and position, and no files."""

import json
import os

import numpy as np
import pytest
from helpers.slide_files import box, plane, write_features, write_polygons, write_project

from snowshed.cli.main import main
from snowshed.io.raster.raster import Raster, read_raster, write_ascii_grid

pytest.importorskip("pyogrio")
pytest.importorskip("shapely")

pytestmark = pytest.mark.usefixtures("undrawn")

WITHIN = box(10, 10, 30, 30)


def with_hole(at):
    raster = plane()
    raster.heights[at] = np.nan
    return raster


def scaled(vertical=1.0, horizontal=1.0, degrees=38.0):
    raster = plane(degrees)
    return Raster(raster.heights * vertical, 0.0, 0.0, raster.cell * horizontal)


def slide(folder, raster=None, rings=WITHIN, crs="EPSG:31287", options=(), **fields):
    """Run a slide on a raster and a polygon; return the exit code."""
    if not (folder / "dem.asc").exists():
        write_ascii_grid(folder / "dem.asc", raster or plane())
    fields = fields or {"thickness": 0.5}
    write_polygons(folder / "rel.geojson", rings, crs, **fields)
    files = ["--terrain", folder / "dem.asc", "--release", folder / "rel.geojson"]
    return main(["slide", *map(str, files), "-o", str(folder / "out"), "-q", *map(str, options)])


def refused(folder, capsys, message, files, **case):
    assert slide(folder, **case) == 2
    assert message in capsys.readouterr().err
    assert {file.name for file in folder.iterdir()} == files


@pytest.mark.parametrize(
    ("case", "message"),
    [
        ({"raster": with_hole((10, 10))}, "the terrain has a hole there: no elevation at (20, 20)"),
        ({"rings": box(60, 10, 90, 30)}, "reaches beyond the terrain, which extends from (0, 0)"),
        ({"rings": box(500, 500, 520, 520)}, "lies beside the terrain"),
        ({"rings": [[[10, 10], [30, 30], [30, 10], [10, 30], [10, 10]]]}, "Self-intersection"),
        ({"thickness": 0}, "thickness is 0 m; give one above 0"),
        ({"thickness": "nan"}, "the file gives no thickness"),
        ({"thickness": 0.5, "options": ["--thickness", "nan"]}, "thickness"),
        ({"thickness": 0.001}, "0.001 m of snow; at least 0.01 m are needed"),
        ({"crs": "EPSG:4326"}, "its coordinates are in degrees"),
        ({"raster": scaled(8.0)}, "do not occur on Earth"),
        ({"raster": scaled(horizontal=1 / 0.6096)}, "are 1 m in feet"),
        ({"raster": scaled(horizontal=200.0)}, "cells of 400 m"),
        ({"raster": scaled(1 / 0.3048 / 2, degrees=60.0)}, "is steeper than 71 degrees"),
    ],
    ids=[
        "hole", "beyond", "beside", "crossing", "zero", "nothing", "nan", "thin", "degrees",
        "feet_high", "feet_wide", "wide", "feet_steep",
    ],
)  # fmt: skip
def test_implausible_input_is_refused(tmp_path, capsys, case, message):
    refused(tmp_path, capsys, message, {"dem.asc", "rel.geojson"}, **case)


def test_a_raster_that_is_not_finite_or_too_large_is_refused(tmp_path, capsys):
    header = "ncols {}\nnrows {}\nxllcenter 0\nyllcenter 0\ncellsize 2\n"
    for text, message in (
        (header.format(2, 2) + "1 2 inf 4\n", "dem.asc:6: 'inf' is not a valid number"),
        (header.format(4000, 4000) + "1 2 3\n", "the file is too short"),
        (header.format(40000, 40000) + "1 2 3\n", "1600000000 cells; at most 25000000"),
        (header.format(90000, 2) + "1 2 3\n", "ncols must be a whole number from 2 to 50000"),
    ):
        (tmp_path / "dem.asc").write_text(text)
        refused(tmp_path, capsys, message, {"dem.asc", "rel.geojson"})


def test_release_areas_must_not_overlap(tmp_path, capsys):
    write_ascii_grid(tmp_path / "dem.asc", plane())
    areas = [(WITHIN, {"name": "A"}), (box(20, 20, 40, 40), {"name": "B"})]
    write_features(tmp_path / "rel.geojson", areas)
    arguments = ["--terrain", tmp_path / "dem.asc", "--release", tmp_path / "rel.geojson"]
    options = ["--thickness", "0.5", "-o", tmp_path / "out"]
    assert main(["slide", *map(str, arguments + options)]) == 2
    assert "rel.geojson: A and B overlap" in capsys.readouterr().err


def test_the_prj_file_of_an_ascii_grid_is_read(tmp_path, capsys):
    rasterio = pytest.importorskip("rasterio")
    system = rasterio.crs.CRS.from_epsg(2056)
    (tmp_path / "dem.prj").write_text(system.to_wkt(version="WKT1_ESRI"))
    files = {"dem.asc", "dem.prj", "rel.geojson"}
    message = "different coordinate systems, EPSG:2056"
    refused(tmp_path, capsys, message, files)
    assert slide(tmp_path, crs="EPSG:2056", options=["--max-time", "0.1"]) == 0
    assert rasterio.open(tmp_path / "out/peaks/pft.asc").crs.to_epsg() == 2056


def test_the_copy_of_terrain_is_removed_on_failure(tmp_path, capsys):
    rasterio = pytest.importorskip("rasterio")
    with rasterio.open(
        tmp_path / "dem.tif", "w", driver="GTiff", height=30, width=40, count=1, dtype="float64",
        crs="EPSG:31287", transform=rasterio.Affine(2, 0, -1, 0, -2, 59),
    ) as target:  # fmt: skip
        target.write(plane().heights[::-1], 1)
    write_polygons(tmp_path / "rel.geojson", box(60, 10, 90, 30), thickness=0.5)
    arguments = ["--terrain", tmp_path / "dem.tif", "--release", tmp_path / "rel.geojson"]
    assert main(["slide", *map(str, arguments), "-o", str(tmp_path / "out"), "-q"]) == 2
    assert {file.name for file in tmp_path.iterdir()} == {"dem.tif", "rel.geojson"}


def test_snow_lost_in_a_hole_of_the_terrain_is_noted(tmp_path, capsys):
    raster = plane()
    raster.heights[:, 20:24] = np.nan
    assert slide(tmp_path, raster, options=["--max-time", "8", "--no-bonds"]) == 0
    summary = json.loads((tmp_path / "out/slide.json").read_text())
    assert summary["left_terrain_kg"] > 0
    assert any("no elevation" in note for note in summary["notes"])


def depth_raster(folder, heights, west=12.0, south=12.0):
    write_ascii_grid(folder / "depth.asc", Raster(np.array(heights), west, south, 4.0))
    return folder / "depth.asc"


DEPTH = np.full((4, 4), 0.5)


def test_a_raster_of_thickness_defines_the_release(tmp_path):
    write_ascii_grid(tmp_path / "dem.asc", plane())
    values = DEPTH.copy()
    values[1:3, 1] = 0.8
    values[0, 0] = 0.0
    depth = depth_raster(tmp_path, values)
    arguments = [
        "--terrain",
        tmp_path / "dem.asc",
        "--thickness-raster",
        depth,
        "--max-time",
        "0.1",
    ]
    assert main(["slide", *map(str, arguments), "-o", str(tmp_path / "out"), "-q"]) == 0
    summary = json.loads((tmp_path / "out/slide.json").read_text())
    sloping = 16.0 / np.cos(np.radians(38.0))
    assert summary["released_kg"] == pytest.approx(values.sum() * sloping * 300.0, rel=1e-6)
    thickness = read_raster(tmp_path / "out/peaks/pft.asc")
    assert thickness.heights.max() == pytest.approx(0.8, rel=0.25)


@pytest.mark.parametrize(
    ("change", "options", "message"),
    [
        (-0.5, (), "a negative thickness at (16, 16)"),
        (np.nan, (), "no thickness amid snow at (16, 16)"),
        (np.nan, ("--release",), "the thickness raster has no value at (16"),
        (0.0, ("--release",), "the thickness raster has 0.000000 m at (16"),
        (0.5, ("--thickness", "1"), "one of a thickness and a raster of thickness"),
    ],
    ids=["negative", "gap", "hole", "zero", "twice"],
)
def test_a_raster_of_thickness_must_be_complete(tmp_path, capsys, change, options, message):
    write_ascii_grid(tmp_path / "dem.asc", plane())
    values = DEPTH.copy()
    values[1, 1] = change
    depth = depth_raster(tmp_path, values)
    if options == ("--release",):
        options = ("--release", write_polygons(tmp_path / "rel.geojson", box(11, 11, 25, 25)))
    arguments = ["--terrain", tmp_path / "dem.asc", "--thickness-raster", depth, *options]
    assert main(["slide", *map(str, arguments), "-o", str(tmp_path / "out"), "-q"]) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_raster_of_thickness_must_cover_the_release(tmp_path, capsys):
    depth = depth_raster(tmp_path, DEPTH)
    options = ["--thickness-raster", depth]
    refused(
        tmp_path, capsys, "reaches beyond the thickness raster",
        {"dem.asc", "rel.geojson", "depth.asc"}, options=options,
    )  # fmt: skip


def test_resuming_with_changed_files_is_refused_by_name(tmp_path, capsys):
    assert slide(tmp_path, options=["--max-time", "0.1"]) == 0
    resume = ["--resume", "--max-time", "0.1"]
    assert slide(tmp_path, options=resume) == 0
    assert slide(tmp_path, rings=box(10, 10, 30, 28), options=resume) == 2
    assert "rel.geojson: has changed since the run in" in capsys.readouterr().err
    steeper = plane(40.0)
    write_ascii_grid(tmp_path / "dem.asc", steeper)
    assert main(["slide", "--resume", "-o", str(tmp_path / "out"), "-q"]) == 2
    message = capsys.readouterr().err
    assert f"{os.path.realpath(tmp_path / 'dem.asc')}: has changed since the checkpoint" in message


def test_resuming_a_project_with_changed_areas_names_their_file(tmp_path, capsys):
    project = write_project(tmp_path / "project", "tEnd = 0.1\n")
    command = ["slide", "--avaframe", str(project), "-o", str(tmp_path / "out"), "-q"]
    assert main(command) == 0
    write_polygons(project / "Inputs/REL/rel.geojson", box(10, 10, 28, 30), thickness=0.5)
    assert main([*command, "--resume"]) == 2
    assert "rel.geojson: has changed since the run in" in capsys.readouterr().err


def test_the_mass_balance_closes(tmp_path):
    write_polygons(tmp_path / "ent.geojson", box(34, 5, 60, 50), thickness=0.2)
    options = ["--entrainment-areas", tmp_path / "ent.geojson", "--max-time", "25", "--no-bonds"]
    assert slide(tmp_path, options=options) == 0
    kg = json.loads((tmp_path / "out/slide.json").read_text())
    supplied = kg["released_kg"] + kg["entrained_kg"]
    remaining = kg["left_terrain_kg"] + kg["on_terrain_kg"]
    assert kg["entrained_kg"] > 0
    assert kg["left_terrain_kg"] > 0
    assert remaining == pytest.approx(supplied, rel=1e-12)


def summary_notes(folder):
    data = json.loads((folder / "out/slide.json").read_text())
    notes = data["notes"]
    assert json.loads((folder / "out/run.json").read_text())["notes"] == notes
    return notes


def test_the_thickness_in_a_file_is_not_named_where_an_option_replaces_it(tmp_path):
    assert slide(tmp_path, options=["--thickness", "0.7", "--max-time", "0.1"], d0=0.5) == 0
    notes = summary_notes(tmp_path)
    assert any("thickness is that of --thickness, not of its field 'd0'" in note for note in notes)
    assert not any("is that of its field" in note for note in notes)


def test_an_area_below_a_cell_is_noted_in_the_results(tmp_path):
    assert slide(tmp_path, rings=box(20, 20, 21, 21), options=["--max-time", "0.1"]) == 0
    assert any("area 1: smaller than a cell of the terrain" in n for n in summary_notes(tmp_path))


def test_terrain_without_a_coordinate_system_takes_that_of_the_areas_with_a_note(tmp_path):
    assert slide(tmp_path, options=["--max-time", "0.1"]) == 0
    assumed = "dem.asc: has no coordinate system; that of the other files (EPSG:31287) is assumed"
    assert any(note.endswith(assumed) for note in summary_notes(tmp_path))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--runs", "5"), "--runs has no effect without --range"),
        (("--pressures", "5"), "--pressures has no effect without --range"),
        (("--resistance-layer", "wood"), "--resistance-layer has no effect without a file"),
        (("--thickness-band", "2"), "--thickness-band has no effect without --thickness-raster"),
        (
            ("--range", "mu=0.3:0.4", "--particles-at", "3"),
            "--particles-at has no effect with --range",
        ),
    ],
)
def test_options_without_effect_are_refused(tmp_path, capsys, options, message):
    assert slide(tmp_path, options=options) == 2
    assert message in capsys.readouterr().err


def test_the_thickness_of_the_example_cannot_be_given(tmp_path, capsys):
    options = ("--example", "--thickness", "0.7", "-o", str(tmp_path / "out"))
    assert main(["slide", *options]) == 2
    assert "--thickness has no effect with --example" in capsys.readouterr().err


def test_results_may_go_into_the_current_folder(tmp_path, monkeypatch):
    folder = tmp_path / "here"
    folder.mkdir()
    monkeypatch.chdir(folder)
    assert main(["slide", "--example", "--max-time", "0.1", "-q", "-o", "."]) == 0
    assert (folder / "slide.json").is_file()
    assert (tmp_path / "here-terrain/terrain.asc").is_file()


def test_maps_of_many_slides_have_the_notes_on_their_files(tmp_path):
    ranges = ["--range", "thickness=0.3:0.6", "--runs", "2", "--jobs", "1", "--max-time", "0.1"]
    assert slide(tmp_path, options=ranges, d0=0.5) == 0
    notes = json.loads((tmp_path / "out/hazard.json").read_text())["notes"]
    assert notes[0].endswith("the thickness is that of its field 'd0', in m")
    assert "the thickness of the release varies between the runs, whatever its file says" in notes
    assert "whatever its file says" in (tmp_path / "out/hazard.html").read_text()
