"""The support of snow: the ground, the panel, or a structure.

A stack is the snow below the panel. Snow that hangs over the panel's edge, or lies on a roof, a
guard or another panel, is excluded according to the support of its connected body.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from snowshed.base.arrays import Booleans, Floats, Integers
from snowshed.snow.stack.connected_components import connected_bodies

MAX_GROUND_GAP = 2.0  # largest height of the lowest snow of a body on the ground, cells
MIN_FALLING_GAP = 4.0  # smallest distance of a falling body from the snow on the ground, cells


@dataclass(frozen=True)
class Support:
    """Support of the snow off the panel, and whether it touches the snow on the panel.

    Attributes
    ----------
    at_panel, on_structure, falling : (n,)
        Masks of particles in bodies that do not reach the ground, because snow on the panel or a
        structure holds them, or because they still fall.
    joined
        Whether a body that lies on the ground touches the snow on the panel.
    """

    at_panel: Booleans
    on_structure: Booleans
    falling: Booleans
    joined: bool


def supports(
    snow: Floats, on_panel_snow: Floats, touches_structure: Booleans, heights: Floats, dx: float
) -> Support:
    """Return the support of snow.

    Parameters
    ----------
    snow : (n, 3)
        Positions of snow that does not lie on the panel, m.
    on_panel_snow : (k, 3)
        Positions of the snow on the panel.
    touches_structure : (n,)
        Whether each particle touches a structure other than the panel.
    heights : (n,)
        Heights above the ground below, m.
    dx
        Size of the grid cells, m: snow closer than that is one body.

    Examples
    --------
    >>> eaves, pile = np.array([[0.0, 0, 2]]), np.array([[0.1, 0, 0]])
    >>> snow = np.vstack([eaves, pile])
    >>> found = supports(snow, eaves - [0.05, 0, 0], np.zeros(2, bool), snow[:, 2], 0.1)
    >>> found.at_panel.tolist(), found.joined
    ([True, False], False)
    """
    if len(snow) == 0:
        none = np.zeros(0, dtype=bool)
        return Support(none, none, none, False)
    at_panel = _near(snow, on_panel_snow, dx)
    bodies = connected_bodies(snow, dx)
    lowest = np.full(bodies.max() + 1, np.inf)
    np.minimum.at(lowest, bodies, heights)
    aground = lowest <= MAX_GROUND_GAP * dx
    by_panel = _has(bodies, at_panel) & ~aground
    by_structure = _has(bodies, touches_structure) & ~aground & ~by_panel
    rest = ~(aground | by_panel | by_structure)
    aloft = np.zeros(len(aground), dtype=bool)
    if rest.any():
        loose = rest[bodies]
        near = _near(snow[loose], snow[aground[bodies]], MIN_FALLING_GAP * dx)
        aloft = rest & ~np.isin(np.arange(len(rest)), bodies[loose][near])
    joined = bool((aground[bodies] & at_panel).any())
    return Support(by_panel[bodies], by_structure[bodies], aloft[bodies], joined)


def _has(bodies: Integers, marked: Booleans) -> Booleans:
    """Return a flag for each body: whether it has a marked particle."""
    has: Booleans = np.bincount(bodies, weights=marked) > 0
    return has


def _near(snow: Floats, others: Floats, distance: float) -> Booleans:
    """Return the mask of particles that are nearer than a distance to any of the others."""
    from scipy.spatial import cKDTree  # loads more slowly than snowshed

    if len(snow) == 0 or len(others) == 0:
        return np.zeros(len(snow), dtype=bool)
    distances, _ = cKDTree(others).query(snow, distance_upper_bound=distance)
    near: Booleans = np.isfinite(distances)
    return near
