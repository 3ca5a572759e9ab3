"""The trend of required heights over a record: a climate that changes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Optional

import numpy as np
from scipy.stats import kendalltau, theilslopes

from snowshed.base.arrays import Floats

#: Fewest winters of a trend, and the probability of chance below which there is one.
MIN_WINTERS = 10
SIGNIFICANCE = 0.05


@dataclass(frozen=True)
class Trend:
    """A trend of heights over winters.

    Attributes
    ----------
    per_decade
        Change in ten years, m.
    chance
        Probability that winters without a trend show one as clear.
    """

    per_decade: float
    chance: float


def trend_of(heights: Floats, years: Sequence[int]) -> Optional[Trend]:
    """Return the trend of heights over years, if there is one.

    The test is that of Mann and Kendall, the slope that of Theil and Sen.

    Parameters
    ----------
    heights : (n,)
        Height that each winter needs, m.
    years
        The year in which each winter begins.

    Returns
    -------
    Trend or None
        None if there are fewer than `MIN_WINTERS`, or chance explains the trend.

    Examples
    --------
    >>> falling = np.array([2.0, 2.1, 1.9, 1.8, 1.85, 1.7, 1.6, 1.75, 1.5, 1.4, 1.45])
    >>> round(trend_of(falling, range(1990, 2001)).per_decade, 1)
    -0.7
    >>> trend_of(np.array([2.0, 1.5] * 6), range(12)) is None
    True
    """
    if len(heights) < MIN_WINTERS or np.ptp(heights) == 0.0:
        return None
    chance = float(kendalltau(years, heights).pvalue)
    slope = float(theilslopes(heights, years).slope)
    return Trend(10.0 * slope, chance) if chance < SIGNIFICANCE and slope else None
