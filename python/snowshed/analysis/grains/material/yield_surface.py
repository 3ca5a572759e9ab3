"""The law's yield surface through the strengths of grains, in the plane of p and q.

The surface is (1 + 2 beta) q^2 + M^2 (p + beta p0)(p - p0) = 0 (thesis 1.2.6).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats

COHESIONS = np.linspace(0.0, 1.0, 201)  # values in scenes (`snowshed.Snow`)


@dataclass(frozen=True)
class YieldSurface:
    """A yield surface whose p0 is known.

    Attributes
    ----------
    slope, cohesion
        M and beta.
    residual
        Root mean square of the residual of q, relative to that of q.
    """

    slope: float
    cohesion: float
    residual: float


@checked
def fit_yield_surface(p: Floats, q: Floats) -> YieldSurface:
    """Return the surface fitted to measured strengths by least squares in q.

    For a given beta q is proportional to M, so that only beta is searched for.

    Parameters
    ----------
    p, q : (n,)
        Stresses of the strengths, relative to p0; p is negative in tension.

    Raises
    ------
    InputError
        If no surface has strength at the measured pressures.

    Examples
    --------
    >>> p = np.array([-0.05, 0.1, 0.3])
    >>> found = fit_yield_surface(p, 0.8 * np.sqrt((p + 0.2) * (1 - p) / 1.4))
    >>> round(found.slope, 6), round(found.cohesion, 6)
    (0.8, 0.2)
    """
    from scipy.optimize import minimize_scalar

    def surface(beta: float) -> YieldSurface:
        shape = np.sqrt(np.maximum((p + beta) * (1 - p), 0.0) / (1 + 2 * beta))
        norm = float(shape @ shape)
        slope = float(shape @ q) / norm if norm > 0 else 0.0
        missed = float(np.linalg.norm(q - slope * shape) / np.linalg.norm(q))
        return YieldSurface(slope, beta, missed)

    if not np.linalg.norm(q) > 0:
        raise InputError("the grains bear no shear: no yield surface can be fitted")
    coarse = [surface(beta).residual for beta in COHESIONS]
    best = int(np.argmin(coarse))
    around = COHESIONS[[max(best - 1, 0), min(best + 1, len(COHESIONS) - 1)]]
    fine = minimize_scalar(
        lambda beta: surface(beta).residual, bounds=tuple(around), options={"xatol": 1e-10}
    )
    best_fit = min(
        surface(float(COHESIONS[best])), surface(float(fine.x)), key=lambda s: s.residual
    )
    if not best_fit.slope > 0:
        raise InputError("no yield surface fits: the law has no strength at the measured pressures")
    return best_fit
