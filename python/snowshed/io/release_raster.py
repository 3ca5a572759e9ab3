"""Release areas from a raster of thickness: the cells that hold snow.

They need the extra snowshed[terrain].
"""

from __future__ import annotations

from typing import Any

import numpy as np

from snowshed._core import InputError
from snowshed.io.extras import require
from snowshed.io.map_areas import MapArea
from snowshed.io.raster import Raster

#: Areas that touch at a corner are kept apart by this share of a cell.
GAP = 1e-7


def areas_of_depth(depth: Raster) -> list[MapArea]:
    """Return the areas in which a raster of thickness holds snow, along the edges of its cells.

    Cells of 0 and cells without a value hold none; but a cell without a value amid snow is a gap in
    what is known.

    Raises
    ------
    InputError
        If a value is negative or missing amid snow, or no cell holds snow.
    """
    values = depth.heights
    _refuse(depth, values < 0, "a negative thickness")
    snow = values > 0
    if not snow.any():
        raise InputError(f"{depth.name}: holds no thickness above 0")
    shapely: Any = require("shapely", "terrain", "reading a raster of thickness")
    rows, columns = np.nonzero(snow)
    half = 0.5 * depth.cell
    x, y = depth.east + columns * depth.cell, depth.north + rows * depth.cell
    cells = shapely.box(x - half, y - half, x + half, y + half)
    inner = shapely.union_all(cells).buffer(-GAP * depth.cell, join_style="mitre")
    for part in shapely.get_parts(inner):
        _refuse_gaps(depth, part, shapely)
    return [
        MapArea(
            name=f"area {number}",
            outline=_ring(part.exterior),
            holes=tuple(_ring(hole) for hole in part.interiors),
            crs=depth.crs,
            file=depth.name,
        )
        for number, part in enumerate(shapely.get_parts(inner), 1)
    ]


def _refuse(depth: Raster, wrong: Any, what: str) -> None:
    if wrong.any():
        row, column = np.argwhere(wrong)[0]
        x, y = depth.east + column * depth.cell, depth.north + row * depth.cell
        raise InputError(f"{depth.name}: {what} at ({x:.10g}, {y:.10g})")


def _refuse_gaps(depth: Raster, part: Any, shapely: Any) -> None:
    """Refuse cells without a value in the holes of an area."""
    rows, columns = np.nonzero(np.isnan(depth.heights))
    x, y = depth.east + columns * depth.cell, depth.north + rows * depth.cell
    for hole in part.interiors:
        inside = shapely.contains_xy(shapely.Polygon(hole), x, y)
        wrong = np.zeros(depth.heights.shape, bool)
        wrong[rows[inside], columns[inside]] = True
        _refuse(depth, wrong, "no thickness amid snow")


def _ring(ring: Any) -> list[tuple[float, float]]:
    return [(float(x), float(y)) for x, y in ring.coords[:-1]]
