"""Winters by the calendar: where one ends and the next begins, its name, and its snow season.

Years are cut in the station's summer: on 1 July in the north, on 1 January in the south. The snow
season of a station goes from the first to the last month that brings a hundredth of all its snow,
and holds the three months of the calendar's winter in any case.
"""

from __future__ import annotations

from calendar import month_name
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import date
from typing import Optional

import numpy as np

from snowshed.run.season.weather_row import Weather

NORTHERN_WINTER, SOUTHERN_WINTER = (11, 12, 1, 2, 3, 4), (5, 6, 7, 8, 9, 10)
NORTHERN_START, SOUTHERN_START = 7, 1  # the month in which a winter's year begins
NORTHERN_CORE, SOUTHERN_CORE = (12, 1, 2), (6, 7, 8)
SNOWY = 0.01  # of all snow, in a month that belongs to the snow season


@dataclass(frozen=True)
class Calendar:
    """The winters of a place.

    Attributes
    ----------
    south
        Whether it lies in the south, where a winter lies within one year.

    Examples
    --------
    >>> Calendar().name(Calendar().year(date(2024, 1, 5)))
    '2023/24'
    >>> south = Calendar(south=True)
    >>> south.name(south.year(date(2023, 7, 5)))
    '2023'
    """

    south: bool = False

    def year(self, day: date) -> int:
        """Return the year in which the winter of a day begins."""
        start = SOUTHERN_START if self.south else NORTHERN_START
        return day.year - (day.month < start)

    def name(self, year: int) -> str:
        """Return the name of the winter that begins in a year."""
        return str(year) if self.south else f"{year}/{(year + 1) % 100:02d}"

    def months(self) -> list[int]:
        """Return the months in the order of a winter's year."""
        start = SOUTHERN_START if self.south else NORTHERN_START
        return [(start - 1 + n) % 12 + 1 for n in range(12)]


@dataclass(frozen=True)
class SnowSeason:
    """The months in which it snows at a place.

    Attributes
    ----------
    calendar
        The winters of the place.
    first, last
        Months, 1 for January.
    """

    calendar: Calendar
    first: int
    last: int

    @property
    def words(self) -> str:
        """Such as "from November to April"."""
        return f"from {month_name[self.first]} to {month_name[self.last]}"

    def span(self, year: int) -> tuple[date, date]:
        """Return the first day of a winter's snow season, and the first day after it."""
        begin = date(self._of(self.first, year), self.first, 1)
        last = self._of(self.last, year)
        after = date(last + 1, 1, 1) if self.last == 12 else date(last, self.last + 1, 1)
        return begin, after

    def _of(self, month: int, year: int) -> int:
        """Return the calendar year of a month in the winter that begins in a year."""
        return year + (not self.calendar.south and month < NORTHERN_START)


def calendar_of(rows: Sequence[Weather], latitude: Optional[float] = None) -> Calendar:
    """Return the winters of a place, by its latitude or else by when it is cold there.

    Parameters
    ----------
    rows
        Its weather.
    latitude
        Degrees, negative in the south; None: not known.

    Examples
    --------
    >>> from datetime import datetime
    >>> cold = Weather(2, datetime(2023, 7, 1), 0.2, None, -4.0)
    >>> warm = Weather(3, datetime(2023, 12, 1), 0.0, None, 12.0)
    >>> calendar_of([cold, warm]).south, calendar_of([cold, warm], 46.0).south
    (True, False)
    """
    if latitude is not None and latitude != 0.0:
        return Calendar(latitude < 0.0)
    months = np.array([row.date.month for row in rows])
    temperatures = np.array([row.temperature for row in rows])
    southern = np.isin(months, SOUTHERN_WINTER)
    if southern.all() or not southern.any():
        return Calendar(bool(southern.all()))
    return Calendar(bool(temperatures[southern].mean() < temperatures[~southern].mean()))


def snow_season_of(rows: Sequence[Weather], calendar: Calendar) -> SnowSeason:
    """Return the months in which it snows at a place.

    Examples
    --------
    >>> from snowshed.run.season.generator import EXAMPLE_CLIMATE
    >>> snow_season_of(EXAMPLE_CLIMATE.winters(3, seed=1), Calendar()).words
    'from November to April'
    """
    months = np.array([row.date.month for row in rows])
    falls = np.array([row.snowfall for row in rows])
    total = falls.sum()
    core = SOUTHERN_CORE if calendar.south else NORTHERN_CORE
    order = calendar.months()
    snowy = [
        place
        for place, month in enumerate(order)
        if month in core or falls[months == month].sum() >= max(SNOWY * total, 1e-9)
    ]
    return SnowSeason(calendar, order[snowy[0]], order[snowy[-1]])
