"""Collapsing columns of grains: results of experiments, and measures of a deposit."""

from __future__ import annotations

import math

import numpy as np

from snowshed.base.arrays import Floats

SECTORS = 24  # directions in which the front of a round deposit is measured


def runout_law(aspect: float, dimension: int) -> float:
    """Return the run-out (r_inf - r_0) / r_0 of a collapsed column of grains.

    Plane (Lube et al. 2005): 1.2 a for a < 1.8, 1.9 a^(2/3) for a > 2.8; between these limits
    powers of a are interpolated. Round (Lube et al. 2004): 1.24 a for a < 1.7, 1.6 a^(1/2) above.

    Examples
    --------
    >>> runout_law(1.0, 2), runout_law(4.0, 3)
    (1.2, 3.2)
    """
    if dimension == 3:
        return 1.24 * aspect if aspect < 1.7 else 1.6 * math.sqrt(aspect)
    if aspect <= 1.8:
        return 1.2 * aspect
    if aspect >= 2.8:
        return 1.9 * math.pow(aspect, 2 / 3)
    ends = np.log([1.8, 2.8]), np.log([runout_law(1.8, 2), runout_law(2.8, 2)])
    return float(np.exp(np.interp(math.log(aspect), *ends)))


def height_law(aspect: float, dimension: int) -> float:
    """Return the final height h_inf / r_0 of a collapsed column of grains.

    The height stays the initial one as long as the column's middle does not sink. Taller columns
    have a^(2/5) in the plane (Lube et al. 2005) and 0.88 a^(1/6) if they are round (Lube et al.
    2004).

    Examples
    --------
    >>> height_law(0.5, 2), round(height_law(4.0, 3), 3)
    (0.5, 1.109)
    """
    factor, power = (1.0, 2 / 5) if dimension == 2 else (0.88, 1 / 6)
    return min(aspect, factor * math.pow(aspect, power))


def glass_runout_law(aspect: float) -> float:
    """Return the run-out (L_inf - L_0) / L_0 of a plane column of glass beads, for a below 3.

    Lajeunesse et al. (2005), with the constant quoted by Lagrée et al. (2011).

    Examples
    --------
    >>> glass_runout_law(1.0)
    1.8
    """
    return 1.8 * aspect


def critical_state_slope(friction_angle: float, dimension: int) -> float:
    """Return the M of a critical state with Coulomb's friction angle, degrees.

    In the plane, q = sqrt(3) (s1 - s3) / 2 and p = (s1 + s3) / 2, so Coulomb's
    (s1 - s3) = (s1 + s3) sin phi is q = sqrt(3) sin(phi) p. In space
    M is 6 sin phi / (3 - sin phi), the usual match in triaxial compression.

    Examples
    --------
    >>> round(critical_state_slope(30, 2), 3), round(critical_state_slope(30, 3), 3)
    (0.866, 1.2)
    """
    sine = math.sin(math.radians(friction_angle))
    return math.sqrt(3) * sine if dimension == 2 else 6 * sine / (3 - sine)


def front(positions: Floats) -> float:
    """Return the distance of a deposit's front from the axis, as the mean over directions, m.

    Parameters
    ----------
    positions : (n, 3)
        Positions, m; with y = 0 throughout in 2D, where there are two directions.

    Examples
    --------
    >>> front(np.array([[-1.0, 0, 0], [2.0, 0, 0], [0.5, 0, 1]]))
    1.5
    """
    x, y, _ = positions.T
    sectors = SECTORS if np.any(y) else 2
    # Sectors are shifted by half their width, so that plane deposits lie in the middles of two.
    turn = (np.arctan2(y, x) / (2 * np.pi) + 0.5 / sectors) % 1.0
    sector = np.minimum((turn * sectors).astype(int), sectors - 1)
    farthest = np.zeros(sectors)
    np.maximum.at(farthest, sector, np.hypot(x, y))
    return float(farthest.mean())
