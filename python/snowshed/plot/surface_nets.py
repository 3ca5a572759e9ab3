"""The surface of a sampled solid as triangles (surface nets), and its section in a plane."""

from __future__ import annotations

import numpy as np

from snowshed.base.arrays import Floats, Integers

EDGES = [
    (a, b) for a in range(8) for b in range(a + 1, 8) if (a ^ b) in (1, 2, 4)
]  # of a cube whose corners are numbered by bits: x 4, y 2, z 1


def surface_of(distance: Floats) -> tuple[Floats, Integers]:
    """Return the surface where samples change their sign.

    Every cell that the surface crosses has a vertex, at the mean of the crossed points of the
    cell's edges. The four cells around a crossed edge make two triangles.

    Parameters
    ----------
    distance : (nx, ny, nz)
        Distances at the samples: negative inside, positive on the whole border.

    Returns
    -------
    corners : (n, 3)
        Vertices in units of samples, from the first.
    triangles : (m, 3)

    References
    ----------
    Gibson, S. F. F. (1998): Constrained elastic surface nets. MICCAI, LNCS 1496, 888-898.

    Examples
    --------
    >>> x = np.arange(-6.0, 7.0)
    >>> ball = np.sqrt(x[:, None, None] ** 2 + x[:, None] ** 2 + x**2) - 4.0
    >>> corners, triangles = surface_of(ball)
    >>> bool(np.abs(np.linalg.norm(corners - 6.0, axis=1) - 4.0).max() < 0.4)
    True
    """
    inside = distance < 0.0
    corners = [
        distance[tuple(slice(int(b), n - 1 + int(b)) for b, n in zip(f"{c:03b}", distance.shape))]
        for c in range(8)
    ]
    total = np.zeros((*corners[0].shape, 3))
    count = np.zeros(corners[0].shape)
    for a, b in EDGES:
        crossed = (corners[a] < 0.0) != (corners[b] < 0.0)
        share = corners[a] / np.where(crossed, corners[a] - corners[b], 1.0)
        start, end = (np.array([int(bit) for bit in f"{c:03b}"], dtype=float) for c in (a, b))
        total += np.where(crossed[..., None], start + share[..., None] * (end - start), 0.0)
        count += crossed
    held = count > 0
    number = np.full(count.shape, -1)
    number[held] = np.arange(int(held.sum()))
    vertices = np.argwhere(held) + total[held] / count[held][:, None]
    triangles = [_around(inside, number, axis) for axis in range(3)]
    return vertices, np.concatenate(triangles)


def section_of(distance: Floats) -> tuple[Floats, Integers]:
    """Return the section of a solid in a plane, in strips between neighbouring columns of samples.

    Between two columns that are inside over equally many pieces, a piece is a trapezoid. Elsewhere
    the pieces of a column end half way to the next.

    Parameters
    ----------
    distance : (nx, nz)
        Distances at the samples: negative inside.

    Returns
    -------
    corners : (n, 2)
        Vertices in units of samples, from the first.
    triangles : (m, 3)

    Examples
    --------
    >>> x = np.arange(-6.0, 7.0)
    >>> corners, triangles = section_of(np.hypot(x[:, None], x) - 4.0)
    >>> a, b, c = (corners[triangles[:, k]] for k in range(3))
    >>> area = 0.5 * np.abs(np.cross(np.pad(b - a, (0, 1)), np.pad(c - a, (0, 1)))[:, 2]).sum()
    >>> bool(abs(area - 16.0 * np.pi) < 3.0)
    True
    """
    columns = [_pieces(column) for column in distance]
    quads: list[tuple[tuple[float, float], ...]] = []
    for x, (left, right) in enumerate(zip(columns, columns[1:])):
        if len(left) == len(right):
            quads += [
                ((x, a), (x + 1, c), (x + 1, d), (x, b)) for (a, b), (c, d) in zip(left, right)
            ]
            continue
        for start, pieces in ((x, left), (x + 0.5, right)):
            quads += [
                ((start, a), (start + 0.5, a), (start + 0.5, b), (start, b)) for a, b in pieces
            ]
    corners = np.array(quads, dtype=float).reshape(-1, 2)
    first = 4 * np.arange(len(quads))[:, None]
    triangles: Integers = np.concatenate(
        [first + np.array(half) for half in ([0, 1, 2], [0, 2, 3])]
    )
    return corners, triangles


def _pieces(column: Floats) -> list[tuple[float, float]]:
    """Return the pieces of a column that are inside, in units of samples."""
    inside = np.concatenate([[False], column < 0.0, [False]])
    ends = []
    for at in np.flatnonzero(inside[1:] != inside[:-1]).tolist():
        if at in (0, len(column)):  # the solid reaches beyond the samples
            ends.append(float(max(at - 1, 0)) if at else 0.0)
            continue
        below, above = float(column[at - 1]), float(column[at])
        ends.append(at - 1 + below / (below - above))
    return list(zip(ends[::2], ends[1::2]))


def _around(inside: np.ndarray, number: Integers, axis: int) -> Integers:
    """Return the triangles around the edges along an axis that the surface crosses."""
    first, second = (k for k in range(3) if k != axis)
    crossed = np.diff(inside.astype(np.int8), axis=axis) != 0
    at = np.argwhere(crossed)
    at = at[(at[:, first] > 0) & (at[:, second] > 0)]
    at = at[(at[:, first] < number.shape[first]) & (at[:, second] < number.shape[second])]
    step = np.eye(3, dtype=int)
    a, b = at - step[first] - step[second], at - step[second]
    c, d = at, at - step[first]
    quads = np.stack([number[tuple(corner.T)] for corner in (a, b, c, d)], axis=1)
    quads = quads[(quads >= 0).all(axis=1)]
    triangles: Integers = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return triangles
