"""Files of snow slides for tests: terrain, polygons, projects of AvaFrame."""

import json
import math

import numpy as np

from snowshed.io.raster.raster import Raster, write_ascii_grid

SQUARE = [[[10, 10], [30, 10], [30, 30], [10, 30], [10, 10]]]
WITH_HOLE = [*SQUARE, [[15, 15], [15, 20], [20, 20], [20, 15], [15, 15]]]


def box(west, south, east, north):
    """Return the rings of a rectangle."""
    return [[[west, south], [east, south], [east, north], [west, north], [west, south]]]


def write_polygons(path, rings=SQUARE, crs="EPSG:31287", **fields):
    """Write a GeoJSON file with one polygon."""
    return write_features(path, [(rings, fields)], crs)


def write_features(path, features, crs="EPSG:31287"):
    """Write a GeoJSON file; `features` holds the rings and fields of each polygon."""
    collection = {
        "type": "FeatureCollection",
        "crs": {"type": "name", "properties": {"name": crs}},
        "features": [
            {
                "type": "Feature",
                "properties": fields,
                "geometry": {"type": "Polygon", "coordinates": rings},
            }
            for rings, fields in features
        ],
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(collection))
    return path


def write_lines(path, lines, **fields):
    """Write a file of lines: GeoJSON, or a shapefile, whose corners may have z."""
    if path.suffix == ".shp":
        return write_line_shapes(path, lines, fields)
    collection = {
        "type": "FeatureCollection",
        "crs": {"type": "name", "properties": {"name": "EPSG:31287"}},
        "features": [
            {
                "type": "Feature",
                "properties": fields,
                "geometry": {"type": "LineString", "coordinates": line},
            }
            for line in lines
        ],
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(collection))
    return path


def write_line_shapes(path, lines, fields):
    import pyogrio
    import shapely

    path.parent.mkdir(parents=True, exist_ok=True)
    pyogrio.raw.write(
        path,
        geometry=shapely.to_wkb([shapely.LineString(line) for line in lines], output_dimension=3),
        field_data=[np.array([value] * len(lines)) for value in fields.values()],
        fields=list(fields),
        geometry_type="LineString Z" if len(lines[0][0]) == 3 else "LineString",
        crs="EPSG:31287",
    )
    return path


def plane(degrees=38.0, columns=40, rows=30, cell=2.0):
    """Return the raster of a plane that falls toward the east."""
    fall = math.tan(math.radians(degrees)) * cell * np.arange(columns)
    return Raster(np.tile(1500.0 - fall, (rows, 1)), 0.0, 0.0, cell)


def write_project(folder, ini="", releases=("rel",), raster=None):
    """Write an AvaFrame project: terrain, release areas 0.5 m thick, and an ini if given."""
    inputs = folder / "Inputs"
    for name in releases:
        write_polygons(inputs / "REL" / f"{name}.geojson", thickness=0.5)
    write_ascii_grid(inputs / "dem.asc", raster or plane())
    if ini:
        (inputs / "CFGs").mkdir(exist_ok=True)
        text = f"[GENERAL]\n[com1DFA_com1DFA_override]\n{ini}"
        (inputs / "CFGs" / "com5SnowSlideCfg.ini").write_text(text)
    return folder
