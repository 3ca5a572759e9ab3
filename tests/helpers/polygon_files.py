"""Files of polygons, as GDAL writes them."""

import warnings

import numpy as np
import pytest

pyogrio = pytest.importorskip("pyogrio")
shapely = pytest.importorskip("shapely")


def write(path, shapes, crs="EPSG:25833", kind="Polygon", **fields):
    """Write geometries with GDAL, in the format of the file's ending."""
    geometries = np.array([shapely.to_wkb(shape) for shape in shapes], dtype=object)
    values = [np.array(column) for column in fields.values()]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pyogrio.raw.write(
            path, geometries, values, np.array([*fields]), crs=crs, geometry_type=kind
        )
    return path


def polygon(*corners, holes=()):
    return shapely.Polygon(corners, holes)


SQUARE = polygon((10, 10), (30, 10), (30, 30), (10, 30))
HOLE = ((15, 15), (15, 20), (20, 20), (20, 15))
