"""Connected bodies of snow: the lab measured "a continuous body" (thesis 2.3)."""

from __future__ import annotations

from itertools import product

import numpy as np

from snowshed.base.arrays import Booleans, Floats, Integers


def largest_body(positions: Floats, masses: Floats, voxel: float) -> Booleans:
    """Return the mask of the particles in the connected body with the largest mass.

    Parameters
    ----------
    positions : (n, 3)
        Positions of the particles, m.
    masses : (n,)
        Masses, kg.
    voxel
        Edge of the voxels, m.

    Examples
    --------
    >>> x = np.array([[0.0, 0, 0], [0.01, 0, 0], [0.5, 0, 0]])
    >>> largest_body(x, np.ones(3), 0.01).tolist()
    [True, True, False]
    """
    if len(positions) == 0:
        return np.zeros(0, dtype=bool)
    labels = connected_bodies(positions, voxel)
    member: Booleans = labels == np.argmax(np.bincount(labels, weights=masses))
    return member


def connected_bodies(positions: Floats, voxel: float) -> Integers:
    """Label the connected bodies; particles of one body share a number.

    Space is cut into voxels of edge `voxel`. Particles belong together if their voxels are the
    same or touch by a face, an edge or a corner. Particles closer than `voxel` are therefore
    always linked, and gaps wider than 2 `voxel` along an axis always part.

    Returns
    -------
    (n,)
        Body of each particle, numbered from 0.
    """
    from scipy.sparse import coo_matrix  # loads more slowly than snowshed
    from scipy.sparse.csgraph import connected_components

    index = np.floor((positions - positions.min(axis=0)) / voxel).astype(np.int64)
    extent = index.max(axis=0) + 2  # an empty layer separates the ends of rows
    stride = np.array([extent[1] * extent[2], extent[2], 1])
    keys, voxel_of = np.unique(index @ stride, return_inverse=True)
    first, second = _touching(keys, stride)
    links = coo_matrix((np.ones(len(first)), (first, second)), (len(keys), len(keys)))
    _, labels = connected_components(links, directed=False)
    of_particles: Integers = labels.astype(np.int64)[voxel_of.reshape(-1)]
    return of_particles


def _touching(keys: Integers, stride: Integers) -> tuple[Integers, Integers]:
    """Return the pairs of occupied voxels that touch, as indices into the sorted `keys`."""
    pairs = []
    for offset in list(product((-1, 0, 1), repeat=3))[14:]:  # half of the 26: each pair once
        other = keys + np.dot(offset, stride)
        indices = np.minimum(np.searchsorted(keys, other), len(keys) - 1)
        hit = np.flatnonzero(keys[indices] == other)
        pairs.append((hit, indices[hit]))
    return np.concatenate([a for a, _ in pairs]), np.concatenate([b for _, b in pairs])
