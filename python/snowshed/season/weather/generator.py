"""Synthetic winters: a stochastic generator of daily snowfall and temperature, fitted to a station.

Snowfall days follow a Markov chain of two states, depths a gamma distribution, temperatures an
autoregressive process of the first order about the mean of the month; all by month. This is the
generator of Richardson 1981, Water Resour. Res. 17, 182-190, with gamma instead of exponential
amounts (Katz 1977, J. Appl. Meteorol. 16, 671-676). Snow falls only at temperatures at which snow
fell at the station. There are no trends, and no wet or dry winters beyond chance.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta

import numpy as np

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.arrays import Booleans, whole_number
from snowshed.season.weather.checks import check_given_rows
from snowshed.season.weather.columns import MAX_SNOWFALL
from snowshed.season.weather.row import Weather
from snowshed.season.weather.source import SnowSource

MIN_DAYS = 20  # smallest number of days to fit a month
MIN_SNOWFALL = 0.005  # m; smallest snow of a snowfall day


@dataclass(frozen=True)
class MonthClimate:
    """The weather of a month.

    Attributes
    ----------
    after_dry, after_snow
        Probability of snow on a day after a day without snow, and after a day with snow.
    shape, scale
        Shape and scale (m) of the gamma distribution of new snow on a day with snow.
    temperature, deviation
        Mean and standard deviation of the daily temperature, degrees C.
    snow_shift
        Temperature difference between days with snow and others, degrees C.
    """

    after_dry: float
    after_snow: float
    shape: float
    scale: float
    temperature: float
    deviation: float
    snow_shift: float = 0.0


@checked
@dataclass(frozen=True)
class Climate:
    """The winters of a station.

    Attributes
    ----------
    months
        Climate by number of the month, 1 for January; missing months have no snow and are left out.
    persistence
        Correlation of the temperature anomalies of one day and the next.

    Examples
    --------
    >>> winter = EXAMPLE_CLIMATE.winters(1, seed=1)
    >>> winter[0].date.month, winter[-1].date.month, len(winter)
    (11, 4, 181)
    """

    months: Mapping[int, MonthClimate]
    persistence: float = 0.7

    def __post_init__(self) -> None:
        for month in self.months:
            if not 1 <= month <= 12:
                raise InputError(f"months: {month}; allowed: 1 (January) to 12")

    @classmethod
    def fit(cls, days: Sequence[Weather]) -> Climate:
        """Return the climate of daily rows; days whose snow is not known are left out.

        Raises
        ------
        InputError
            If a row cannot be weather, or no month with snow has enough days.
        """
        check_given_rows(days, "days", ordered=False)
        days = [day for day in days if day.source is not SnowSource.MISSING]
        snows = np.array([day.snowfall >= MIN_SNOWFALL for day in days])
        temperatures = np.array([day.temperature for day in days])
        months = np.array([day.date.month for day in days])
        falls = np.array([day.snowfall for day in days])
        before = np.append(False, snows[:-1])
        climates: dict[int, MonthClimate] = {}
        anomalies = np.zeros(len(days))
        for month in range(1, 13):
            own = months == month
            if own.sum() < MIN_DAYS or not (snows & own).any():
                continue
            amounts = falls[own & snows]
            mean, variance = amounts.mean(), max(amounts.var(), 1e-4 * amounts.mean() ** 2)
            warm = temperatures[own]
            anomalies[own] = warm - warm.mean()
            climates[month] = MonthClimate(
                _share(snows[own & ~before]),
                _share(snows[own & before]),
                float(mean**2 / variance),  # by moments
                float(variance / mean),
                float(warm.mean()),
                float(warm.std()),
                float(warm.mean() - temperatures[own & snows].mean()),
            )
        if not climates:
            raise InputError(
                f"the weather: no month with snow has {MIN_DAYS} days, which a generator needs"
            )
        pairs = anomalies[:-1] * anomalies[1:]
        spread = float((anomalies**2).mean())
        return cls(climates, float(np.clip(pairs.mean() / spread, 0.0, 0.99)) if spread else 0.0)

    def winters(self, count: int, *, seed: int, first_year: int = 2001) -> list[Weather]:
        """Return daily rows of synthetic winters; the same seed gives the same winters.

        Parameters
        ----------
        count
            Number of winters; each begins in the autumn of its own year.
        seed
            Random seed.
        first_year
            Year of the first autumn.
        """
        whole_number("count", count, lowest=1)
        random = np.random.default_rng(seed)
        rows: list[Weather] = []
        for year in range(first_year, first_year + count):
            snow, anomaly = False, 0.0
            for date in _days_of_winter(year):
                climate = self.months.get(date.month)
                if climate is None:
                    snow = False
                    continue
                anomaly = self.persistence * anomaly + np.sqrt(
                    1.0 - self.persistence**2
                ) * random.normal(0.0, climate.deviation)
                snow = random.random() < (climate.after_snow if snow else climate.after_dry)
                depth = min(random.gamma(climate.shape, climate.scale), MAX_SNOWFALL)
                shift = climate.snow_shift if snow else 0.0
                fall = round(float(depth), 3) if snow else 0.0
                warm = round(climate.temperature + anomaly - shift, 1)
                rows.append(Weather(len(rows) + 2, date, fall, None, float(warm)))
        return rows


def _share(flags: Booleans) -> float:
    return float(flags.mean()) if len(flags) else 0.0


def _days_of_winter(year: int) -> list[datetime]:
    """Return the days from August to July."""
    first = datetime(year, 8, 1)
    return [first + timedelta(days=n) for n in range((datetime(year + 1, 8, 1) - first).days)]


#: A synthetic station in the mountains, with about 4 m of new snow in a winter.
EXAMPLE_CLIMATE = Climate(
    {
        11: MonthClimate(0.12, 0.40, 1.2, 0.07, 0.5, 4.0, 2.0),
        12: MonthClimate(0.18, 0.45, 1.2, 0.08, -3.5, 4.5, 1.0),
        1: MonthClimate(0.20, 0.45, 1.2, 0.08, -5.0, 5.0, 0.5),
        2: MonthClimate(0.20, 0.45, 1.2, 0.08, -4.5, 5.0, 1.0),
        3: MonthClimate(0.17, 0.42, 1.2, 0.08, -1.5, 4.5, 2.0),
        4: MonthClimate(0.10, 0.35, 1.2, 0.06, 2.5, 4.0, 3.0),
    }
)
