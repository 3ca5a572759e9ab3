"""Rasters of thickness on the nodes of a terrain, as AvaFrame 2.1 brings them there."""

from __future__ import annotations

from dataclasses import replace
from typing import Optional

import numpy as np

from snowshed._core import InputError
from snowshed.base.arrays import Floats
from snowshed.base.notes import InputNote, issue_note
from snowshed.io.raster.raster import Raster

#: Cells of the terrain by which a raster may end within it in the south-west, or beyond it in the
#: north-east; AvaFrame's resizeThreshold.
MAX_SHIFT = 3.0
#: Largest difference of equal positions, m; AvaFrame's meshCellSizeThreshold.
SAME_PLACE = 1e-3


def thickness_on_terrain(
    depth: Raster, terrain: Raster, *, cell: float = 0.0, terrain_is_text: Optional[bool] = None
) -> Raster:
    """Return a raster of thickness on the nodes of a terrain.

    A raster with the same nodes stays as it is. Another one is interpolated (bilinear), and a note
    says so. AvaFrame reads text in single precision, also its own copies in the terrain's format.

    Parameters
    ----------
    depth
        The thickness, m.
    terrain
        The elevations.
    cell
        Size of the cells on which the slide is computed [m]. 0: that of the terrain.
    terrain_is_text
        Whether the file of the terrain is text; None: as `terrain` says.

    Raises
    ------
    InputError
        If a value is missing or negative, or the raster does not cover the terrain.
    """
    for wrong, what in ((np.isnan(depth.heights), "no"), (depth.heights < 0, "a negative")):
        if wrong.any():
            row, column = np.argwhere(wrong)[0]
            raise InputError(
                f"{depth.name}: {what} thickness at "
                f"({depth.east + column * depth.cell:.10g}, "
                f'{depth.north + row * depth.cell:.10g}); the mode "compatible" needs at least 0 '
                "everywhere"
            )
    if not depth.numbers:
        depth = _in_single_precision(depth)
    columns, rows = _shape(terrain, cell)
    step = cell or terrain.cell
    shifts = [
        depth.east - terrain.east,
        depth.north - terrain.north,
        depth.east + depth.heights.shape[1] * depth.cell - terrain.east - columns * step,
        depth.north + depth.heights.shape[0] * depth.cell - terrain.north - rows * step,
    ]
    if max(shifts) > MAX_SHIFT * step:
        raise InputError(
            f"{depth.name}: begins within the terrain or ends beyond it by more than "
            f'{MAX_SHIFT:g} cells; the mode "compatible" needs a raster that covers the terrain, '
            "with 0 where there is no snow"
        )
    if depth.cell == step and np.allclose(shifts, 0.0, rtol=0.0, atol=SAME_PLACE):
        return _at(depth, terrain)
    west, south = _as_gdal_has_it(terrain.east, terrain.north, rows, step)
    values = _interpolated(
        depth,
        np.linspace(west, west + (columns - 1) * step, columns),
        np.linspace(south, south + (rows - 1) * step, rows),
    )
    if np.isnan(values).any():
        raise InputError(
            f'{depth.name}: does not cover the terrain; the mode "compatible" needs a raster that '
            "does, with 0 where there is no snow"
        )
    issue_note(
        f"{depth.name}: the thickness was interpolated onto the terrain's cells of {step:g} m, as "
        "in AvaFrame",
        InputNote,
    )
    moved = replace(
        depth, heights=values, east=terrain.east, north=terrain.north, cell=step, plain=False
    )
    if terrain_is_text is None:
        terrain_is_text = not terrain.numbers
    return _in_single_precision(moved) if terrain_is_text else moved


def _in_single_precision(depth: Raster) -> Raster:
    rounded = depth.heights.astype(np.float32).astype(np.float64)
    if (rounded == depth.heights).all():
        return depth
    return replace(depth, heights=rounded, plain=False)


def _shape(terrain: Raster, cell: float) -> tuple[int, int]:
    """Return the numbers of columns and rows of the grid on which a slide is computed."""
    rows, columns = terrain.heights.shape
    if cell in (0.0, terrain.cell):
        return columns, rows
    along = [int((n - 1) * terrain.cell / cell + 1e-9) + 1 for n in (columns, rows)]
    return along[0], along[1]


def _at(depth: Raster, terrain: Raster) -> Raster:
    """Return a raster at exactly the position of a terrain."""
    if (depth.east, depth.north) == (terrain.east, terrain.north):
        return depth
    return replace(depth, east=terrain.east, north=terrain.north, plain=False)


def _as_gdal_has_it(east: float, north: float, rows: int, cell: float) -> tuple[float, float]:
    """Return the middle of the south-west cell with GDAL's rounding, which counts from the north.

    Where a result is halfway between two numbers in single precision, this rounding decides.
    """
    top = (north - 0.5 * cell) + rows * cell
    return (east - 0.5 * cell) + cell / 2.0, (rows * -cell + top) + cell / 2.0


def _interpolated(depth: Raster, east: Floats, north: Floats) -> Floats:
    """Return values at map coordinates; within half a cell of the edge, those of the nearest cell.

    Elsewhere beyond the raster they are NaN.
    """
    rows, columns = depth.heights.shape
    west, south = _as_gdal_has_it(depth.east, depth.north, rows, depth.cell)
    u, v = np.meshgrid((east - west) / depth.cell, (north - south) / depth.cell)
    values = np.full(u.shape, np.nan)
    near = (u > -0.5) & (u < columns - 0.5) & (v > -0.5) & (v < rows - 0.5)
    values[near] = depth.heights[np.round(v[near]).astype(int), np.round(u[near]).astype(int)]
    within = (u >= 0) & (u < columns - 1) & (v >= 0) & (v < rows - 1)
    x, y = u[within], v[within]
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    a, b, z = x - i, y - j, depth.heights
    values[within] = (
        z[j, i] * (1 - a) * (1 - b)
        + z[j, i + 1] * a * (1 - b)
        + z[j + 1, i] * (1 - a) * b
        + z[j + 1, i + 1] * a * b
    )
    return values
