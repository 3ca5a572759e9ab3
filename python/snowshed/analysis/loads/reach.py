"""The danger zone below an edge: how much of the snow comes to rest beyond a distance."""

from __future__ import annotations

import numpy as np

from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats

#: Shares of the snow in tables.
SHARES = (0.5, 0.1, 0.01)


@checked
def distance_passed_by(share: float, distances: Floats, masses: Floats) -> float:
    """Return the distance beyond which a share of the snow rests, m.

    Parameters
    ----------
    share
        Share of the mass, 0 to 1.
    distances : (n,)
        Horizontal distances of the particles from the edge, m.
    masses : (n,)
        Their masses, kg.

    Examples
    --------
    >>> distances = np.linspace(0.0, 10.0, 1001)
    >>> round(distance_passed_by(0.1, distances, np.ones(1001)), 1)
    9.0
    """
    order = np.argsort(distances)
    from_far = np.cumsum(masses[order][::-1])
    index = int(np.searchsorted(from_far, share * from_far[-1]))
    return float(distances[order][::-1][min(index, len(distances) - 1)])
