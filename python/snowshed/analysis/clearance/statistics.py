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
from snowshed.analysis.clearance.winter_heights import WinterHeights, is_snowy
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats

PROBABILITIES = (0.5, 0.9, 0.98)
FIRST_PROBABILITY = 0.9  # of the answer's first sentence
#: Choices of one season from each winter, and samples for each choice.
CHOICES, SAMPLES_PER_CHOICE = 20, 200
SAMPLES = CHOICES * SAMPLES_PER_CHOICE
#: Variances up to this are rounding errors.
ROUNDING = 1e-20
#: Smallest height whose logarithm is taken, m.
MIN_HEIGHT = 1e-3
CONFIDENCE = 0.9
#: Fewer winters with snow are scenarios. Intervals of their probabilities are wider, so that 90 %
#: is a lower bound.
STATISTIC_WINTERS, SCENARIO_CONFIDENCE = 5, 0.95
#: Causes beside the uncertain properties.
WINTERS, CHANCE, GRID = "winters", "chance", "grid"


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
        Whether the record is shorter than the return period.
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
        An uncertain property, "grid", and either "winters" (their small number) or, for the
        scenario of a few winters, "chance" (seasons of one winter differ).
    part
        Share of the variance of the height's logarithm, 0 to 1.
    low, high
        The interval without this cause, m.
    """

    cause: str
    part: float
    low: float
    high: float


@checked
class RequiredHeights:
    """The required height of a panel as a distribution that is itself uncertain.

    Parameters
    ----------
    required, winters : (n,)
        The height that each season needs, m, and the number of its winter.
    positions : of (n,)
        Position of each uncertain property in its range, from -0.5 to 0.5.
    grid_error
        Relative error of the shed snow's height by the grid, such as 0.15: the height may be too
        large or too small by a factor of up to 1.15.
    shed_part
        Part of the required height that is shed snow; the rest has no error of the grid.
    floor
        Height that a winter without snow needs, m.
    """

    def __init__(
        self,
        required: Floats,
        winters: Floats,
        positions: Mapping[str, Floats],
        grid_error: float = 0.0,
        shed_part: float = 1.0,
        floor: float = 0.0,
    ) -> None:
        random = np.random.default_rng(0)
        effects = common_effects(required, winters, positions)
        self.separable = effects is not None
        effects = effects or NO_EFFECTS
        at_centre = required / effects.factor(positions)
        names, numbers = np.unique(winters, return_inverse=True)
        self._seasons = [at_centre[numbers == number] for number in range(len(names))]
        self._floor = floor
        #: Logarithms of the factors on heights, by cause (m,).
        self._factors = effects.sampled(SAMPLES, random)
        if grid_error > 0.0:
            shed_factor = (1.0 + grid_error) ** (2.0 * random.random(SAMPLES) - 1.0)
            self._factors[GRID] = np.log1p(shed_part * (shed_factor - 1.0))

    @property
    def snowy_winters(self) -> int:
        """Number of winters with snow below the panel."""
        return sum(is_snowy(seasons, self._floor) for seasons in self._seasons)

    @property
    def is_statistic(self) -> bool:
        """Whether there are enough winters for more than a scenario."""
        return self.snowy_winters >= STATISTIC_WINTERS

    @property
    def confidence(self) -> float:
        """Share of the sample within an interval of a probability."""
        return CONFIDENCE if self.is_statistic else SCENARIO_CONFIDENCE

    @property
    def per_winter(self) -> Floats:
        """The height that each winter of the record needed with average properties (n,), m."""
        return np.array([seasons.mean() for seasons in self._seasons])

    @cached_property
    def levels(self) -> list[Level]:
        """The heights for `PROBABILITIES`; none if fewer than two winters have snow."""
        if self.snowy_winters < 2:
            return []
        return [self._level(probability) for probability in PROBABILITIES]

    @cached_property
    def highest(self) -> tuple[float, float, float]:
        """The height that the record's worst winter needed, m, with its 90 % interval."""
        heights = self._worst_seasons * np.exp(self._log_factor)
        low, middle, high = _interval(heights, CONFIDENCE)
        return middle, low, high

    @cached_property
    def shares(self) -> list[CauseShare]:
        """The causes of an interval, the largest first; none if nothing is uncertain.

        The interval is that of the first probability, or of `highest` for a scenario.
        """
        cause, heights = CHANCE, self._worst_seasons
        if self.is_statistic:
            cause, heights = WINTERS, self._winter_heights.quantile(FIRST_PROBABILITY)
        logarithms = {**self._factors, cause: np.log(np.maximum(heights, MIN_HEIGHT))}
        total = sum(values.var() for values in logarithms.values())
        height = sum(logarithms.values())
        shares = []
        for name, values in logarithms.items():
            low, _, high = _interval(np.exp(height - values + np.median(values)), CONFIDENCE)
            if values.var() > ROUNDING:
                shares.append(CauseShare(name, float(values.var() / total), low, high))
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
            Probability, lower and upper bound, 0 to 1; None if fewer than two winters have snow.
        """
        if self.snowy_winters < 2:
            return None
        buried = self._winter_heights.exceedance(height / np.exp(self._log_factor))
        low, middle, high = _interval(buried, self.confidence)
        return middle, low, high

    @cached_property
    def _winter_heights(self) -> WinterHeights:
        return WinterHeights.of_seasons(self._seasons, self._floor, CHOICES, SAMPLES_PER_CHOICE)

    @cached_property
    def _worst_seasons(self) -> Floats:
        """Heights of seasons of the worst winter, chosen at random (m,), m."""
        worst = self._seasons[int(np.argmax(self.per_winter))]
        return np.random.default_rng(2).choice(worst, SAMPLES)

    @cached_property
    def _log_factor(self) -> Floats:
        return np.asarray(sum(self._factors.values(), np.zeros(SAMPLES)))

    def _level(self, probability: float) -> Level:
        heights = self._winter_heights.quantile(probability) * np.exp(self._log_factor)
        low, middle, high = _interval(np.maximum(heights, 0.0), self.confidence)
        extrapolated = len(self._seasons) * (1.0 - probability) < 1.0 - 1e-9
        return Level(probability, middle, low, high, extrapolated)


def _interval(values: Floats, confidence: float) -> tuple[float, float, float]:
    """Return the lower bound, the median and the upper bound of a sample."""
    tail = 0.5 * (1.0 - confidence)
    low, middle, high = np.quantile(values, [tail, 0.5, 1.0 - tail])
    return float(low), float(middle), float(high)
