"""Winters by the calendar: limits, name, and snow season.

Years are cut in the station's summer: on 1 July in the north, on 1 January in the south. The snow
season of a station spans the days of the year between the first and the last hundredth of all its
snowfall, and always contains December to February (in the south June to August).
"""

from __future__ import annotations

from calendar import month_name
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import date, timedelta
from typing import Optional

import numpy as np

from snowshed.season.weather.row import Weather

NORTHERN_WINTER, SOUTHERN_WINTER = (11, 12, 1, 2, 3, 4), (5, 6, 7, 8, 9, 10)
NORTHERN_START, SOUTHERN_START = 7, 1  # the month in which a winter's year begins
#: The season contains at least the days from the first to the last of these.
NORTHERN_CORE, SOUTHERN_CORE = ((12, 1), (2, 28)), ((6, 1), (8, 31))
SHARE_OUTSIDE_SEASON = 0.01  # share of all snow before the snow season, and after it


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

    def order(self, month: int, day: int) -> tuple[int, int]:
        """Return the sort key of days in a winter's year."""
        start = SOUTHERN_START if self.south else NORTHERN_START
        return (month - start) % 12, day


@dataclass(frozen=True)
class SnowSeason:
    """The part of the year in which it snows at a place.

    Attributes
    ----------
    calendar
        The winters of the place.
    first, last
        Month and day.

    Examples
    --------
    >>> season = SnowSeason(Calendar(), (11, 5), (4, 20))
    >>> season.text, [str(day) for day in season.span(2023)]
    ('from 5 November to 20 April', ['2023-11-05', '2024-04-21'])
    """

    calendar: Calendar
    first: tuple[int, int]
    last: tuple[int, int]

    @property
    def text(self) -> str:
        """Text such as "from 5 November to 20 April"."""
        ends = (f"{day} {month_name[month]}" for month, day in (self.first, self.last))
        return "from {} to {}".format(*ends)

    def span(self, year: int) -> tuple[date, date]:
        """Return the first day of a winter's snow season, and the first day after it."""
        begin, last = (
            date(year + (not self.calendar.south and month < NORTHERN_START), month, day)
            for month, day in (self.first, self.last)
        )
        return begin, last + timedelta(1)


def calendar_of(rows: Sequence[Weather], latitude: Optional[float] = None) -> Calendar:
    """Return the calendar of a place, from its latitude or its temperatures.

    Parameters
    ----------
    rows
        Weather of the place.
    latitude
        Latitude, degrees, negative in the south, if known.

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
    """Return the part of the year in which it snows at a place.

    Examples
    --------
    >>> from snowshed.season.weather.generator import EXAMPLE_CLIMATE
    >>> snow_season_of(EXAMPLE_CLIMATE.winters(30, seed=1), Calendar()).text
    'from 4 November to 27 April'
    """
    first, last = SOUTHERN_CORE if calendar.south else NORTHERN_CORE
    falls: dict[tuple[int, int], float] = {}
    for row in rows:
        if row.snowfall:
            day = (row.date.month, min(row.date.day, 28 if row.date.month == 2 else 31))
            falls[day] = falls.get(day, 0.0) + row.snowfall
    days = sorted(falls, key=lambda day: calendar.order(*day))
    if days:
        sums = np.cumsum([falls[day] for day in days])
        snowy = [
            days[int(np.searchsorted(sums, part * sums[-1]))]
            for part in (SHARE_OUTSIDE_SEASON, 1.0 - SHARE_OUTSIDE_SEASON)
        ]
        first = min(first, snowy[0], key=lambda day: calendar.order(*day))
        last = max(last, snowy[1], key=lambda day: calendar.order(*day))
    return SnowSeason(calendar, first, last)
