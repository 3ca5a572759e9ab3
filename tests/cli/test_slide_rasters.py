"""``snowshed slide`` on common rasters: notes, bands, limits, and refused files."""

import json

import numpy as np
import pytest
from helpers.raster_files import CELL, SIDE, in_unit, scaled, write_geotiff
from helpers.slide_files import box, plane, write_polygons

from snowshed import Scene
from snowshed.cli.main import main
from snowshed.io.raster.raster import Raster, write_ascii_grid

pytest.importorskip("pyogrio")
rasterio = pytest.importorskip("rasterio")

pytestmark = pytest.mark.usefixtures("undrawn")

#: Elevations, m: a slope of 33 degrees that falls to the east.
STEEP = 900.0 - 0.65 * CELL * np.arange(30)[None, :] * np.ones((30, 1))
FORM = {"transform": rasterio.Affine(CELL, 0, -CELL / 2, 0, -CELL, 29.5 * CELL)}
WITHIN = box(20, 40, 50, 80)


def slide(folder, *options, thickness=0.5, rings=WITHIN):
    """Run a short slide on dem.tif or dem.asc; return the exit code."""
    dem = next(folder.glob("dem.*"))
    write_polygons(folder / "rel.geojson", rings, "EPSG:25833", thickness=thickness)
    arguments = ["--terrain", dem, "--release", folder / "rel.geojson", "--max-time", "0.1"]
    return main(["slide", *map(str, [*arguments, "-o", folder / "out", *options])])


def released(folder):
    return json.loads((folder / "out/slide.json").read_text())["released_kg"]


def test_a_note_is_on_the_terminal_in_the_json_on_the_page_and_in_the_scene(
    tmp_path, capsys, drawn
):
    write_geotiff(tmp_path / "dem.tif", STEEP / 0.3048, change=in_unit("ft"), **FORM)
    assert slide(tmp_path) == 0
    note = "dem.tif: its values were converted to metres; one unit is 0.3048 m"
    printed = capsys.readouterr()
    assert printed.err.count(note) == 1 and note not in printed.out
    assert note in json.loads((tmp_path / "out/slide.json").read_text())["notes"]
    page = (tmp_path / "out/slide.html").read_text()
    assert page.count(note) == 1
    assert page.index("Notes on the files:") < page.index(note)
    assert json.loads((tmp_path / "out/scene.json").read_text())["terrain"]["notes"] == note


def test_notes_without_a_summary_are_printed(tmp_path, capsys, monkeypatch):
    write_geotiff(tmp_path / "dem.tif", STEEP / 0.3048, change=in_unit("ft"), **FORM)
    note = "dem.tif: its values were converted to metres; one unit is 0.3048 m"
    assert slide(tmp_path, "--dry-run") == 0
    assert capsys.readouterr().err.count(note) == 1

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("snowshed.methods.slide.run.SlideRun.finish", full)
    assert slide(tmp_path) == 3
    printed = capsys.readouterr()
    assert printed.err.count(note) == 1 and note not in printed.out


def test_units_factors_and_bands_give_the_same_mass(tmp_path):
    masses = []
    for name, bands, dtype, change, options in (
        ("metres", STEEP, "float64", None, ()),
        ("feet", STEEP / 0.3048, "float64", in_unit("ft"), ()),
        ("centimetres", np.round(STEEP * 100), "int32", scaled(0.01), ()),
        ("second", np.stack([STEEP * 0 + 33, STEEP]), "float64", None, ("--band", "2")),
    ):
        folder = tmp_path / name
        folder.mkdir()
        write_geotiff(folder / "dem.tif", bands, dtype, change, **FORM)
        assert slide(folder, "-q", *options) == 0
        masses.append(released(folder))
    sloping = 30 * 40 / np.cos(np.arctan(0.65))
    assert masses == pytest.approx([0.5 * sloping * 300.0] * 4, rel=1e-4)


@pytest.mark.filterwarnings("ignore::snowshed.SnowshedNote")
@pytest.mark.parametrize(
    ("change", "options"),
    [
        pytest.param(scaled(0.01), (), marks=pytest.mark.slow),
        (in_unit("cm"), ()),
        pytest.param(None, ("--thickness-band", "2"), marks=pytest.mark.slow),
    ],
    ids=["scale", "centimetres", "band"],
)
def test_units_factors_and_bands_give_the_same_thickness(tmp_path, change, options):
    write_ascii_grid(tmp_path / "dem.asc", plane())
    depth = np.full((SIDE, SIDE), 0.0)
    depth[4:8, 4:8] = 0.5
    bands = np.stack([depth + 7, depth]) if options else depth * 100
    form = {"crs": None, "transform": rasterio.Affine(2, 0, 11, 0, -2, 35)}
    write_geotiff(tmp_path / "depth.tif", bands, change=change, **form)
    arguments = ["--terrain", tmp_path / "dem.asc", "--thickness-raster", tmp_path / "depth.tif"]
    command = ["slide", *map(str, [*arguments, "-o", tmp_path / "out"]), "--max-time", "0.1", "-q"]
    assert main([*command, *options]) == 0
    sloping = (4 * 2.0) ** 2 / np.cos(np.radians(38.0))
    assert released(tmp_path) == pytest.approx(0.5 * sloping * 300.0, rel=1e-6)


