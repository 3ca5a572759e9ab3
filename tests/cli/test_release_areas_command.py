"""``snowshed release-areas``: files, tables, the release of a slide, and refused input."""

import csv
import json
from dataclasses import replace

import numpy as np
import pytest
from helpers.slide_files import box, plane, write_polygons

from snowshed.cli.main import main
from snowshed.io.raster.areas import read_areas
from snowshed.io.raster.output import write_raster
from snowshed.io.raster.raster import Raster

pyogrio = pytest.importorskip("pyogrio")
pytest.importorskip("rasterio")
shapely = pytest.importorskip("shapely")

pytestmark = pytest.mark.usefixtures("undrawn")

CAUTION = "candidate by the shape of the terrain alone, not a hazard assessment"


@pytest.fixture
def dem(tmp_path):
    file = tmp_path / "dem.asc"
    write_raster(file, replace(plane(40.0, columns=60, rows=40, cell=5.0), crs="EPSG:31287"))
    return file


def command(*arguments):
    return main(["release-areas", *map(str, arguments)])


def size(area):
    return shapely.Polygon(area.outline, area.holes).area


@pytest.mark.parametrize("ending", ["geojson", "gpkg", "shp"])
def test_the_files_hold_the_candidates_with_their_system(tmp_path, dem, ending):
    file = tmp_path / f"areas.{ending}"
    assert command(dem, "-o", file, "--thickness", "0.5", "-q") == 0
    (area,) = read_areas(file)
    assert (area.name, area.thickness, area.crs) == ("candidate 1", 0.5, "EPSG:31287")
    assert size(area) == pytest.approx(58 * 38 * 25.0, rel=1e-6)
    info, _, _, columns = pyogrio.raw.read(file)
    record = dict(zip(info["fields"], (column[0] for column in columns)))
    assert record["note"] == CAUTION
    assert record["slope_deg"] == pytest.approx(40.0)
    assert record["volume_m3"] == pytest.approx(0.5 * record["surface_m2"], abs=0.01)
    (row,) = csv.DictReader((tmp_path / "areas.csv").open())
    assert float(row["area_m2"]) == record["area_m2"] == 58 * 38 * 25.0


@pytest.mark.parametrize(("mode", "tolerance"), [([], 2e-3), (["--compatible"], 0.01)])
def test_a_slide_releases_the_volume_of_the_table(tmp_path, dem, mode, tolerance):
    areas = tmp_path / "areas.geojson"
    forest = write_polygons(tmp_path / "wood.geojson", box(100, 0, 400, 400))
    assert command(dem, "-o", areas, "--thickness", "0.5", "--forest", forest, "-q") == 0
    (row,) = csv.DictReader((tmp_path / "areas.csv").open())
    arguments = ["slide", "--terrain", dem, "--release", areas, "-o", tmp_path / "out"]
    assert main([*map(str, arguments), "--max-time", "0.1", "-q", *mode]) == 0
    released = json.loads((tmp_path / "out/slide.json").read_text())["released_kg"]
    density = json.loads((tmp_path / "out/scene.json").read_text())["numerics"]["density"]
    assert released / density == pytest.approx(float(row["volume_m3"]), rel=tolerance)


def test_the_output_says_what_each_rule_leaves_and_that_these_are_candidates(tmp_path, dem, capsys):
    assert command(dem, "-o", tmp_path / "a.geojson", "--slope", "30:45", "--max-gap", "50") == 0
    printed = capsys.readouterr().out
    for text in ("slope 30 to 45 degrees", "gaps up to 50 m2 filled", "1 candidate release areas"):
        assert text in printed
    assert "not a hazard assessment" in printed
    assert "doi:10.5194/nhess-18-3235-2018" in printed
    described = json.loads((tmp_path / "a.geojson").read_text())["description"]
    assert "slope 30 to 45 degrees" in described and "not a hazard assessment" in described


@pytest.mark.parametrize("ending", ["geojson", "gpkg", "shp"])
def test_no_candidate_is_an_answer(tmp_path, dem, ending, capsys):
    assert command(dem, "-o", tmp_path / f"a.{ending}", "--slope", "50:60") == 0
    assert "0 candidate release areas" in capsys.readouterr().out
    assert len((tmp_path / "a.csv").read_text().splitlines()) == 1
    assert pyogrio.read_info(tmp_path / f"a.{ending}")["features"] == 0


def test_the_files_are_the_same_bytes_again(tmp_path, dem):
    for name in ("a", "b"):
        assert command(dem, "-o", tmp_path / f"{name}.geojson", "-q") == 0
    assert (tmp_path / "a.geojson").read_bytes() == (tmp_path / "b.geojson").read_bytes()


