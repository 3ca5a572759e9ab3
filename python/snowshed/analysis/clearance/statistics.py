"""Required heights by probability, their intervals, and what makes the intervals wide.

Unknowns are of two kinds (Der Kiureghian and Ditlevsen 2009). The weather and chance change from
winter to winter; they are the distribution of the required height. Properties of panel, snow and
grid are the same in every winter, but unknown; like the small number of winters, they make this
distribution uncertain. The interval of a height has its uncertainty.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Optional

import numpy as np

from snowshed.analysis.clearance.common_effects import NO_EFFECTS, common_effects
from snowshed.analysis.clearance.extreme_values import ExtremeValues
from snowshed.base.arrays import Floats

PROBABILITIES = (0.5, 0.9, 0.98)
FIRST_PROBABILITY = 0.9  # of the answer's first sentence
#: The posterior is sampled for several choices of one season from each winter, because a winter
#: has the chance of one season.
CHOICES, SAMPLES_PER_CHOICE, SEED = 20, 200, 1
CONFIDENCE = 0.9
#: Fewer winters are scenarios. Their intervals are wider, so that 90 % is a lower bound.
STATISTIC_WINTERS, SCENARIO_CONFIDENCE = 5, 0.95
WINTERS, GRID = "winters", "grid"  # causes beside the uncertain properties


@dataclass(frozen=True)
class Level:
    """The height of the lower edge that stays clear with a probability.

    Attributes
    ----------
    probability
        Share of winters in which the edge stays clear.
    height, low, high
        The height and its 90 % interval, m.
    extrapolated
        Whether the height exceeds those of the record, because the record is shorter than the
        return period.
    """

    probability: float
    height: float
    low: float
    high: float
    extrapolated: bool

    @property
    def return_period(self) -> float:
        """Years from one burial to the next, on average."""
        return 1.0 / (1.0 - self.probability)


@dataclass(frozen=True)
class CauseShare:
    """Contribution of a cause to the interval of the required height.

    Attributes
    ----------
    cause
        An uncertain property, "winters" (their small number) or "grid".
    part
        Share of the variance of the height's logarithm, 0 to 1.
    low, high
        The interval without this cause, m.
    """

    cause: str
    part: float
    low: float
    high: float


class RequiredHeights:
    """The required height of a panel as a distribution that is itself uncertain.

    Parameters
    ----------
    required, winters : (n,)
        The height that each season needs, m, and the number of its winter.
    positions : of (n,)
        Position of each uncertain property in its range, from -0.5 to 0.5.
    grid_error
        Relative error of the shed snow's height by the grid, such as 0.15, in either direction.
    shed_part
        Part of the required height that is shed snow; the rest has no error of the grid.
    """

    def __init__(
        self,
        required: Floats,
        winters: Floats,
        positions: Mapping[str, Floats],
        grid_error: float = 0.0,
        shed_part: float = 1.0,
    ) -> None:
        random = np.random.default_rng(SEED)
        effects = common_effects(required, winters, positions)
        self.separable = effects is not None
        effects = effects or NO_EFFECTS
        at_centre = required / effects.factor(positions)
        names, numbers = np.unique(winters, return_inverse=True)
        self.winters = len(names)
        self._seasons = [at_centre[numbers == number] for number in range(len(names))]
        count = CHOICES * SAMPLES_PER_CHOICE
        #: Logarithms of the factors on heights, by cause (count,).
        self._factors = effects.sampled(count, random)
        if grid_error > 0.0:
            shed_factor = (1.0 + grid_error) ** (2.0 * random.random(count) - 1.0)
            self._factors[GRID] = np.log1p(shed_part * (shed_factor - 1.0))
        self._random = random

    @property
    def confidence(self) -> float:
        """Share of the sample within an interval."""
        return CONFIDENCE if self.winters >= STATISTIC_WINTERS else SCENARIO_CONFIDENCE

    @cached_property
    def levels(self) -> list[Level]:
        """The heights for `PROBABILITIES`; none if there is only one winter."""
        if self.winters < 2:
            return []
        return [self._level(probability) for probability in PROBABILITIES]

    @property
    def per_winter(self) -> Floats:
        """The height that each winter of the record needed with average properties (n,), m."""
        return np.array([seasons.mean() for seasons in self._seasons])

    @cached_property
    def highest(self) -> tuple[float, float, float]:
        """The height that the record's worst winter needed, m, with its interval."""
        heights = self.per_winter.max() * np.exp(self._log_factor())
        low, middle, high = self._interval(heights)
        return middle, low, high

    @cached_property
    def shares(self) -> list[CauseShare]:
        """The causes of the interval of the first probability, the largest first."""
        logarithms = dict(self._factors)
        if self.winters > 1:
            quantiles = self._distribution.quantile(FIRST_PROBABILITY)
            logarithms[WINTERS] = np.log(np.maximum(quantiles, 1e-3))
        total = sum(values.var() for values in logarithms.values())
        height = sum(logarithms.values())
        shares = []
        for cause, values in logarithms.items():
            low, _, high = self._interval(np.exp(height - values + np.median(values)))
            shares.append(CauseShare(cause, float(values.var() / total), low, high))
        return sorted(shares, key=lambda share: -share.part)

    def burial(self, height: float) -> Optional[tuple[float, float, float]]:
        """Return the probability that snow reaches an edge in a winter, and its interval.

        Parameters
        ----------
        height
            Height of the edge, m.

        Returns
        -------
        tuple or None
            Probability, lower and upper bound, 0 to 1; None if there is only one winter.
        """
        if self.winters < 2:
            return None
        buried = self._distribution.exceedance(height / np.exp(self._log_factor()))
        low, middle, high = self._interval(buried)
        return middle, low, high

    @cached_property
    def _distribution(self) -> ExtremeValues:
        samples = [
            ExtremeValues.of_maxima(
                np.array([self._random.choice(seasons) for seasons in self._seasons]),
                SAMPLES_PER_CHOICE,
                self._random,
            )
            for _ in range(CHOICES)
        ]
        fields = ("location", "scale", "shape")
        return ExtremeValues(
            *(np.concatenate([getattr(part, name) for part in samples]) for name in fields)
        )

    def _log_factor(self) -> Floats:
        return np.asarray(sum(self._factors.values(), np.zeros(CHOICES * SAMPLES_PER_CHOICE)))

    def _level(self, probability: float) -> Level:
        heights = self._distribution.quantile(probability) * np.exp(self._log_factor())
        low, middle, high = self._interval(np.maximum(heights, 0.0))
        extrapolated = self.winters * (1.0 - probability) < 1.0 - 1e-9
        return Level(probability, middle, low, high, extrapolated)

    def _interval(self, values: Floats) -> tuple[float, float, float]:
        """Return the lower bound, the median and the upper bound of a sample."""
        tail = 0.5 * (1.0 - self.confidence)
        low, middle, high = np.quantile(values, [tail, 0.5, 1.0 - tail])
        return float(low), float(middle), float(high)
