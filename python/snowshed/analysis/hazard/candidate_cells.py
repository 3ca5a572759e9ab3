"""Sets of cells on a terrain: connected, without gaps, and values of other maps in them."""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from typing import Any

import numpy as np

from snowshed.base.arrays import Booleans, Floats, Integers
from snowshed.base.extras import require
from snowshed.io.raster.areas import MapArea
from snowshed.io.raster.cell_outlines import cell_transform
from snowshed.io.raster.raster import Raster


def connected_cells(cells: Booleans) -> Integers:
    """Return labels of connected cells, from 1, in the order of their first cells; else 0.

    Cells that only touch at a corner are not connected.
    """
    from scipy import ndimage

    labels, _ = ndimage.label(cells)
    return np.asarray(labels, dtype=np.int64)


def without_small(labels: Integers, count: float) -> Integers:
    """Return labels without those of fewer than `count` cells, numbered without gaps.

    Examples
    --------
    >>> without_small(np.array([[1, 0, 2, 2]]), 2).tolist()
    [[0, 0, 1, 1]]
    """
    sizes = np.bincount(labels.ravel())
    large = sizes >= count - 1e-9
    large[0] = False
    numbers = np.where(large, np.cumsum(large), 0)
    return np.asarray(numbers[labels], dtype=np.int64)


def split_by_sectors(cells: Booleans, aspect: Floats, sectors: int, count: float) -> Integers:
    """Return labels of connected cells that face the same sector of the compass, from 1; else 0.

    Parts of fewer than `count` cells join the neighbour with which they share most edges.

    Parameters
    ----------
    cells
        The cells.
    aspect
        The direction that each cell faces, degrees clockwise from north.
    sectors
        Number of sectors; the first is centred on north.
    count
        Smallest number of cells of a part.

    Examples
    --------
    >>> facing = np.array([[10.0, 20.0, 80.0, 100.0, 95.0, 180.0]])
    >>> split_by_sectors(facing >= 0.0, facing, 4, 2).tolist()
    [[1, 1, 2, 2, 2, 2]]
    """
    sector = np.floor(np.nan_to_num(aspect) * sectors / 360.0 + 0.5).astype(int) % sectors
    labels, total = np.zeros(cells.shape, dtype=np.int64), 0
    for number in np.unique(sector[cells]):
        own = cells & (sector == number)
        parts = connected_cells(own)
        labels[own] = parts[own] + total
        total += int(parts.max())
    return _joined_small(labels, count)


def _joined_small(labels: Integers, count: float) -> Integers:
    """Return labels of which small ones have joined a neighbour, the smallest first."""
    sizes = np.bincount(labels.ravel()).tolist()
    target = np.arange(len(sizes))
    neighbours = _neighbours(labels)
    queue = [(sizes[label], label) for label in neighbours if sizes[label] < count - 1e-9]
    heapq.heapify(queue)
    while queue:
        size, label = heapq.heappop(queue)
        if target[label] != label or size != sizes[label] or not neighbours[label]:
            continue  # it has joined another, or others have joined it, or it stands alone
        beside = neighbours.pop(label)
        other = max(beside, key=lambda place: (beside[place], sizes[place], -place))
        target[label] = other
        sizes[other] += size
        for third, edges in beside.items():
            del neighbours[third][label]
            if third != other:
                common = neighbours[other].get(third, 0) + edges
                neighbours[other][third] = neighbours[third][other] = common
        if sizes[other] < count - 1e-9:
            heapq.heappush(queue, (sizes[other], other))
    while (target[target] != target).any():
        target = target[target]
    return np.asarray(target[labels], dtype=np.int64)


def _neighbours(labels: Integers) -> dict[int, dict[int, int]]:
    """Return the labels beside each label, with the number of edges that they share."""
    base = int(labels.max(initial=0)) + 1
    keys = []
    for a, b in ((labels[:, :-1], labels[:, 1:]), (labels[:-1], labels[1:])):
        between = (a != b) & (a > 0) & (b > 0)
        keys.append(np.minimum(a[between], b[between]) * base + np.maximum(a[between], b[between]))
    pairs, edges = np.unique(np.concatenate(keys), return_counts=True)
    beside: dict[int, dict[int, int]] = {}
    for pair, count in zip(pairs.tolist(), edges.tolist()):
        first, second = divmod(pair, base)
        beside.setdefault(first, {})[second] = count
        beside.setdefault(second, {})[first] = count
    return beside


def without_gaps(cells: Booleans, count: float) -> Booleans:
    """Return cells together with gaps of up to `count` cells that they surround.

    Cells of a gap may be connected by their corners.

    Examples
    --------
    >>> ring = np.ones((3, 3), dtype=bool)
    >>> ring[1, 1] = False
    >>> bool(without_gaps(ring, 1.0).all()), bool(without_gaps(ring, 0.5).all())
    (True, False)
    """
    from scipy import ndimage

    gaps, _ = ndimage.label(np.pad(~cells, 1, constant_values=True), structure=np.ones((3, 3)))
    small = np.bincount(gaps.ravel()) <= count + 1e-9
    small[[0, gaps[0, 0]]] = False  # the cells themselves, and their surroundings
    filled: Booleans = cells | small[gaps][1:-1, 1:-1]
    return filled


def nearest_values(source: Raster, terrain: Raster) -> Floats:
    """Return the values of a raster at the middles of the cells of a terrain; NaN outside it.

    The value is that of the raster's cell in which the middle lies.

    Examples
    --------
    >>> coarse = Raster(np.array([[1.0, 2.0]]), 0.0, 0.0, 10.0)
    >>> nearest_values(coarse, Raster(np.zeros((1, 5)), -4.0, 3.0, 5.0)).tolist()
    [[1.0, 1.0, 2.0, 2.0, nan]]
    """
    rows, columns = terrain.heights.shape
    y = terrain.north + terrain.cell * np.arange(rows)
    x = terrain.east + terrain.cell * np.arange(columns)
    j = np.floor((y - source.north) / source.cell + 0.5).astype(int)
    i = np.floor((x - source.east) / source.cell + 0.5).astype(int)
    height, width = source.heights.shape
    inside = ((j >= 0) & (j < height))[:, None] & ((i >= 0) & (i < width))[None, :]
    values = source.heights[np.clip(j, 0, height - 1)[:, None], np.clip(i, 0, width - 1)[None, :]]
    return np.where(inside, values, np.nan)


def covered_cells(areas: Sequence[MapArea], terrain: Raster) -> Booleans:
    """Return the cells of a terrain whose middles lie in areas."""
    features: Any = require("rasterio.features", "terrain", "areas of forest")
    shapely: Any = require("shapely", "terrain", "areas of forest")
    shapes = [shapely.Polygon(area.outline, area.holes) for area in areas]
    if not shapes:
        return np.zeros(terrain.heights.shape, dtype=bool)
    return np.asarray(
        features.geometry_mask(
            shapes,
            out_shape=terrain.heights.shape,
            transform=cell_transform(terrain),
            invert=True,
        ),
        dtype=bool,
    )
