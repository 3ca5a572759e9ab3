"""Terrain and areas of slides that cannot be: in feet, beside each other, on top of each other."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from snowshed._core import InputError
from snowshed.io.coordinate_systems import are_same, is_in_feet
from snowshed.io.extras import require
from snowshed.io.map_areas import MapArea
from snowshed.io.raster import Raster

LOWEST, HIGHEST = -430.0, 8850.0  # m, of the Earth's land
SMALLEST_CELL, LARGEST_CELL = 0.05, 100.0  # m, of terrain that a slide can be seen on
STEEPEST = 65.0  # degrees, the median of terrain that is in metres
FOOT = 0.3048  # m
METRE_CELLS = (0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 25.0, 30.0)  # m, of usual rasters


def check_terrain(terrain: Raster) -> None:
    """Refuse elevations and cells that cannot be in metres."""
    known = terrain.heights[~np.isnan(terrain.heights)]
    if known.size == 0:
        raise InputError(f"{terrain.name}: holds no elevation")
    low, high = float(known.min()), float(known.max())
    if low < LOWEST or high > HIGHEST:
        raise InputError(
            f"{terrain.name}: elevations from {low:g} to {high:g} m are none of the Earth "
            f"({LOWEST:g} to {HIGHEST:g} m); are they in feet?"
        )
    if is_in_feet(terrain.crs):
        raise InputError(f"{terrain.name}: its map is in feet ({terrain.crs}); bring it to metres")
    cell = terrain.cell
    if not SMALLEST_CELL <= cell <= LARGEST_CELL:
        raise InputError(
            f"{terrain.name}: cells of {cell:g} m; a slide needs {SMALLEST_CELL:g} to "
            f"{LARGEST_CELL:g} m; are they in degrees or feet?"
        )
    for metres in METRE_CELLS:
        if math.isclose(cell, metres / FOOT, rel_tol=1e-5):
            raise InputError(
                f"{terrain.name}: cells of {cell:g} are {metres:g} m in feet; bring the raster to "
                "metres"
            )
    slope = _median_slope(terrain)
    if slope > STEEPEST:
        raise InputError(
            f"{terrain.name}: half of the ground is steeper than {slope:.0f} degrees; are the "
            "elevations in feet, or the cells in kilometres?"
        )


def check_place(terrain: Raster, areas: Sequence[MapArea]) -> None:
    """Refuse areas that lie beside the terrain altogether."""
    rows, columns = terrain.heights.shape
    low = np.array([terrain.east, terrain.north])
    high = low + terrain.cell * np.array([columns - 1, rows - 1])
    for area in areas:
        corners = np.asarray(area.outline)
        if (corners.max(axis=0) < low).any() or (corners.min(axis=0) > high).any():
            x, y = corners.mean(axis=0)
            raise InputError(
                f"{area.file}: {area.name} around ({x:.10g}, {y:.10g}) lies beside the terrain of "
                f"{terrain.name} ({low[0]:.10g}, {low[1]:.10g} to {high[0]:.10g}, "
                f"{high[1]:.10g}); do both have the same coordinate system?"
            )


def check_apart(areas: Sequence[MapArea]) -> None:
    """Refuse release areas that overlap: it is not clear how much snow lies there."""
    if len(areas) < 2:
        return
    shapely: Any = require("shapely", "terrain", "reading polygons")
    shapes = [shapely.Polygon(area.outline, area.holes) for area in areas]
    first, second = shapely.STRtree(shapes).query(shapes, predicate="intersects")
    for a, b in zip(first, second):
        if a < b and shapes[a].intersection(shapes[b]).area > 1e-6 * shapes[a].area:
            raise InputError(
                f"{areas[a].file}: {areas[a].name} and {areas[b].name} overlap; cut one of them, "
                "so that it is clear how thick the snow is"
            )


def common_system(named: Sequence[tuple[str, str]]) -> str:
    """Return the coordinate system that all files have that say it; empty where none does.

    Parameters
    ----------
    named
        Files and their coordinate systems in words.
    """
    given = [(file, system) for file, system in named if system]
    for file, system in given[1:]:
        if not are_same(system, given[0][1]):
            raise InputError(
                f"the files have different coordinate systems, {given[0][1]} ({given[0][0]}) and "
                f"{system} ({file}); bring them to one first"
            )
    return given[0][1] if given else ""


def _median_slope(terrain: Raster) -> float:
    """Return the median slope between neighbouring nodes, degrees."""
    z = terrain.heights
    if min(z.shape) < 2:
        return 0.0
    east, north = np.diff(z, axis=1)[:-1], np.diff(z, axis=0)[:, :-1]
    steepness = np.hypot(east, north)
    steepness = steepness[~np.isnan(steepness)]
    if steepness.size == 0:
        return 0.0
    return math.degrees(math.atan(float(np.median(steepness)) / terrain.cell))
