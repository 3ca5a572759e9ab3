"""Rasters and areas from objects in memory: NumPy, xarray, shapely, geopandas."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.base.arrays import Floats
from snowshed.io.raster.areas import MapArea
from snowshed.io.raster.raster import Raster

if TYPE_CHECKING:
    import xarray

#: Names of the axes of a DataArray to the east and to the north.
EAST, NORTH = ("x", "east", "easting"), ("y", "north", "northing")
METRES = ("m", "metre", "metres", "meter", "meters")
#: Attributes of packed numbers, with the values that change nothing.
PACKING = {"scale_factor": 1.0, "add_offset": 0.0}
#: Attributes that hold the number of missing values.
MISSING = ("_FillValue", "missing_value", "nodata")
REGULAR = 1e-6  # largest deviation of a distance between coordinates, relative to a cell


def raster_of(array: xarray.DataArray) -> Raster:
    """Return the raster of a DataArray with the coordinates x and y of its cells, m.

    Its coordinate system is taken from rioxarray (``.rio.crs``) or from ``attrs["crs"]``.

    Raises
    ------
    InputError
        If it has other dimensions, its coordinates are not those of square cells, or its numbers
        are packed or in another unit than the metre.

    Examples
    --------
    >>> import xarray
    >>> hill = xarray.DataArray([[0.0, 1.0], [2.0, 3.0]], {"y": [15.0, 5.0], "x": [0.0, 10.0]})
    >>> raster = raster_of(hill)
    >>> raster.heights.tolist(), raster.north, raster.cell
    ([[2.0, 3.0], [0.0, 1.0]], 5.0, 10.0)
    """
    if not hasattr(array, "dims") or not hasattr(array, "coords") or hasattr(array, "data_vars"):
        raise InputError(
            f"terrain: a value of type {type(array).__name__}; allowed: a path, a Raster, or a "
            "DataArray of xarray"
        )
    unit = str(array.attrs.get("units", "m"))
    if unit not in METRES:
        raise InputError(f"terrain: its units are {unit!r}; convert them to metres")
    _refuse_packed(array)
    squeezed = array.squeeze(drop=True)
    names = [str(name) for name in squeezed.dims]
    east = next((name for name in names if name in EAST), None)
    north = next((name for name in names if name in NORTH), None)
    if len(names) != 2 or east is None or north is None:
        raise InputError(f"terrain: its dimensions are {', '.join(names)}; needed: y and x")
    for name in (north, east):
        if name not in squeezed.coords:
            raise InputError(f"terrain: has no coordinates {name}")
    ordered = squeezed.transpose(north, east).sortby([north, east])
    x, y = (np.asarray(ordered[name], dtype=float) for name in (east, north))
    cell = _spacing(x, east)
    if abs(_spacing(y, north) - cell) > REGULAR * cell:
        raise InputError("terrain: its cells are not square")
    heights = np.array(ordered, dtype=float)
    for name in MISSING:
        if name in array.attrs:
            heights[heights == float(array.attrs[name])] = np.nan
    return Raster(heights, float(x[0]), float(y[0]), cell, name="terrain", crs=_system(array))


def _refuse_packed(array: xarray.DataArray) -> None:
    """Refuse an array whose numbers or coordinates are not metres yet."""
    for name, neutral in PACKING.items():
        value = array.attrs.get(name, neutral)
        if float(value) != neutral:
            raise InputError(
                f"terrain: its attribute {name} is {value}; apply it first, as mask_and_scale=True "
                "does when a file is opened"
            )
    for axis, coordinates in array.coords.items():
        unit = str(coordinates.attrs.get("units", "m"))
        if str(axis) in (*EAST, *NORTH) and unit not in METRES:
            raise InputError(f"terrain: the units of {axis} are {unit!r}; convert them to metres")


def _spacing(values: Floats, name: str) -> float:
    if len(values) < 2:
        raise InputError(f"terrain: {len(values)} values of {name}; needed: at least 2")
    steps = np.diff(values)
    if np.abs(steps - steps[0]).max() > REGULAR * abs(steps[0]):
        raise InputError(f"terrain: the values of {name} are not evenly spaced")
    return float(steps[0])


def _system(source: Any) -> str:
    """Return the coordinate system that an object in memory states; empty if none."""
    for holder in (getattr(source, "rio", None), source):
        system = getattr(holder, "crs", None)
        if system is not None:
            return str(system)
    attributes = getattr(source, "attrs", None)
    return str(attributes.get("crs", "")) if isinstance(attributes, dict) else ""


def areas_of(polygons: object, *, name: str) -> list[MapArea]:
    """Return the areas of polygons in memory; parts of a polygon become areas of their own.

    Parameters
    ----------
    polygons
        Shapely polygons; a GeoDataFrame, whose columns ``name`` and ``thickness`` [m] are read; or
        areas such as those of `snowshed.analysis.hazard.find_release_areas`.
    name
        Name for areas without one, and for messages.

    Raises
    ------
    InputError
        If something else is among them, or a polygon is empty or crosses itself.
    """
    if isinstance(polygons, Sequence) and polygons and isinstance(polygons[0], MapArea):
        return list(polygons)
    system = _system(polygons)
    areas: list[MapArea] = []
    for number, (shape, own, thickness) in enumerate(_shapes(polygons), start=1):
        parts: Any = getattr(shape, "geoms", [shape])
        for part in parts:
            if getattr(part, "geom_type", None) != "Polygon" or part.is_empty:
                raise InputError(f"{name} {number}: not a polygon, but {_kind(part)}")
            if not part.is_valid:
                raise InputError(f"{name} {number}: the polygon crosses or touches itself")
            rings = [[(float(x), float(y)) for x, y, *_ in ring.coords[:-1]]
                     for ring in (part.exterior, *part.interiors)]  # fmt: skip
            label = own or f"{name} {len(areas) + 1}"
            areas.append(MapArea(label, rings[0], tuple(rings[1:]), thickness, system, name))
    if not areas:
        raise InputError(f"{name}: holds no polygon")
    return areas


def _shapes(polygons: Any) -> Iterator[tuple[object, str, Optional[float]]]:
    """Yield each geometry with its name and the thickness of its snow, if they are there."""
    geometry = getattr(polygons, "geometry", None)
    if geometry is not None and hasattr(polygons, "columns"):
        for place, shape in enumerate(geometry):
            row = polygons.iloc[place]
            thickness = row.get("thickness")
            yield shape, str(row.get("name") or ""), None if thickness is None else float(thickness)
        return
    if hasattr(polygons, "geom_type"):
        yield polygons, "", None
        return
    if not isinstance(polygons, Iterable) or isinstance(polygons, (str, bytes)):
        raise InputError(f"polygons: a value of type {type(polygons).__name__}")
    for shape in polygons:
        yield shape, "", None


def _kind(shape: object) -> str:
    return str(getattr(shape, "geom_type", type(shape).__name__))
