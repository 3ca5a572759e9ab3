"""The only reader of terrain, which refuses implausible elevations and areas."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Optional

import numpy as np

from snowshed._core import InputError, impossible_cliff
from snowshed.base.callers import argument
from snowshed.base.extras import require
from snowshed.base.limits import MAX_CELLS_PER_BYTE, MAX_RASTER_CELLS, UNCHECKED_RASTER_CELLS
from snowshed.base.notes import InputNote, issue_note
from snowshed.base.paths import PathLike
from snowshed.io.coordinates.systems import are_same, is_in_degrees, is_in_feet, map_scale
from snowshed.io.raster.areas import MapArea, ring_area
from snowshed.io.raster.raster import Raster, read_raster

MIN_ELEVATION, MAX_ELEVATION = -430.0, 8850.0  # m, elevations of land on Earth
MIN_CELL, MAX_CELL = 0.05, 100.0  # m, cells that can resolve a slide
MAX_MEDIAN_SLOPE = 65.0  # degrees, largest median slope of terrain in metres
MAX_SLOPE = 70.0  # degrees, steepest cliff under a release and beside elevations of 0
FOOT = 0.3048  # m
METRE_CELLS = (0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 20.0, 25.0, 30.0)  # m, of usual rasters
SAMPLE = 1_000_000  # cells for the median slope
#: Errors of the map's lengths, relative to those on the ground, that are noted and refused. Within
#: their country, the systems of surveys stay below 0.2 %, and those of continents below 2 %.
NOTED_SCALE_ERROR, MAX_SCALE_ERROR = 0.01, 0.05


def read_terrain(
    path: PathLike,
    band: Optional[int] = None,
    max_slope: float = MAX_SLOPE,
    max_cells: int = MAX_RASTER_CELLS,
) -> Raster:
    """Read elevations, and refuse those that cannot be in metres.

    Parameters
    ----------
    path
        An ESRI ASCII grid or a GeoTIFF, on a projected map.
    band
        Band of a GeoTIFF; needed if it has several.
    max_slope
        Steepest plausible slope for `check_terrain`, degrees from the horizontal.
    max_cells
        Largest number of cells.

    Raises
    ------
    InputError
        If it is not such a raster, or `check_terrain` refuses it.
    OSError
        If the file cannot be read.
    """
    terrain = read_raster(path, band)
    cells, size = terrain.heights.size, Path(path).stat().st_size
    if cells > max_cells:
        raise InputError(
            f"{path}: has {cells} cells; at most {max_cells} are allowed, because a slide takes "
            "400 bytes or more for each; crop it, make cells larger, or allow more "
            f"({argument('max_cells')})"
        )
    if cells > UNCHECKED_RASTER_CELLS and cells > MAX_CELLS_PER_BYTE * size:
        raise InputError(
            f"{path}: {size} bytes hold {cells} cells, more than can be packed into them; crop "
            f"it to at most {UNCHECKED_RASTER_CELLS} cells"
        )
    check_terrain(terrain, max_slope)
    return terrain


def check_terrain(terrain: Raster, max_slope: float = MAX_SLOPE) -> None:
    """Refuse elevations and cells that cannot be in metres, and undeclared missing values.

    Neighbouring elevations may differ by more than 100 m only if the slope between them is at most
    80 degrees, or `max_slope` if that is steeper. Beside an elevation of exactly 0 m, they may
    differ by more than 10 m only if the slope is at most `max_slope`.
    """
    _check_elevations(terrain)
    _check_cells(terrain)
    _check_scale(terrain)
    cliff = impossible_cliff(terrain.heights, terrain.east, terrain.north, terrain.cell, max_slope)
    if cliff:
        raise InputError(
            f"{terrain.name}: elevations of {cliff}; are some missing? Declare the value that "
            "stands for them as NODATA; if there are such cliffs, give a steeper max_slope"
        )
    slope = _median_slope(terrain)
    if slope > MAX_MEDIAN_SLOPE:
        raise InputError(
            f"{terrain.name}: half of the ground is steeper than {slope:.0f} degrees; are the "
            "elevations in feet, or the cells in kilometres?"
        )


def _check_elevations(terrain: Raster) -> None:
    if terrain.numbers in ("uint8", "int8"):
        raise InputError(
            f"{terrain.name}: 8-bit values are those of a picture, such as a hillshade; give the "
            "elevations (as another type: gdal_translate -ot Int16)"
        )
    z = terrain.heights
    if np.isnan(z).all():
        raise InputError(f"{terrain.name}: holds no elevation")
    low, high = float(np.nanmin(z)), float(np.nanmax(z))
    if low < MIN_ELEVATION or high > MAX_ELEVATION:
        at = np.nanargmin(z) if low < MIN_ELEVATION else np.nanargmax(z)
        row, column = np.unravel_index(at, z.shape)
        x, y = terrain.east + column * terrain.cell, terrain.north + row * terrain.cell
        raise InputError(
            f"{terrain.name}: elevations from {low:g} to {high:g} m do not occur on Earth "
            f"({MIN_ELEVATION:g} to {MAX_ELEVATION:g} m), such as that at ({x:.10g}, {y:.10g}); "
            "are they in feet, or is it a missing value that the file does not declare as NODATA?"
        )


def _check_cells(terrain: Raster) -> None:
    cell = terrain.cell
    if is_in_feet(terrain.crs):
        raise InputError(
            f"{terrain.name}: its coordinates are in feet ({terrain.crs}); reproject it to metres, "
            "for example by gdalwarp -t_srs EPSG:..."
        )
    if not MIN_CELL <= cell <= MAX_CELL:
        raise InputError(
            f"{terrain.name}: cells of {cell:g} m; terrain needs {MIN_CELL:g} to "
            f"{MAX_CELL:g} m; are they in degrees or feet?"
        )
    for metres in METRE_CELLS:
        if math.isclose(cell, metres / FOOT, rel_tol=1e-5):
            raise InputError(
                f"{terrain.name}: cells of {cell:g} are {metres:g} m in feet; reproject the raster "
                "to metres"
            )


def _check_scale(terrain: Raster) -> None:
    """Refuse maps whose lengths are not those on the ground, such as Mercator's; note small errors.

    Slopes, areas and masses are computed with the lengths of the map.
    """
    if not terrain.crs:
        return
    rows, columns = terrain.heights.shape
    x, y = (
        start + 0.5 * terrain.cell * (count - 1)
        for start, count in ((terrain.east, columns), (terrain.north, rows))
    )
    scale = map_scale(terrain.crs, x, y)
    if scale is None:
        return
    error = max(abs(value - 1.0) for value in scale)
    if error <= NOTED_SCALE_ERROR:
        return
    lengths = (
        f"100 m on the ground are {100.0 * scale[0]:.4g} m eastwards and {100.0 * scale[1]:.4g} m "
        f"northwards on its map ({terrain.crs})"
    )
    advice = "project it to a system of the place, such as UTM or that of the national survey"
    if error > MAX_SCALE_ERROR:
        raise InputError(
            f"{terrain.name}: {lengths}, so that slopes, areas and masses would be wrong; {advice}"
        )
    issue_note(f"{terrain.name}: {lengths}; {advice}", InputNote)


def check_place(terrain: Raster, areas: Sequence[MapArea]) -> None:
    """Refuse areas that lie completely outside the terrain."""
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
    """Refuse overlapping release areas, because the amount of snow there is ambiguous."""
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
    """Return the common coordinate system of all files that state one; otherwise empty.

    Parameters
    ----------
    named
        Files, and their coordinate systems as text.

    Raises
    ------
    InputError
        If they differ, or a map is in degrees.
    """
    given = [(file, system) for file, system in named if system]
    for file, system in given:
        if is_in_degrees(system):
            raise InputError(
                f"{file}: its map is in degrees ({system}); project it to metres first"
            )
    for file, system in given[1:]:
        if not are_same(system, given[0][1]):
            raise InputError(
                f"the files have different coordinate systems, {given[0][1]} ({given[0][0]}) and "
                f"{system} ({file}); reproject them to one"
            )
    return given[0][1] if given else ""


def note_assumed_system(terrain: Raster, system: str) -> None:
    """Issue a note if a terrain has no coordinate system, and takes that of the other files."""
    if system and not terrain.crs:
        issue_note(
            f"{terrain.name}: has no coordinate system; that of the other files ({system}) is "
            "assumed",
            InputNote,
        )


def note_small_areas(areas: Sequence[MapArea], terrain: Raster) -> None:
    """Issue a note on each area that is smaller than a cell of the terrain."""
    for area in areas:
        if ring_area(area.outline) < terrain.cell**2:
            issue_note(f"{area.name}: smaller than a cell of the terrain; are its units right?")


def _median_slope(terrain: Raster) -> float:
    """Return the median slope between neighbouring nodes, degrees; large rasters are sampled."""
    z = terrain.heights
    if min(z.shape) < 2:
        return 0.0
    first = np.arange(0, len(z) - 1, max(1, z.size // SAMPLE))
    south, north = z[first], z[first + 1]
    steepness = np.hypot(np.diff(south, axis=1), (north - south)[:, :-1])
    steepness = steepness[~np.isnan(steepness)]
    if steepness.size == 0:
        return 0.0
    return math.degrees(math.atan(float(np.median(steepness)) / terrain.cell))