def test_an_older_system_does_not_stay_beside_a_shapefile(tmp_path, dem, capsys):
    file = tmp_path / "a.shp"
    assert command(dem, "-o", file, "-q") == 0
    assert file.with_suffix(".prj").exists()
    (tmp_path / "dem.prj").unlink()
    capsys.readouterr()
    assert command(dem, "-o", file) == 0
    assert not file.with_suffix(".prj").exists()
    note = f"note: {file}: has no coordinate system, because that of the terrain is unknown\n"
    assert capsys.readouterr().err == note


def test_a_finer_terrain_is_averaged(tmp_path, capsys):
    fine = tmp_path / "fine.asc"
    ground = plane(38.0, columns=300, rows=200, cell=1.0)
    bumps = np.random.default_rng(2).normal(0.0, 0.4, ground.heights.shape)
    write_raster(fine, replace(ground, heights=ground.heights + bumps))
    assert command(fine, "-o", tmp_path / "a.geojson") == 0
    assert "(--cell 5 averages them)" in capsys.readouterr().err
    assert command(fine, "-o", tmp_path / "b.geojson", "--cell", "5") == 0
    assert "averages them" not in capsys.readouterr().err
    rough, smooth = (
        sum(float(row["area_m2"]) for row in csv.DictReader((tmp_path / f"{n}.csv").open()))
        for n in "ab"
    )
    assert rough < 0.1 * smooth
    assert smooth == pytest.approx(58 * 38 * 25.0, rel=0.02)


def test_a_system_without_a_code_needs_another_format(tmp_path, dem, capsys):
    rasterio = pytest.importorskip("rasterio")
    own = "+proj=lcc +lat_1=46.3 +lat_2=48.7 +lat_0=47 +lon_0=12 +x_0=4000 +y_0=1000 +ellps=bessel"
    (tmp_path / "dem.prj").write_text(rasterio.crs.CRS.from_user_input(own).to_wkt())
    assert command(dem, "-o", tmp_path / "a.geojson") == 2
    assert "GeoJSON cannot hold a coordinate system without a code" in capsys.readouterr().err
    assert not (tmp_path / "a.geojson").exists() and not (tmp_path / "a.csv").exists()
    assert command(dem, "-o", tmp_path / "a.gpkg", "-q") == 0
    (area,) = read_areas(tmp_path / "a.gpkg")
    assert rasterio.crs.CRS.from_user_input(area.crs).to_dict()["lat_1"] == 46.3


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["-o", "a.kml"], "a.kml: not the name of a file of polygons; allowed: .geojson"),
        (["-o", "a.shp", "--slope", "28"], "--slope: '28' is not of the form LOW:HIGH"),
        (["-o", "a.shp", "--slope", "60:28"], "slope: 60 to 28 degrees"),
        (["-o", "a.shp", "--min-area", "nan"], "min_area: nan"),
        (["-o", "a.shp", "--cell", "0"], "cell: 0 m; allowed"),
        (["-o", "a.shp", "--cell", "1e-300"], "has more than 25000000 cells"),
        (["-o", "a.shp", "--forest-layer", "x"], "--forest-layer: only with --forest"),
        (["-o", "a.shp", "--max-cells", "100"], "has 2400 cells; at most 100 are allowed"),
        (["-o", "a.shp", "--thickness", "-1"], "thickness: -1 m in a candidate"),
        (["-o", "a.shp", "--forest", "none.tif"], "none.tif"),
    ],
)
def test_bad_input_is_refused_and_nothing_is_written(
    tmp_path, dem, capsys, monkeypatch, options, message
):
    monkeypatch.chdir(tmp_path)
    before = sorted(tmp_path.iterdir())
    assert command(dem, *options) == 2
    assert message in capsys.readouterr().err
    assert sorted(tmp_path.iterdir()) == before


@pytest.mark.parametrize("seed", range(3))
def test_a_hostile_raster_ends_with_a_message(tmp_path, capsys, seed):
    """Changed bytes of a raster are refused or read; they neither crash nor leave half a file."""
    good = tmp_path / "good.tif"
    write_raster(good, Raster(plane(40.0).heights, 0.0, 0.0, 5.0, crs="EPSG:31287"))
    content = bytearray(good.read_bytes())
    rng = np.random.default_rng(seed)
    for _ in range(15):
        damaged = content.copy()
        for place in rng.integers(0, len(content), 5):
            damaged[place] = rng.integers(0, 256)
        (tmp_path / "bad.tif").write_bytes(damaged)
        assert command(tmp_path / "bad.tif", "-o", tmp_path / "a.geojson", "-q") in (0, 2)
        capsys.readouterr()
