"""Area of a surface on voxels, from its crossings by lines in 13 directions (Crofton's formula).

A surface of area S is crossed by lines of random direction S/2 times per area across the lines. On
voxels there are 13 directions to the 26 neighbours. Each has the weight of the part of the sphere
that is nearest to it (Ohser and Mücklich 2000, Statistical Analysis of Microstructures in
Materials Science).

Surfaces of all directions come out right within a percent. A plane along two axes comes out 7 %
too small, because only one direction crosses it at a right angle.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from snowshed.base.arrays import Booleans

#: Steps (z, y, x) to a half of the 26 neighbours.
DIRECTIONS = tuple(
    (z, y, x) for z in (-1, 0, 1) for y in (-1, 0, 1) for x in (-1, 0, 1) if (z, y, x) > (0, 0, 0)
)
#: Share of all directions that are nearest to an edge, a face diagonal, or a space diagonal.
_NEAREST = (0.0915557824, 0.0739612558, 0.0703912796)
LAYERS_AT_ONCE = 32  # layers at a time, so that temporary arrays stay small


def weight(direction: tuple[int, int, int]) -> float:
    """Return the area that a crossing in a direction stands for, in squares of the voxel size.

    Examples
    --------
    >>> round(weight((0, 0, 1)), 4)
    0.1831
    """
    squared = sum(step * step for step in direction)
    return float(2.0 * _NEAREST[squared - 1] / np.sqrt(squared))


def neighbours(
    voxels: NDArray[Any], direction: tuple[int, int, int]
) -> Iterator[tuple[NDArray[Any], NDArray[Any]]]:
    """Yield views of the voxels and of their neighbours in a direction, some layers at a time."""
    step_z, step_y, step_x = direction
    _, ny, nx = voxels.shape
    here_y, there_y = _overlap(step_y, ny)
    here_x, there_x = _overlap(step_x, nx)
    last = len(voxels) - step_z
    for low in range(0, last, LAYERS_AT_ONCE):
        high = min(low + LAYERS_AT_ONCE, last)
        yield (
            voxels[low:high, here_y, here_x],
            voxels[low + step_z : high + step_z, there_y, there_x],
        )


def _overlap(step: int, count: int) -> tuple[slice, slice]:
    """Return the voxels along an axis with a neighbour at a distance, and these neighbours."""
    if step < 0:
        return slice(-step, count), slice(0, count + step)
    return slice(0, count - step), slice(step, count)


def surface_area(phase: Booleans, voxel_size: float = 1.0) -> float:
    """Return the area of the surface between a phase and the other, m2.

    The sides of the image do not belong to it.

    Parameters
    ----------
    phase : (nz, ny, nx)
        Mask of one of the two phases.
    voxel_size
        Edge of a voxel, m.

    Examples
    --------
    >>> at = np.indices((24, 24, 24)) - 11.5
    >>> area = surface_area((at**2).sum(axis=0) < 10.0**2)
    >>> round(area / (4 * np.pi * 10.0**2), 2)
    1.0
    """
    area = sum(weight(direction) * _crossings(phase, direction)[0] for direction in DIRECTIONS)
    return area * voxel_size**2


def surface_density(phase: Booleans, voxel_size: float = 1.0) -> float:
    """Return the surface between two phases per volume of an image that is part of a whole, 1/m.

    Unlike in `surface_area`, directions with more lines cut at the sides do not have less weight.

    Examples
    --------
    >>> layers = np.zeros((12, 12, 12), dtype=bool)
    >>> layers[::2] = True
    >>> round(surface_density(layers), 2)  # 7 % too small: a plane along two axes
    0.93
    """
    crossed = ((weight(direction), *_crossings(phase, direction)) for direction in DIRECTIONS)
    return sum(area * crossings / pairs for area, crossings, pairs in crossed) / voxel_size


def _crossings(phase: Booleans, direction: tuple[int, int, int]) -> tuple[int, int]:
    """Return the number of different neighbours in a direction, and of all neighbours."""
    crossings = pairs = 0
    for here, there in neighbours(phase, direction):
        crossings += int(np.count_nonzero(here != there))
        pairs += here.size
    return crossings, max(pairs, 1)
