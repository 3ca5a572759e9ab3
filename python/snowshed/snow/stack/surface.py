"""The surface of a stack: the highest particle of every cell of a 30 x 30 grid (thesis A.4.3)."""

from __future__ import annotations

import numpy as np

from snowshed.base.arrays import Floats, Integers

CELLS = 30  # cells across the range of x, and of y


def surface_particles(positions: Floats) -> Integers:
    """Return the indices of the particles that form the surface, ordered by x cell, then y cell.

    Parameters
    ----------
    positions : (n, 3)
        Levelled positions of the particles after trimming, m. In 2D, y is zero throughout, and 30
        columns remain of the 900 cells.

    Examples
    --------
    >>> surface_particles(np.array([[0.0, 0, 1], [0.001, 0, 2], [1, 0, 1]])).tolist()
    [1, 2]
    """
    x, y, z = positions.T
    return _highest(_cells(x) * CELLS + _cells(y), z)


def outline_particles(positions: Floats) -> Integers:
    """Return the particles of the profile from the side: the highest one in each x column.

    Returns
    -------
    (k,), k <= 30
        Indices of these particles, in the order of x.
    """
    return _highest(_cells(positions[:, 0]), positions[:, 2])


def _cells(coordinate: Floats) -> Integers:
    if len(coordinate) == 0:
        return np.zeros(0, dtype=np.int64)
    low, span = coordinate.min(), np.ptp(coordinate)
    cells = np.floor((coordinate - low) * (CELLS / (span or 1.0))).astype(np.int64)
    clipped: Integers = np.minimum(cells, CELLS - 1)
    return clipped


def _highest(cells: Integers, z: Floats) -> Integers:
    order = np.lexsort((z, cells))
    last = np.flatnonzero(np.diff(cells[order], append=-1))
    highest: Integers = order[last]
    return highest
