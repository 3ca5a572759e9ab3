"""Outlines of groups of cells, along the edges of the cells.

They need the extra snowshed[terrain].
"""

from __future__ import annotations

from typing import Any

import numpy as np

from snowshed.base.arrays import AnyIntegers, Booleans
from snowshed.base.extras import require
from snowshed.io.raster.areas import Ring
from snowshed.io.raster.raster import Raster

#: Areas that touch at a corner are separated by this share of a cell.
AREA_GAP = 1e-7
PURPOSE = "outlines of cells"


def cell_outlines(place: Raster, labels: AnyIntegers) -> list[tuple[int, list[Ring]]]:
    """Return the outline of each connected group of cells with the same label.

    Cells that only touch at a corner are not connected. Outlines that would touch are slightly
    separated.

    Parameters
    ----------
    place
        A raster with the position of the cells.
    labels : (rows, columns)
        Labels from 1; 0 outside all groups.

    Returns
    -------
    list of (int, list of rings)
        Label, and corners (x, y) of the outline and of its holes, m, the first not repeated.
    """
    features: Any = require("rasterio.features", "terrain", PURPOSE)
    shapely: Any = require("shapely", "terrain", PURPOSE)
    shapes = features.shapes(
        labels.astype(np.int32), mask=labels > 0, connectivity=4, transform=cell_transform(place)
    )
    inner = [
        (
            int(label),
            shapely.Polygon(rings[0], rings[1:]).buffer(-AREA_GAP * place.cell, join_style="mitre"),
        )
        for rings, label in ((shape["coordinates"], label) for shape, label in shapes)
    ]
    return [
        (label, [_corners(ring) for ring in (area.exterior, *area.interiors)])
        for label, shape in inner
        for area in shapely.get_parts(shape)
    ]


def cell_transform(place: Raster) -> Any:
    """Return the map coordinates of the corners of cells, for rasterio: the first row is south."""
    affine: Any = require("rasterio", "terrain", PURPOSE).Affine
    west, south = place.east - 0.5 * place.cell, place.north - 0.5 * place.cell
    return affine(place.cell, 0.0, west, 0.0, place.cell, south)


def _corners(ring: Any) -> list[tuple[float, float]]:
    return [(float(x), float(y)) for x, y in ring.coords[:-1]]


def corner_count(cells: Booleans) -> int:
    """Return the number of corners of the outlines of cells.

    Examples
    --------
    >>> corner_count(np.array([[True, False], [False, True]]))
    8
    """
    padded = np.pad(cells, 1)
    a, b, c, d = padded[:-1, :-1], padded[:-1, 1:], padded[1:, :-1], padded[1:, 1:]
    crossing = (a == d) & (b == c) & (a != b)  # two corners that touch
    return int(np.count_nonzero(a ^ b ^ c ^ d)) + 2 * int(np.count_nonzero(crossing))
