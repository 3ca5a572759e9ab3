"""Which particles belong to a stack's edge: the outermost 3 % are dropped (thesis A.4.1, A.4.2).

The thesis counts particles, because they all carry the same mass there; here their mass is summed,
which is the same where masses are equal and still right where they are not. The last step inward
gives up only its outermost particles, so that never more than 3 % go.
"""

from __future__ import annotations

import numpy as np

from snowshed.io.arrays import Booleans, Floats, Integers

DROPPED_FRACTION = 0.03
DIVISIONS = 30  # of radius and angle, as of the grid of the surface (A.4.3)


def inliers(positions: Floats, masses: Floats, dimension: int) -> Booleans:
    """Return which particles remain when the outermost 3 % of the mass is dropped.

    Parameters
    ----------
    positions : (n, 3)
        Levelled positions, m.
    masses : (n,)
        Particle masses, kg (any unit will do).
    dimension
        3: from the outside inward around the centre of mass (A.4.1); 2: from both ends (A.4.2).

    Examples
    --------
    >>> x = np.linspace(0, 1, 100)
    >>> row = np.column_stack([x, 0 * x, 0 * x])
    >>> int(inliers(row, np.ones(100), 2).sum())
    97
    """
    if len(positions) == 0:
        return np.zeros(0, dtype=bool)
    if dimension == 2:
        order = end_inward_order(positions[:, 0])
    else:
        order = circular_order(positions[:, 0], positions[:, 1], masses)
    allowance = DROPPED_FRACTION * masses.sum() * (1 + 1e-9)
    dropped = order[np.cumsum(masses[order]) <= allowance]
    kept = np.ones(len(positions), dtype=bool)
    kept[dropped] = False
    return kept


def end_inward_order(x: Floats) -> Integers:
    """Return the order in which particles are met when stepping inward from both ends at once.

    Both ends step at the same pace, as the text says, wherever the snow lies: when a chunk has
    rolled far off on one side, the steps from the other end take most of the 3 % from the stack.
    The extent of the largest connected body is there for that.

    Since the last increment gives up only its outermost particles, the size of the increments
    does not matter: it is the order of the distance to the nearer end.
    """
    return np.argsort(np.minimum(x - x.min(), x.max() - x), kind="stable")


def circular_order(x: Floats, y: Floats, masses: Floats) -> Integers:
    """Return the order in which a circling arc window meets the particles.

    Around the centre of mass, from R_ini = sqrt(max|X|^2 + max|Y|^2), one radius increment
    R_ini / 30 closer each lap; in a lap one angle increment of 12 degrees after the other,
    counted from the x axis towards y. The window reaches one increment to either side of its
    centre: it is two wide and two deep. Within a window the outermost particle comes first.
    """
    x = x - np.average(x, weights=masses)
    y = y - np.average(y, weights=masses)
    radius, angle = np.hypot(x, y), np.arctan2(y, x) % (2 * np.pi)
    start = np.hypot(np.abs(x).max(), np.abs(y).max())
    inward, turn = (start or 1.0) / DIVISIONS, 2 * np.pi / DIVISIONS
    lap = _first_window((start - radius) / inward)
    window = np.where(angle >= 2 * np.pi - turn, 0.0, _first_window(angle / turn))
    return np.lexsort((-radius, window, lap))


def _first_window(increments: Floats) -> Floats:
    """Return the first whole number k >= 0 whose window [k - 1, k + 1] holds the value."""
    window: Floats = np.maximum(np.ceil(increments) - 1, 0.0)
    return window
