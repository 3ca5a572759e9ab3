"""Temperatures of days without a measurement."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import date
from typing import Optional

import numpy as np

from snowshed.base.arrays import Booleans, Floats, Integers

MAX_INTERPOLATED_DAYS = 3  # longest gap that is interpolated linearly, days
HALF_WINDOW_DAYS = 7  # half width of the window of a mean, days
MIN_MEASURED_DAYS = 5  # smallest number of measured days in such a mean
DAYS_OF_YEAR = 366


def filled_temperatures(
    dates: Sequence[date], measured: Floats, counted: Optional[Booleans] = None
) -> tuple[Floats, Booleans, list[str]]:
    """Return the temperature of every day, the days far from a measurement, and notes.

    Gaps of up to three days are interpolated linearly. In longer gaps, a day gets the mean of the
    file's temperatures within a week of the same day of the year, in all years; without such
    temperatures, it is interpolated, too.

    Parameters
    ----------
    dates
        Days, in order.
    measured : (n,)
        Temperatures, degrees C; NaN: not measured; at least one is measured.
    counted : (n,)
        The days that notes count; None: all.

    Examples
    --------
    >>> days = [date(2024, 1, day) for day in (1, 2, 3)]
    >>> filled_temperatures(days, np.array([-4.0, np.nan, -2.0]))[0].tolist()
    [-4.0, -3.0, -2.0]
    """
    ordinals = np.array([day.toordinal() for day in dates])
    measured_days = np.flatnonzero(~np.isnan(measured))
    interpolated: Floats = np.interp(ordinals, ordinals[measured_days], measured[measured_days])
    far = _distance(ordinals, ordinals[measured_days]) > MAX_INTERPOLATED_DAYS
    climate_means = _climate_means(dates, measured)
    climate = far & ~np.isnan(climate_means)
    filled = np.where(climate, climate_means, interpolated)
    gaps = np.isnan(measured) & (True if counted is None else counted)
    return filled, far, _notes(dates, gaps & climate, gaps & far & ~climate, gaps & ~far)


def _notes(
    dates: Sequence[date], climate: Booleans, interpolated: Booleans, bridged: Booleans
) -> list[str]:
    rules = (
        (climate, "they have the mean of the same days of the year in the file"),
        (interpolated, "no other year has temperatures then; they are interpolated"),
        (bridged, "they are interpolated from the days before and after"),
    )
    return [
        f"no temperature on {some_days(dates, np.flatnonzero(flags))}; {rule}"
        for flags, rule in rules
        if flags.any()
    ]


def some_days(dates: Sequence[date], numbers: Sequence[int] | Integers) -> str:
    """Return a phrase with the number of days, the first and the last.

    Examples
    --------
    >>> some_days([date(2024, 1, 1), date(2024, 1, 2)], [0, 1])
    '2 days (2024-01-01 to 2024-01-02)'
    """
    first, last = dates[numbers[0]], dates[numbers[-1]]
    return f"1 day ({first})" if len(numbers) == 1 else f"{len(numbers)} days ({first} to {last})"


def _distance(days: Floats, measured_days: Floats) -> Floats:
    """Return the distance of each day from the nearest known day."""
    near = np.searchsorted(measured_days, days)
    before, after = (
        measured_days[np.maximum(near - 1, 0)],
        measured_days[np.minimum(near, len(measured_days) - 1)],
    )
    return np.asarray(np.minimum(np.abs(days - before), np.abs(after - days)), dtype=float)


def _climate_means(dates: Sequence[date], measured: Floats) -> Floats:
    """Return the mean temperature around each day of the year; NaN where too few were measured."""
    day_of_year = np.array([_day_of_year(day) for day in dates])
    is_measured = ~np.isnan(measured)
    sums = np.bincount(day_of_year[is_measured], measured[is_measured], DAYS_OF_YEAR)
    counts = np.bincount(day_of_year[is_measured], minlength=DAYS_OF_YEAR)
    window = np.arange(-HALF_WINDOW_DAYS, HALF_WINDOW_DAYS + 1)
    around = (np.arange(DAYS_OF_YEAR)[:, None] + window) % DAYS_OF_YEAR
    total, number = sums[around].sum(axis=1), counts[around].sum(axis=1)
    means = np.where(number >= MIN_MEASURED_DAYS, total / np.maximum(number, 1), np.nan)
    return np.asarray(means[day_of_year], dtype=float)


def _day_of_year(day: date) -> int:
    """Return the day of a leap year, from 0, so that months fall on the same days in all years."""
    return (date(2000, day.month, day.day) - date(2000, 1, 1)).days
