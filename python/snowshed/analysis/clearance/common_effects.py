"""Effects of properties that are unknown, but the same in every winter.

The seasons of a winter differ by their drawn properties. Their required heights are fitted as the
winter's height times a factor of the properties. The factor is exponential in the position of each
property in its range, so that it is positive.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Optional

import numpy as np

from snowshed.base.arrays import Floats

#: Fewest seasons beyond the number of fitted values for which effects are fitted.
MIN_FREE = 8


@dataclass(frozen=True)
class CommonEffects:
    """Effects of properties on the required height.

    Attributes
    ----------
    names
        The properties whose effects were fitted.
    slopes : (k,)
        Change of the height's logarithm from the lowest to the highest value of each.
    covariance : (k, k)
        Covariance of the slopes' errors.
    """

    names: tuple[str, ...]
    slopes: Floats
    covariance: Floats

    def factor(self, positions: Mapping[str, Floats]) -> Floats:
        """Return the factor of seasons on the height at the centre of all ranges (n,).

        Parameters
        ----------
        positions : of (n,)
            Positions in the ranges, from -0.5 to 0.5.
        """
        logarithm = sum(slope * positions[name] for name, slope in zip(self.names, self.slopes))
        return np.asarray(np.exp(logarithm))

    def sampled(self, count: int, random: np.random.Generator) -> dict[str, Floats]:
        """Return logarithms of each property's factor (count,).

        Both the property and its slope are uncertain: it lies evenly in its range.
        """
        if not self.names:
            return {}
        slopes = random.multivariate_normal(self.slopes, self.covariance, count, method="eigh")
        positions = random.random(slopes.shape) - 0.5
        return dict(zip(self.names, (slopes * positions).T))


NO_EFFECTS = CommonEffects((), np.zeros(0), np.zeros((0, 0)))


def common_effects(
    required: Floats, winters: Floats, positions: Mapping[str, Floats]
) -> Optional[CommonEffects]:
    """Return the effects of uncertain properties.

    Parameters
    ----------
    required, winters : (n,)
        Required height of each season, m, and the number of its winter.
    positions : of (n,)
        Position of each uncertain property in its range, from -0.5 to 0.5.

    Returns
    -------
    CommonEffects or None
        None if there are too few seasons to fit the effects.

    Examples
    --------
    >>> winters = np.repeat(np.arange(6.0), 3)
    >>> adhesion = np.linspace(-0.5, 0.5, 18)[7 * np.arange(18) % 18]
    >>> effects = common_effects((1 + winters) * np.exp(0.2 * adhesion), winters,
    ...                          {"adhesion": adhesion})
    >>> effects.slopes.round(3)
    array([0.2])
    """
    from scipy.optimize import least_squares

    uncertain = list(positions)
    names, numbers = np.unique(winters, return_inverse=True)
    free = len(required) - len(names) - len(uncertain)
    if not uncertain:
        return NO_EFFECTS
    if free < MIN_FREE:
        return None
    matrix = np.column_stack([positions[name] for name in uncertain])

    def residuals(values: Floats) -> Floats:
        slopes, heights = np.split(values, [len(uncertain)])
        return np.asarray(heights[numbers] * np.exp(matrix @ slopes) - required)

    means = np.bincount(numbers, required) / np.bincount(numbers)
    fit = least_squares(residuals, np.concatenate([np.zeros(len(uncertain)), means]))
    inverse = np.linalg.pinv(fit.jac.T @ fit.jac)[: len(uncertain), : len(uncertain)]
    variance = float(fit.fun @ fit.fun) / free
    return CommonEffects(tuple(uncertain), fit.x[: len(uncertain)], variance * inverse)
