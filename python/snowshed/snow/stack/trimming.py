"""Trimming of a stack's edge: the outermost 3 % are dropped (thesis A.4.1, A.4.2).

The thesis counts particles, which all have the same mass there. Here their mass is summed, which is
the same for equal masses and also right for different ones. The last step inward drops only its
outermost particles, so that never more than 3 % are dropped.

The thesis's text on 2D can be read in two ways (A.4.2: "the same principle as the 3D one, but
doesn't need to rotate. Instead, it starts from the 2 ends of the stack and starts to integrate by a
increment dx towards the center of mass"). Both are available by name; `docs/methods/stack.md`
explains the default.

``outermost_first``
    As in 3D: the snow farthest from the centre of mass is dropped first, at either end.
``equal_pace``
    Both ends step inward together. If a chunk has rolled far off on one side, the steps from the
    other end drop most of the 3 % from the stack.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from snowshed._core import InputError
from snowshed.base.arrays import Booleans, Floats, Integers

DROPPED_FRACTION = 0.03
DIVISIONS = 30  # increments of radius and angle, as many as cells of the surface (A.4.3)
#: Default trimming rule.
DEFAULT_TRIMMING = "outermost_first"


def inliers(
    positions: Floats, masses: Floats, dimension: int, trimming: str = DEFAULT_TRIMMING
) -> Booleans:
    """Return the mask of the particles that remain after the outermost 3 % of the mass is dropped.

    Parameters
    ----------
    positions : (n, 3)
        Levelled positions, m.
    masses : (n,)
        Particle masses, kg (any unit will do).
    dimension
        3: from the outside inward around the centre of mass (A.4.1); 2: from both ends (A.4.2).
    trimming
        Trimming rule (thesis A.4.2): one of `TRIMMINGS`. In 3D there is no choice.

    Raises
    ------
    InputError
        If there is no such rule.

    Examples
    --------
    >>> x = np.linspace(0, 1, 100)
    >>> row = np.column_stack([x, 0 * x, 0 * x])
    >>> int(inliers(row, np.ones(100), 2).sum())
    97
    """
    check_trimming(trimming)
    if len(positions) == 0:
        return np.zeros(0, dtype=bool)
    if dimension == 2:
        order = TRIMMINGS[trimming](positions[:, 0], masses)
    else:
        order = circular_order(positions[:, 0], positions[:, 1], masses)
    allowance = DROPPED_FRACTION * masses.sum() * (1 + 1e-9)
    dropped = order[np.cumsum(masses[order]) <= allowance]
    inside = np.ones(len(positions), dtype=bool)
    inside[dropped] = False
    return inside


def outermost_first_order(x: Floats, masses: Floats) -> Integers:
    """Return the order of the distance to the centre of mass, the farthest first.

    Examples
    --------
    >>> outermost_first_order(np.array([0.0, 1.0, 2.0, 9.0]), np.ones(4)).tolist()
    [3, 0, 1, 2]
    """
    return np.argsort(-np.abs(x - np.average(x, weights=masses)), kind="stable")


def equal_pace_order(x: Floats, masses: Floats) -> Integers:
    """Return the order of particles in steps inward from both ends at once.

    Because the last increment drops only its outermost particles, the size of the increments does
    not matter: the order is that of the distance to the nearer end. Masses do not matter, either.

    Examples
    --------
    >>> equal_pace_order(np.array([0.0, 1.0, 2.0, 9.0]), np.ones(4)).tolist()
    [0, 3, 1, 2]
    """
    return np.argsort(np.minimum(x - x.min(), x.max() - x), kind="stable")


#: Trimming rules of A.4.2 by name: functions of x (m) and masses that return the order in which
#: particles are dropped.
TRIMMINGS: Mapping[str, Callable[[Floats, Floats], Integers]] = {
    "outermost_first": outermost_first_order,
    "equal_pace": equal_pace_order,
}


def check_trimming(name: str) -> None:
    """Raise InputError unless there is a trimming rule of that name."""
    if name not in TRIMMINGS:
        raise InputError(f"trimming: {name!r} is unknown; allowed: {', '.join(TRIMMINGS)}")


def circular_order(x: Floats, y: Floats, masses: Floats) -> Integers:
    """Return the order in which a circling arc window meets the particles.

    The window circles around the centre of mass, from the radius R_ini = sqrt(max|X|^2 + max|Y|^2).
    Each lap is one radius increment R_ini / 30 closer. Within a lap, the window moves by angle
    increments of 12 degrees, from the x axis towards y. It reaches one increment to either side of
    its centre: it is two wide and two deep. Within a window the outermost particle comes first.
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
