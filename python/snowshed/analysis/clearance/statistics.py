"""Required heights by probability, their confidence, and the causes of their variance."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from snowshed.base.arrays import Floats

PROBABILITIES = (0.5, 0.9, 0.98)
RESAMPLES, SEED = 1000, 1
CONFIDENCE = 0.9
EULER = 0.5772156649015329


@dataclass(frozen=True)
class Level:
    """The height of the lower edge that stays clear with a probability.

    Attributes
    ----------
    probability
        Share of winters in which the edge stays clear.
    height, low, high
        The height and its 90 % confidence interval over winters, m.
    counted
        Whether the height is counted from enough winters; otherwise it is extrapolated with a
        Gumbel distribution of the highest snow of a winter.
    """

    probability: float
    height: float
    low: float
    high: float
    counted: bool

    @property
    def return_period(self) -> float:
        """Years from one burial to the next, on average."""
        return 1.0 / (1.0 - self.probability)


@dataclass(frozen=True)
class CauseShare:
    """The share of a cause in the variance of the required height, 0 to 1."""

    cause: str
    part: float


def levels_of(required: Floats, winters: Floats) -> list[Level]:
    """Return the heights for `PROBABILITIES`.

    Parameters
    ----------
    required : (n,)
        The height that each case needs, m.
    winters : (n,)
        The winter of each case. Winters are resampled as a whole (bootstrap), because the cases of
        a winter are not independent.

    Examples
    --------
    >>> level = levels_of(np.linspace(1.0, 2.0, 101), np.arange(101.0))[1]
    >>> round(level.height, 2), level.low < 1.9 < level.high, level.counted
    (1.9, True, True)
    """
    names = np.unique(winters)
    random = np.random.default_rng(SEED)
    own = [required[winters == name] for name in names]
    samples = [
        np.concatenate([own[i] for i in random.integers(0, len(own), len(own))])
        for _ in range(RESAMPLES)
    ]
    tail = 0.5 * (1.0 - CONFIDENCE)
    levels = []
    for probability in PROBABILITIES:
        counted = len(names) * (1.0 - probability) >= 1.0 - 1e-9
        estimates = [_height(sample, probability, counted) for sample in samples]
        low, high = np.quantile(estimates, [tail, 1.0 - tail])
        height = _height(required, probability, counted)
        levels.append(Level(probability, height, float(low), float(high), counted))
    return levels


def _height(required: Floats, probability: float, counted: bool) -> float:
    if counted:
        return float(np.quantile(required, probability))
    return gumbel_quantile(float(required.mean()), float(required.std()), probability)


def gumbel_quantile(mean: float, deviation: float, probability: float) -> float:
    """Return the quantile of the Gumbel distribution with a mean and a standard deviation.

    Examples
    --------
    >>> round(gumbel_quantile(0.0, 1.0, 0.98), 3)  # the 50-year value
    2.592
    """
    reduced = -np.log(-np.log(probability))
    return float(mean + deviation * np.sqrt(6.0) / np.pi * (reduced - EULER))


def burial_interval(buried: float, winters: int) -> tuple[float, float]:
    """Return the 90 % confidence interval of the probability of a burial.

    The interval is that of Clopper and Pearson (1934), with one trial per winter.

    Parameters
    ----------
    buried
        Share of the cases in which the snow reaches the edge.
    winters
        Number of winters.

    Examples
    --------
    >>> low, high = burial_interval(0.1, 10)
    >>> round(low, 3), round(high, 3)
    (0.005, 0.394)
    """
    from scipy.stats import beta

    count, tail = buried * winters, 0.5 * (1.0 - CONFIDENCE)
    low = 0.0 if count <= 0.0 else float(beta.ppf(tail, count, winters - count + 1.0))
    high = 1.0 if count >= winters else float(beta.ppf(1.0 - tail, count + 1.0, winters - count))
    return low, high


def shares_of(required: Floats, winters: Floats, values: Mapping[str, Floats]) -> list[CauseShare]:
    """Return the share of each cause in the variance of the required height.

    The height is fitted as a sum of linear effects of the uncertain parameters and an effect of
    each winter. The residual is chance: the particles' positions, and interactions of causes.

    Parameters
    ----------
    required, winters : (n,)
        As for `levels_of`.
    values : of (n,)
        Drawn values by name.

    Examples
    --------
    >>> x = np.linspace(0.0, 1.0, 40)
    >>> shares_of(2.0 * x, np.arange(40.0) % 4, {"adhesion": x})[0].cause
    'adhesion'
    """
    varied = {name: x - x.mean() for name, x in values.items() if np.ptp(x) > 0.0}
    dummies = (winters[:, None] == np.unique(winters)).astype(float)
    dummies -= dummies.mean(axis=0)
    matrix = np.column_stack([*varied.values(), dummies])
    spread = float(required.var())
    if spread == 0.0 or len(required) <= len(varied) + dummies.shape[1]:
        return []
    effects, *_ = np.linalg.lstsq(matrix, required - required.mean(), rcond=None)
    parts = {
        name: float((effect * x).var()) / spread
        for (name, x), effect in zip(varied.items(), effects)
    }
    parts["winter"] = float((dummies @ effects[len(varied) :]).var()) / spread
    residual = float((required - required.mean() - matrix @ effects).var()) / spread
    parts["chance"] = residual
    total = sum(parts.values())
    shares = [CauseShare(name, part / total) for name, part in parts.items()]
    return sorted(shares, key=lambda share: -share.part)
