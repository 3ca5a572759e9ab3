"""Loads of slides on objects: pressure, width and depth by hand, of one slide and of many."""

import json

import numpy as np
import pytest

from snowshed import InputError

shapely = pytest.importorskip("shapely")
pytest.importorskip("pyogrio")

from helpers.polygon_files import write  # noqa: E402

from snowshed.io.raster.areas import read_areas  # noqa: E402
from snowshed.methods.slide.objects import (  # noqa: E402
    ObjectNodes,
    SlideObject,
    check_drag,
    read_objects,
)


def maps(speed):
    axis = np.arange(0.0, 21.0)
    return axis, np.full((21, 21), float(speed)), np.full((21, 21), 0.5)


def test_pressure_and_force_by_hand():
    axis, speed, depth = maps(8.0)
    speed[10, 10], depth[2, 2] = 20.0, 9.0  # only the first is beside the object
    nodes = ObjectNodes(SlideObject("wall", shapely.box(9.0, 8.0, 10.0, 14.0)), axis, axis)
    load = nodes.load(speed, depth, density=300.0, drag=2.0)
    assert load.pressure == pytest.approx(2.0 * 300.0 * 400.0 / 1000.0)
    assert load.force == pytest.approx(load.pressure * 0.5 * np.hypot(1.0, 6.0))


def test_snow_that_never_came_loads_nothing():
    axis, speed, depth = maps(8.0)
    nodes = ObjectNodes(SlideObject("mast", shapely.Point(5.0, 5.0).buffer(0.2)), axis, axis)
    assert nodes.load(speed, 0.0 * depth, 300.0, 1.0).force == 0.0


def test_objects_beside_the_terrain_and_wrong_drags_are_refused():
    axis, _, _ = maps(1.0)
    with pytest.raises(InputError, match="mast: lies outside the terrain"):
        ObjectNodes(SlideObject("mast", shapely.box(50.0, 50.0, 51.0, 51.0)), axis, axis)
    for drag in (0.0, -1.0, float("nan"), 1e4):
        with pytest.raises(InputError, match="drag coefficient"):
            check_drag(drag)


def geojson(crs, *corners):
    ring = [list(corner) for corner in (*corners, corners[0])]
    shape = {"type": "Polygon", "coordinates": [ring]}
    system = {"crs": {"type": "name", "properties": {"name": crs}}} if crs else {}
    feature = {"type": "Feature", "properties": {}, "geometry": shape}
    return json.dumps({"type": "FeatureCollection", "features": [feature], **system})


def test_objects_of_a_file_need_metres_and_straight_outlines(tmp_path):
    file = tmp_path / "masts.geojson"
    square = [(0, 0), (2, 0), (2, 2), (0, 2)]
    file.write_text(geojson("urn:ogc:def:crs:EPSG::31287", *square))
    (mast,) = read_objects(file)
    assert (mast.name, mast.crs, mast.shape.area) == ("object 1", "EPSG:31287", 4.0)
    file.write_text(geojson(None, *square))
    with pytest.raises(InputError, match="degrees"):
        read_objects(file)
    file.write_text(geojson("urn:ogc:def:crs:EPSG::31287", square[0], square[2], *square[1::2]))
    with pytest.raises(InputError, match="crossings"):
        read_objects(file)


@pytest.mark.parametrize("ending", ["gpkg", "shp", "geojson"])
def test_lines_are_walls(tmp_path, ending):
    wall = shapely.LineString([(2.0, 4.0), (8.0, 4.0), (10.0, 4.0)])
    fences = shapely.MultiLineString([[(0, 0), (0, 3)], [(5, 0), (5, 4)]])
    single = write(tmp_path / f"wall.{ending}", [wall], "EPSG:25833", "LineString", name=["dam"])
    (dam,) = read_objects(single)
    assert (dam.name, dam.width, dam.shape.length) == ("dam", 8.0, 8.0)
    several = write(tmp_path / f"two.{ending}", [fences], "EPSG:25833", "MultiLineString")
    assert [part.width for part in read_objects(several)] == [3.0, 4.0]
    assert read_objects(several)[1].name == "object 1, part 2"
    with pytest.raises(InputError, match=r"polygon"):
        read_areas(single)


def test_lines_and_polygons_may_share_a_file(tmp_path):
    square = {"type": "Polygon", "coordinates": [[[0, 0], [2, 0], [2, 2], [0, 2], [0, 0]]]}
    line = {"type": "LineString", "coordinates": [[5, 5], [5, 9]]}
    other = {"type": "LineString", "coordinates": [[7, 5], [7, 6]]}
    crs = {"type": "name", "properties": {"name": "EPSG:25833"}}
    features = [
        {"type": "Feature", "properties": {"name": name}, "geometry": shape}
        for name, shape in (("wall", line), ("house", square), ("fence", other))
    ]
    file = tmp_path / "objects.geojson"
    file.write_text(json.dumps({"type": "FeatureCollection", "features": features, "crs": crs}))
    assert {target.name: target.shape.length for target in read_objects(file)} == {
        "wall": 4.0,
        "house": 8.0,
        "fence": 1.0,
    }


def test_a_point_is_no_object(tmp_path):
    file = write(tmp_path / "points.geojson", [shapely.Point(1, 1)], "EPSG:25833", "Point")
    with pytest.raises(InputError, match="not a line or a polygon but a Point"):
        read_objects(file)
