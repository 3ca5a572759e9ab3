"""Scenes of slides from files: polygons, rasters."""

import numpy as np
import pytest
from helpers.slide_files import SQUARE, WITH_HOLE, write_polygons

from snowshed import InputError
from snowshed.io.raster.areas import read_areas
from snowshed.io.raster.raster import Raster, write_ascii_grid
from snowshed.scene import slide_scene

pytest.importorskip("pyogrio")
pytest.importorskip("shapely")

BOW_TIE = [[[10, 10], [30, 30], [30, 10], [10, 30], [10, 10]]]


@pytest.fixture
def terrain(tmp_path):
    heights = np.tile(1500.0 - np.arange(40.0), (30, 1))
    write_ascii_grid(tmp_path / "dem.asc", Raster(heights, 0.0, 0.0, 2.0))
    return tmp_path / "dem.asc"


def test_polygons_have_holes_and_a_thickness(tmp_path):
    (area,) = read_areas(write_polygons(tmp_path / "a.geojson", WITH_HOLE, name="A", thickness=0.4))
    assert (area.name, area.thickness, len(area.outline), len(area.holes)) == ("A", 0.4, 4, 1)


@pytest.mark.parametrize(
    ("rings", "crs", "fields", "message"),
    [
        (BOW_TIE, "EPSG:31287", {}, "feature 1: no valid outline: Self-intersection"),
        (SQUARE, "EPSG:4326", {}, "its coordinates are in degrees"),
        (SQUARE, "EPSG:31287", {"thickness": -1}, "thickness is -1 m; give one above 0"),
        (SQUARE, "EPSG:31287", {"thickness": "deep"}, "thickness 'deep' is not a number"),
    ],
)
def test_bad_polygons_are_refused(tmp_path, rings, crs, fields, message):
    with pytest.raises(InputError, match=message):
        read_areas(write_polygons(tmp_path / "a.geojson", rings, crs, **fields))


def test_files_without_polygons_are_refused(tmp_path):
    (tmp_path / "a.shp").write_bytes(b"\x00junk")
    with pytest.raises(InputError, match="not a file of polygons"):
        read_areas(tmp_path / "a.shp")


def test_a_thickness_is_required(tmp_path, terrain):
    release = write_polygons(tmp_path / "a.geojson")
    with pytest.raises(InputError, match="gives no thickness"):
        slide_scene(terrain, release)
    scene = slide_scene(terrain, release, thickness=0.3)
    assert scene.resolve().data["terrain"]["release"][0]["thickness"] == 0.3


def test_elevations_in_feet_are_refused(tmp_path):
    write_ascii_grid(tmp_path / "feet.asc", Raster(np.full((9, 9), 12000.0), 0.0, 0.0, 5.0))
    with pytest.raises(InputError, match="are they in feet"):
        slide_scene(tmp_path / "feet.asc", write_polygons(tmp_path / "a.geojson", thickness=0.3))


def test_coordinate_systems_must_agree(tmp_path, terrain):
    release = write_polygons(tmp_path / "a.geojson", thickness=0.3)
    forest = write_polygons(tmp_path / "b.geojson", crs="EPSG:2056")
    with pytest.raises(InputError, match=r"EPSG:31287 \(.*a.geojson\) and EPSG:2056 \(.*b"):
        slide_scene(terrain, release, resistance=forest)
