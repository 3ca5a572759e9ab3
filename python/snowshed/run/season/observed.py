"""From the observations of a station to the days of a season.

Hours become days. New snow is what the station measured; where it measured none, it follows from
precipitation and temperature, or from the rises of the snow depth, and a note says so.
"""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime, timedelta
from typing import Optional

import numpy as np

from snowshed._core import InputError
from snowshed.io.weather import Observation, Station
from snowshed.run.season.weather_row import Weather
from snowshed.snow.relations.new_snow import NEW_SNOW_DENSITY

#: All precipitation is snow below the first and rain above the second temperature, degrees C, with
#: a straight line between: U.S. Army Corps of Engineers 1956, Snow Hydrology, as in Wigmosta et al.
#: 1994, Water Resour. Res. 30, 1665-1679.
ALL_SNOW, ALL_RAIN = -1.1, 3.3
LEAST_RISE = 0.02  # m; smaller rises of the snow depth are noise of the sensor
LONGEST_BRIDGED = 3  # days without temperature that are interpolated


def days_of(station: Station, source: str) -> tuple[list[Weather], list[str]]:
    """Return the days of a station, and notes on what was assumed.

    Parameters
    ----------
    station
        From `read_station`.
    source
        The file, for messages.

    Raises
    ------
    InputError
        If snow cannot be told from its columns, or there are no temperatures.
    """
    days = _with_temperature(_daily(_ordered(station, source)), station.format, source)
    notes = [*station.notes, *_gaps(days)]
    temperatures = _temperatures(days)
    falls, rule = _snowfalls(days, temperatures, station.format, source)
    if rule:
        notes.append(rule)
    rows = [
        Weather(day.line, day.time, fall, None, round(warm, 2), snow_depth=day.snow_depth)
        for day, warm, fall in zip(days, temperatures, falls)
    ]
    return rows, notes


def snow_fraction(temperature: float) -> float:
    """Return the part of precipitation that falls as snow at an air temperature, degrees C.

    Examples
    --------
    >>> [round(snow_fraction(t), 2) for t in (-5.0, 1.1, 4.0)]
    [1.0, 0.5, 0.0]
    """
    return float(np.clip((ALL_RAIN - temperature) / (ALL_RAIN - ALL_SNOW), 0.0, 1.0))


def _ordered(station: Station, source: str) -> list[Observation]:
    rows = list(station.rows)
    for earlier, later in zip(rows, rows[1:]):
        if later.time <= earlier.time:
            raise InputError(
                f"{source}, line {later.line}, column date: {later.time.isoformat(' ')} is not "
                f"after line {earlier.line}, {earlier.time.isoformat(' ')}"
            )
    return rows


def _daily(rows: Sequence[Observation]) -> list[Observation]:
    """Return a row for each day: means of temperature, sums of precipitation, the last depth."""
    grouped: dict[datetime, list[Observation]] = {}
    for row in rows:
        grouped.setdefault(datetime(row.time.year, row.time.month, row.time.day), []).append(row)
    days = []
    for day, own in grouped.items():
        warm = [row.temperature for row in own if row.temperature is not None]
        wet = [row.precipitation for row in own if row.precipitation is not None]
        new = [row.snowfall for row in own if row.snowfall is not None]
        deep = [row.snow_depth for row in own if row.snow_depth is not None]
        days.append(
            Observation(
                own[0].line,
                day,
                float(np.mean(warm)) if warm else None,
                sum(wet) if wet else None,
                max(new) if new else None,  # of the last 24 hours, told anew each time
                deep[-1] if deep else None,
            )
        )
    return days


def _gaps(days: Sequence[Observation]) -> list[str]:
    missing = [
        (earlier, later)
        for earlier, later in zip(days, days[1:])
        if later.time - earlier.time > timedelta(days=1)
    ]
    if not missing:
        return []
    longest = max(missing, key=lambda pair: pair[1].time - pair[0].time)
    count = sum((later.time - earlier.time).days - 1 for earlier, later in missing)
    first = longest[0].time + timedelta(days=1)
    return [
        f"{count} days are missing in {len(missing)} gaps, the longest from {first.date()} to "
        f"{(longest[1].time - timedelta(days=1)).date()}; no snow is taken to fall there"
    ]


def _with_temperature(days: Sequence[Observation], form: str, source: str) -> list[Observation]:
    """Return the days whose temperature is known, or known a few days before or after."""
    known = np.array([i for i, day in enumerate(days) if day.temperature is not None])
    if len(known) == 0:
        raise InputError(
            f"{source}: no air temperature in any row of this {form} file; a season needs them"
        )
    near = np.searchsorted(known, np.arange(len(days)))
    before, after = known[np.maximum(near - 1, 0)], known[np.minimum(near, len(known) - 1)]
    distance = np.minimum(
        np.abs(before - np.arange(len(days))), np.abs(after - np.arange(len(days)))
    )
    return [day for day, gap in zip(days, distance) if gap <= LONGEST_BRIDGED]


def _temperatures(days: Sequence[Observation]) -> list[float]:
    known = [i for i, day in enumerate(days) if day.temperature is not None]
    values = [float(days[i].temperature or 0.0) for i in known]
    return [float(one) for one in np.interp(np.arange(len(days)), known, values)]


def _snowfalls(
    days: Sequence[Observation], temperatures: Sequence[float], form: str, source: str
) -> tuple[list[float], Optional[str]]:
    """Return the new snow of each day, m, and the rule by which it was found."""
    if any(day.snowfall is not None for day in days):
        lacking = sum(day.snowfall is None for day in days)
        note = f"new snow is missing on {lacking} days, and taken as none" if lacking else None
        return [day.snowfall or 0.0 for day in days], note
    if any(day.precipitation for day in days):
        density = NEW_SNOW_DENSITY["hedstrom-pomeroy-1998"]
        falls = [
            round((day.precipitation or 0.0) * snow_fraction(warm) / density(max(warm, -90.0)), 4)
            for day, warm in zip(days, temperatures)
        ]
        return falls, (
            "new snow follows from precipitation and temperature: all snow below "
            f"{ALL_SNOW:g} °C, all rain above {ALL_RAIN:g} °C (U.S. Army Corps of Engineers 1956), "
            "with the density of hedstrom-pomeroy-1998"
        )
    depths: list[float] = []
    for day in days:
        last = depths[-1] if depths else 0.0
        depths.append(last if day.snow_depth is None else day.snow_depth)
    if not any(depths):
        raise InputError(
            f"{source}: neither new snow, precipitation nor snow depth in any row of this {form} "
            "file"
        )
    rises = np.diff(depths, prepend=depths[0])
    falls = [round(float(rise), 4) if rise >= LEAST_RISE else 0.0 for rise in rises]
    return falls, (
        f"new snow is the daily rise of the snow depth, from {100 * LEAST_RISE:g} cm; since snow "
        "settles at the same time, it is too little"
    )
