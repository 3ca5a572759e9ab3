"""Typical years and actual years of building and solar energy.

A typical year has months from different years. Here it begins in the station's summer. Files of
the same formats may hold actual years.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from datetime import datetime, timedelta
from typing import Optional

from snowshed._core import InputError
from snowshed.io.weather.observation import Observation

TYPICAL_YEAR_START = 2001  # the year in which an assembled typical year begins
MAX_ROW_GAP = timedelta(days=1)  # between successive rows of one series
YEAR = timedelta(days=365)


def arrange_winters(
    rows: Sequence[Observation], latitude: Optional[float], source: str
) -> tuple[list[Observation], bool, list[str]]:
    """Return the rows in the order of winters, whether they are a typical year, and notes.

    Parameters
    ----------
    rows
        Rows in the order of the file, with the years of the file.
    latitude
        Latitude of the station, degrees; None counts as north.
    source
        The file, for messages.

    Raises
    ------
    InputError
        If an hour of the year occurs twice in rows that are not in the order of time.
    """
    rising = all(earlier.time < later.time for earlier, later in zip(rows, rows[1:]))
    years = sorted({row.time.year for row in rows})
    if rising and _are_actual(rows):
        span = f"the year {years[0]}" if len(years) == 1 else f"{years[0]} to {years[-1]}"
        return list(rows), False, [f"the years are taken as actual ones: {span}"]
    return _typical(rows, latitude, source), True, _notes(years, latitude)


def _are_actual(rows: Sequence[Observation]) -> bool:
    """Return whether rising rows continue from year to year, or repeat an hour of the year."""
    steady = all(later.time - earlier.time <= MAX_ROW_GAP for earlier, later in zip(rows, rows[1:]))
    if steady:
        return not _is_calendar_year(rows)
    return len({_hour_of_year(row.time) for row in rows}) < len(rows)


def _is_calendar_year(rows: Sequence[Observation]) -> bool:
    """Return whether rows span 1 January to 31 December, so that a winter must be assembled."""
    first, last = rows[0].time, rows[-1].time
    begin = datetime((first + MAX_ROW_GAP).year, 1, 1)
    return abs(first - begin) <= MAX_ROW_GAP and abs(last - begin - YEAR) <= 2 * MAX_ROW_GAP


def _typical(
    rows: Sequence[Observation], latitude: Optional[float], source: str
) -> list[Observation]:
    south = latitude is not None and latitude < 0.0
    moved: list[tuple[datetime, Observation]] = []
    for row in rows:
        if (row.time.month, row.time.day) != (2, 29):
            year = TYPICAL_YEAR_START if south or row.time.month >= 7 else TYPICAL_YEAR_START + 1
            moved.append((row.time.replace(year=year), row))
    moved.sort(key=lambda pair: pair[0])
    arranged_rows: list[Observation] = []
    before: Optional[Observation] = None
    for time, row in moved:
        if before is not None and time == arranged_rows[-1].time:
            first, second = sorted((before.line, row.line))
            raise InputError(
                f"{source}, line {second}, column date: {time:%m-%d %H:%M} occurs twice, also in "
                f"line {first}; allowed: a typical year, or actual years in order of time"
            )
        seam = before is not None and not timedelta(0) < row.time - before.time <= MAX_ROW_GAP
        end = row.end and time + (row.end - row.time)
        arranged_rows.append(replace(row, time=time, end=end, seam=seam))
        before = row
    return arranged_rows


def _hour_of_year(time: datetime) -> tuple[int, int, int, int]:
    return time.month, time.day, time.hour, time.minute


def _notes(years: Sequence[int], latitude: Optional[float]) -> list[str]:
    begins, ends = ("January", "December") if (latitude or 0.0) < 0.0 else ("July", "June")
    if len(years) == 1:
        origin = f"all of its months have the year {years[0]}"
    else:
        origin = f"its months come from {len(years)} different years"
    return [
        f"it is a typical year: {origin}; it is assembled from {begins} to {ends}, and a jump "
        "of the snow depth at a joint of months is not snowfall"
    ]