def refused(folder, capsys, message, *options, **case):
    files = {file.name for file in folder.iterdir()} | {"rel.geojson"}
    assert slide(folder, "-q", *options, **case) == 2
    assert message in capsys.readouterr().err
    assert {file.name for file in folder.iterdir()} == files


@pytest.mark.parametrize("name", ["dem.tif", "dem.asc"])
@pytest.mark.parametrize(
    ("height", "message"),
    [
        (0.0, "m beside 0 m within 5 m, at (30, 65)"),
        (830.0, "/terrain/release/0: elevations of"),
        (-32768.0, "a missing value that the file does not declare as NODATA"),
    ],
)
def test_a_cliff_under_the_release_is_refused(tmp_path, capsys, name, height, message):
    heights = STEEP.copy()
    heights[15, 6] = height
    if name == "dem.tif":
        write_geotiff(tmp_path / name, heights, **FORM)
    else:
        write_ascii_grid(tmp_path / name, Raster(heights[::-1], 0.0, 0.0, CELL))
    refused(tmp_path, capsys, message)


def test_a_cliff_is_accepted_beside_the_release_and_under_it_on_request(tmp_path):
    heights = STEEP.copy()
    heights[15, 25] -= 40.0
    heights[15, 6] -= 40.0
    write_geotiff(tmp_path / "dem.tif", heights, **FORM)
    assert slide(tmp_path, "-q") == 2
    assert slide(tmp_path, "-q", "--max-slope", "85") == 0
    assert json.loads((tmp_path / "out/scene.json").read_text())["terrain"]["max_slope"] == 85


@pytest.mark.parametrize("options", [("--thickness", "50"), ()])
def test_fifty_metres_of_snow_are_refused(tmp_path, capsys, options):
    write_geotiff(tmp_path / "dem.tif", STEEP, **FORM)
    message = "50 m of snow; at most 10 m are plausible; is it in centimetres?"
    refused(tmp_path, capsys, message, *options, thickness=0.5 if options else 50)
    assert slide(tmp_path, "-q", "--max-thickness", "12", thickness=11) == 0


def test_fifty_metres_of_snow_are_refused_in_rasters_and_scenes(tmp_path, capsys):
    write_geotiff(tmp_path / "dem.tif", STEEP, **FORM)
    depth = np.where(STEEP < 890, 50.0, 0.4)
    write_geotiff(tmp_path / "depth.tif", depth, **FORM)
    options = ("--thickness-raster", tmp_path / "depth.tif")
    refused(
        tmp_path, capsys, "the thickness raster has 50.000000 m at (20.000000, 40.000000)", *options
    )
    assert slide(tmp_path, "-q") == 0
    scene = Scene.load(tmp_path / "out/scene.json")
    scene.terrain.release[0].thickness = 50
    (tmp_path / "thick.json").write_text(json.dumps(scene.to_data()))
    capsys.readouterr()
    assert main(["run", str(tmp_path / "thick.json"), "-o", str(tmp_path / "thick"), "-q"]) == 2
    message = "/terrain/release/0/thickness: 50 m of snow; at most 10 m are accepted"
    assert message in capsys.readouterr().err
    assert not (tmp_path / "thick").exists()


def test_terrain_is_checked_in_handwritten_scenes(tmp_path, capsys):
    heights = STEEP.copy()
    heights[20, 20] = 0.0
    write_ascii_grid(tmp_path / "dem.asc", Raster(heights[::-1], 0.0, 0.0, CELL))
    area = {"outline": WITHIN[0][:-1], "thickness": 0.5}
    terrain = {"file": "dem.asc", "release": [area]}
    scene = {"snowshed": 2, "method": "slide", "dimension": 3, "terrain": terrain}
    (tmp_path / "scene.json").write_text(json.dumps(scene))
    assert main(["run", str(tmp_path / "scene.json"), "-o", str(tmp_path / "out"), "-q"]) == 2
    assert "/terrain/file: elevations of" in capsys.readouterr().err


def test_the_limit_of_cells_can_be_raised(tmp_path, capsys):
    write_geotiff(tmp_path / "dem.tif", STEEP, **FORM)
    refused(tmp_path, capsys, "has 900 cells; at most 899 are allowed", "--max-cells", "899")
    assert slide(tmp_path, "-q", "--max-cells", "900") == 0


@pytest.mark.parametrize(
    "option", ["--band", "--thickness-band", "--max-slope", "--max-thickness", "--max-cells"]
)
def test_raster_options_need_a_raster(tmp_path, capsys, option):
    assert main(["slide", "--example", option, "1", "-o", str(tmp_path / "out")]) == 2
    assert f"{option}: only with --terrain" in capsys.readouterr().err


def test_maps_have_speed_and_pressure_only_within_the_snow(tmp_path):
    """The maps agree, although the mean speed of the default mode fades out beyond the snow."""
    write_geotiff(tmp_path / "dem.tif", STEEP, **FORM)
    assert slide(tmp_path, "-q", "--no-bonds", "--max-time", "6") == 0
    pft, pfv, ppr = (
        rasterio.open(tmp_path / f"out/peaks/{name}.asc").read(1) for name in ("pft", "pfv", "ppr")
    )
    assert pfv.max() > 2.0
    assert (pft[pfv > 0] > 0).all()
    assert (pft[ppr > 0] > 0).all()
