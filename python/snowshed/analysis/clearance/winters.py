"""Weather of many years, cut into winters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from snowshed._core import InputError
from snowshed.run.season.weather_row import Weather

LEAST_DAYS = 60  # of a winter that counts


@dataclass(frozen=True)
class Winter:
    """The weather of one winter.

    Attributes
    ----------
    name
        Such as "2001/02".
    days
        Its rows, in order.
    """

    name: str
    days: Sequence[Weather]

    @property
    def snowfall(self) -> float:
        """Depth of all its new snow, m."""
        return sum(day.snowfall for day in self.days)


def winters_of(season: Sequence[Weather]) -> list[Winter]:
    """Return the winters of a season file of many years.

    A winter goes from the warmest month of the file's mean year to the next. Winters of less than
    60 days, at the ends of the file, are left out.

    Raises
    ------
    InputError
        If none is long enough.

    Examples
    --------
    >>> from snowshed.run.season.generator import EXAMPLE_CLIMATE
    >>> [winter.name for winter in winters_of(EXAMPLE_CLIMATE.winters(2, seed=1))]
    ['2001/02', '2002/03']
    """
    start = _first_month(season)
    years: dict[int, list[Weather]] = {}
    for row in season:
        years.setdefault(row.date.year - (row.date.month < start), []).append(row)
    found = [
        Winter(f"{year}/{(year + 1) % 100:02d}", days)
        for year, days in sorted(years.items())
        if (days[-1].date - days[0].date).days >= LEAST_DAYS
    ]
    if not found:
        raise InputError(f"the weather: no winter of {LEAST_DAYS} days; it has {len(season)} rows")
    return found


def _first_month(season: Sequence[Weather]) -> int:
    """Return the month in which a winter's year begins: half a year from the coldest one."""
    months = np.array([row.date.month for row in season])
    temperatures = np.array([row.temperature for row in season])
    means = {month: temperatures[months == month].mean() for month in set(months.tolist())}
    coldest = min(means, key=lambda month: means[month])
    return int((coldest + 5) % 12 + 1)
