"""Scenes of slides from files: polygons, rasters, AvaFrame's projects."""

import json

import numpy as np
import pytest

from snowshed import InputError
from snowshed.io.map_areas import read_areas
from snowshed.io.raster import Raster, write_ascii_grid
from snowshed.scene.builders import avaframe_scene, slide_scene

pytest.importorskip("pyogrio")
pytest.importorskip("shapely")

SQUARE = [[[10, 10], [30, 10], [30, 30], [10, 30], [10, 10]]]
BOW_TIE = [[[10, 10], [30, 30], [30, 10], [10, 30], [10, 10]]]
WITH_HOLE = [*SQUARE, [[15, 15], [15, 20], [20, 20], [20, 15], [15, 15]]]


def write_polygons(path, rings=SQUARE, crs="EPSG:31287", **fields):
    shape = {"type": "Polygon", "coordinates": rings}
    feature = {"type": "Feature", "properties": fields, "geometry": shape}
    place = {"type": "name", "properties": {"name": crs}}
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({"type": "FeatureCollection", "crs": place, "features": [feature]}))
    return path


@pytest.fixture
def terrain(tmp_path):
    heights = np.tile(1500.0 - np.arange(40.0), (30, 1))
    write_ascii_grid(tmp_path / "dem.asc", Raster(heights, 0.0, 0.0, 2.0))
    return tmp_path / "dem.asc"


def test_polygons_with_holes_and_thickness(tmp_path):
    (area,) = read_areas(write_polygons(tmp_path / "a.geojson", WITH_HOLE, name="A", thickness=0.4))
    assert (area.name, area.thickness, len(area.outline), len(area.holes)) == ("A", 0.4, 4, 1)


@pytest.mark.parametrize(
    ("rings", "crs", "fields", "message"),
    [
        (BOW_TIE, "EPSG:31287", {}, "feature 1: Self-intersection"),
        (SQUARE, "EPSG:4326", {}, "its coordinates are in degrees"),
        (SQUARE, "EPSG:31287", {"thickness": -1}, "thickness is -1 m; give one above 0"),
        (SQUARE, "EPSG:31287", {"thickness": "deep"}, "thickness 'deep' is not a number"),
    ],
)
def test_bad_polygons_are_named(tmp_path, rings, crs, fields, message):
    with pytest.raises(InputError, match=message):
        read_areas(write_polygons(tmp_path / "a.geojson", rings, crs, **fields))


def test_files_that_hold_no_polygons(tmp_path):
    (tmp_path / "a.shp").write_bytes(b"\x00junk")
    with pytest.raises(InputError, match="not a file of polygons"):
        read_areas(tmp_path / "a.shp")


def test_a_thickness_must_come_from_somewhere(tmp_path, terrain):
    release = write_polygons(tmp_path / "a.geojson")
    with pytest.raises(InputError, match="gives no thickness"):
        slide_scene(terrain, release)
    scene = slide_scene(terrain, release, thickness=0.3)
    assert scene.resolve().data["terrain"]["release"][0]["thickness"] == 0.3


def test_elevations_in_feet_are_noticed(tmp_path):
    write_ascii_grid(tmp_path / "feet.asc", Raster(np.full((9, 9), 12000.0), 0.0, 0.0, 5.0))
    with pytest.raises(InputError, match="are they in feet"):
        slide_scene(tmp_path / "feet.asc", write_polygons(tmp_path / "a.geojson", thickness=0.3))


def test_coordinate_systems_must_agree(tmp_path, terrain):
    release = write_polygons(tmp_path / "a.geojson", thickness=0.3)
    forest = write_polygons(tmp_path / "b.geojson", crs="EPSG:2056")
    with pytest.raises(InputError, match="different coordinate systems, EPSG:31287 and EPSG:2056"):
        slide_scene(terrain, release, resistance=forest)


def project(tmp_path, terrain, ini=""):
    inputs = tmp_path / "project" / "Inputs"
    write_polygons(inputs / "REL" / "rel.geojson", thickness=0.5)
    (inputs / "dem.asc").write_bytes(terrain.read_bytes())
    if ini:
        (tmp_path / "project" / "local_com5SnowSlideCfg.ini").write_text(ini)
    return tmp_path / "project"


def test_an_avaframe_project_without_ini_has_com5s_defaults(tmp_path, terrain):
    data = avaframe_scene(project(tmp_path, terrain)).resolve().data
    assert data["numerics"]["mode"] == "compatible"
    assert data["numerics"]["cell"] == 2.0
    assert data["events"]["max_time"] == 400.0


def test_an_avaframe_ini_is_taken_as_it_is(tmp_path, terrain):
    override = "muvoellmy = 0.4\ncohesionMaxStrain = 0.1\ntEnd = 9\n"
    ini = f"[GENERAL]\n[com1DFA_com1DFA_override]\n{override}"
    scene = avaframe_scene(project(tmp_path, terrain, ini))
    assert (scene.numerics.friction, scene.numerics.max_strain) == (0.4, 0.1)
    assert scene.events.max_time == 9.0


@pytest.mark.parametrize(
    ("ini", "message"),
    [
        ("[GENERAL]\nsphOption = 2\n", "sphoption: '2' is not available; allowed: 1"),
        ("[GENERAL]\nmuvoelmy = 0.4\n", "none of the keys that are known here; did you mean"),
        ("[GENERAL]\ndt = 0.1|0.2\n", "'0.1|0.2' is not one number"),
        ("muvoellmy = 0.4\n", "not an ini file"),
    ],
)
def test_bad_inis_are_named(tmp_path, terrain, ini, message):
    import re

    with pytest.raises(InputError, match=re.escape(message)):
        avaframe_scene(project(tmp_path, terrain, ini))
