"""Contacts between labels, and their areas.

The area of a contact is the length of the sum of its voxel faces as vectors. This is exact for a
plane at any angle to the voxels, as for nearly all contacts of grains, and it is additive when
labels are merged. For a curved contact it is the area of the plane across its rim. (Crofton's
formula, which measures the surface to air, also counts lines past the rim of a neck.)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

import numpy as np

from snowshed.analysis.tomography.crofton import DIRECTIONS, neighbours, weight
from snowshed.base.arrays import AnyIntegers, Floats, Integers, Labels, SingleFloats


@dataclass(frozen=True)
class Adjacency:
    """Labels 1 to n, their surfaces to air, and their contacts; lengths are in voxels.

    Attributes
    ----------
    air : (n + 1,)
        Surface of each label to air; that of label 0 is zero.
    pairs : (m, 2)
        Labels that touch, the smaller first, in ascending order.
    normals : (m, 3)
        Sum of the faces of each contact as vectors (z, y, x), from the smaller label to the larger.
    faces : (m,)
        Number of voxel faces between them.
    saddles : (m,)
        The largest distance from the air on a contact; zero if no distance was given.
    """

    air: Floats
    pairs: Integers
    normals: Floats
    faces: Integers
    saddles: Floats

    @property
    def areas(self) -> Floats:
        """Area of each contact, (m,)."""
        return np.asarray(np.linalg.norm(self.normals, axis=1))

    @property
    def contact_areas(self) -> Floats:
        """Area of all contacts of each label, (n + 1,)."""
        both = np.bincount(self.pairs.ravel(), np.repeat(self.areas, 2), minlength=len(self.air))
        return np.asarray(both, dtype=np.float64)

    @property
    def surfaces(self) -> Floats:
        """Whole surface of each label, to air and to others, (n + 1,)."""
        return np.asarray(self.air + self.contact_areas)

    @property
    def coordination(self) -> Integers:
        """Number of neighbours of each label, (n + 1,)."""
        return np.bincount(self.pairs.ravel(), minlength=len(self.air))

    def merged(self, new: AnyIntegers) -> Adjacency:
        """Return the adjacency of labels that were merged.

        Parameters
        ----------
        new : (n + 1,)
            The new label of each label, from 1; 0 stays 0.
        """
        air = np.asarray(np.bincount(new, self.air), dtype=np.float64)
        touching = _PairValues(len(air))
        first, second = new[self.pairs].T
        apart = first != second
        touching.add(first[apart], second[apart], self._columns()[apart])
        return touching.adjacency(air)

    def _columns(self) -> Floats:
        return np.column_stack([self.normals, self.faces, self.saddles])


def find_adjacency(labels: Labels, distance: Optional[SingleFloats] = None) -> Adjacency:
    """Return the adjacency of labels.

    Labels touch at the faces that their voxels share.

    Parameters
    ----------
    labels : (nz, ny, nx)
        0 air, else 1 to n.
    distance : (nz, ny, nx)
        Distance from the air in voxels, for the saddles. [default: all saddles are zero]

    Examples
    --------
    >>> labels = np.ones((8, 4, 4), dtype=np.int32)
    >>> labels[4:] = 2
    >>> touching = find_adjacency(labels)
    >>> touching.pairs.tolist(), touching.faces.tolist()
    ([[1, 2]], [16])
    """
    count = int(labels.max(initial=0)) + 1
    air = np.zeros(count)
    touching = _PairValues(count)
    for direction in DIRECTIONS:
        area = weight(direction)
        heights = neighbours(labels if distance is None else distance, direction)
        for (here, there), (low, high) in zip(neighbours(labels, direction), heights):
            differ = np.nonzero(here != there)
            first, second = here[differ], there[differ]
            ice = np.minimum(first, second) > 0
            air += area * np.bincount(np.maximum(first, second)[~ice], minlength=count)
            if sum(map(abs, direction)) > 1:
                continue
            values = np.zeros((int(np.count_nonzero(ice)), 5))
            values[:, :3] = direction
            values[:, 3] = 1.0
            if distance is not None:
                contact = tuple(axis[ice] for axis in differ)
                values[:, 4] = np.minimum(low[contact], high[contact])
            touching.add(first[ice], second[ice], values)
    return touching.adjacency(air)


class _PairValues:
    """Normals, faces and saddles of pairs of labels, put together from parts of the image."""

    def __init__(self, count: int) -> None:
        self.count = count
        self.keys: list[Integers] = []
        self.values: list[Floats] = []

    def add(self, first: AnyIntegers, second: AnyIntegers, values: Floats) -> None:
        """Add pairs in any order, with normal, faces and saddle as columns; `values` is changed."""
        low, high = np.minimum(first, second), np.maximum(first, second)
        values[first > second, :3] *= -1.0
        keys, values = _unique_keys(low.astype(np.int64) * self.count + high, values)
        self.keys.append(keys)
        self.values.append(values)

    def adjacency(self, air: Floats) -> Adjacency:
        """Return the adjacency of all added pairs."""
        keys, values = _unique_keys(np.concatenate(self.keys), np.concatenate(self.values))
        pairs = np.stack(np.divmod(keys, self.count), axis=1)
        return Adjacency(air, pairs, values[:, :3], values[:, 3].astype(np.int64), values[:, 4])


def _unique_keys(keys: Integers, values: Floats) -> tuple[Integers, Floats]:
    """Return every key once, with the sums of its normals and faces and its largest saddle."""
    if not len(keys):
        return keys, values
    order = np.argsort(keys, kind="stable")
    keys, values = keys[order], values[order]
    starts = np.flatnonzero(np.r_[True, keys[1:] != keys[:-1]])
    sums = np.add.reduceat(values, starts)
    sums[:, 4] = np.maximum.reduceat(values[:, 4], starts)
    return keys[starts], sums
