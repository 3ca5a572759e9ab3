"""Orders of convergence, by which errors fall with the size of cells, steps or increments."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import nan

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.snow.accuracy.measurements import CaseSettings
from snowshed.snow.accuracy.solutions import Solution, convergence_series


@dataclass(frozen=True)
class Convergence:
    """Fall of an error with one setting while all others are equal.

    Attributes
    ----------
    settings
        The other settings.
    sizes, errors
        The setting's values, from the coarsest to the finest, and the errors.
    order
        Slope of the least-squares line through their logarithms; NaN if it is not defined.
    pairwise
        Slopes between neighbours; there is one fewer than sizes.
    """

    settings: CaseSettings
    sizes: Floats
    errors: Floats
    order: float
    pairwise: Floats


def observed_order(sizes: Floats, errors: Floats) -> float:
    """Return the order of convergence: the least-squares slope of log error over log size.

    The order is NaN for fewer than two different sizes, or if an error is zero or not finite.

    Examples
    --------
    >>> round(observed_order(np.array([0.4, 0.2, 0.1]), 3 * np.array([0.16, 0.04, 0.01])), 6)
    2.0
    """
    errors = np.abs(errors)
    if len(set(sizes)) < 2 or not np.all((errors > 0) & np.isfinite(errors)):
        return nan
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])


def pairwise_orders(sizes: Floats, errors: Floats) -> Floats:
    """Return the slope of log error over log size between neighbours.

    Examples
    --------
    >>> pairwise_orders(np.array([0.4, 0.2, 0.1]), np.array([0.8, 0.4, 0.1])).round(6).tolist()
    [1.0, 2.0]
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        slopes: Floats = np.diff(np.log(np.abs(errors))) / np.diff(np.log(sizes))
    return slopes


def convergences(solutions: Sequence[Solution], order_in: str) -> list[Convergence]:
    """Return the fall of the error with a setting (``"dx"``), for each choice of the others."""
    series = []
    for group in convergence_series(solutions, order_in):
        if len(group) > 1:
            sizes = np.array([float(solution.settings[order_in]) for solution in group])
            errors = np.array([abs(solution.error) for solution in group])
            others = {k: v for k, v in group[0].settings.items() if k != order_in}
            order, pairwise = observed_order(sizes, errors), pairwise_orders(sizes, errors)
            series.append(Convergence(others, sizes, errors, order, pairwise))
    return series
