"""Release areas from a raster of thickness: the cells with snow.

They need the extra snowshed[terrain].
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from snowshed._core import InputError
from snowshed.base.arrays import Booleans
from snowshed.base.limits import MAX_CELLS_TIMES_CORNERS, MAX_RELEASE_CORNERS, MAX_SNOW_CELLS
from snowshed.io.raster.areas import MapArea
from snowshed.io.raster.cell_outlines import cell_outlines, corner_count
from snowshed.io.raster.raster import Raster

#: Thicknesses from here on are codes for missing values, m.
MAX_THICKNESS = 100.0


def snow_part(depth: Raster) -> Raster:
    """Return the part of a raster of thickness with snow, and a row of cells around it.

    Raises
    ------
    InputError
        If a value is negative or above 100 m, no cell holds snow, or more than four million do.
    """
    values = depth.heights
    _refuse(depth, values < 0, "a negative thickness")
    _refuse(depth, values > MAX_THICKNESS, f"a thickness above {MAX_THICKNESS:g} m")
    snow = values > 0
    if not snow.any():
        raise InputError(f"{depth.name}: holds no thickness above 0")
    if np.count_nonzero(snow) > MAX_SNOW_CELLS:
        raise InputError(
            f"{depth.name}: holds snow in {np.count_nonzero(snow)} cells; at most "
            f"{MAX_SNOW_CELLS} are allowed; make its cells larger"
        )
    rows, columns = (np.flatnonzero(snow.any(axis=axis)) for axis in (1, 0))
    south, west = max(rows[0] - 1, 0), max(columns[0] - 1, 0)
    part = values[south : rows[-1] + 2, west : columns[-1] + 2]
    if part.shape == values.shape:
        return depth
    east, north = depth.east + west * depth.cell, depth.north + south * depth.cell
    return replace(depth, heights=part, east=east, north=north, plain=False)


def areas_of_depth(depth: Raster) -> list[MapArea]:
    """Return the areas in which a raster of thickness holds snow, along the edges of its cells.

    Cells of 0 and cells without a value hold no snow; however, a cell without a value amid snow is
    a gap in the data.

    Raises
    ------
    InputError
        If a value is negative or missing amid snow, no cell holds snow, or the areas have too many
        corners.
    """
    part = snow_part(depth)
    snow = part.heights > 0
    _refuse_gaps(part, snow)
    corners = corner_count(snow)
    most = min(MAX_RELEASE_CORNERS, max(MAX_CELLS_TIMES_CORNERS // snow.size, 4))
    if corners > most:
        raise InputError(
            f"{depth.name}: the edge of its snow has {corners} corners; at most {most} are allowed "
            f"with {snow.size} cells; make its cells larger, smooth it, or give polygons"
        )
    return [
        MapArea(
            name=f"area {number}",
            outline=outline,
            holes=tuple(holes),
            crs=depth.crs,
            file=depth.name,
        )
        for number, (_, (outline, *holes)) in enumerate(
            cell_outlines(part, snow.astype(np.int32)), 1
        )
    ]


def _refuse(depth: Raster, wrong: Booleans, what: str) -> None:
    if wrong.any():
        row, column = np.argwhere(wrong)[0]
        x, y = depth.east + column * depth.cell, depth.north + row * depth.cell
        raise InputError(f"{depth.name}: {what} at ({x:.10g}, {y:.10g})")


def _refuse_gaps(depth: Raster, snow: Booleans) -> None:
    """Refuse cells without a value in the holes of areas.

    Areas that meet at a corner are separate there, so that their surroundings connect between them.
    """
    from scipy import ndimage  # imported here: it takes 0.1 s, and most slides have polygons

    bare, _ = ndimage.label(np.pad(~snow, 1, constant_values=True), structure=np.ones((3, 3)))
    amid = (bare != bare[0, 0])[1:-1, 1:-1] & ~snow
    _refuse(depth, amid & np.isnan(depth.heights), "no thickness amid snow")
