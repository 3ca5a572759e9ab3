"""New snow from the rises of the snow depth, without invalid readings.

A rise from one day to the next is new snow; it is too small, because snow settles meanwhile. A rise
over days without a reading is divided among them. A rise beyond the record of 24 hours, a spike or
a drop-out that the next readings revert, and the seam of two series are not snowfall.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import date

import numpy as np

from snowshed.base.arrays import Booleans, Floats, Integers
from snowshed.base.formatting import plural
from snowshed.season.weather.daily_means import MAX_GAP_DAYS, StationDays
from snowshed.season.weather.extremes import RECORD_DAY, RECORD_WORDS

MIN_RISE = 0.02  # m; smaller rises of the snow depth are noise of the sensor
MAX_TOTAL_DAYS = 4  # longest time between readings whose rise still counts as observed, days
MIN_SPIKE = 0.3  # m; smallest change that may be a spike
MIN_REVERTED_SHARE = 0.8  # share of a spike that the reading after it reverts
MELT_LIMIT = 1.0  # degrees C; below, new snow of a spike's size does not vanish within days
SPIKE_DAYS = 2  # longest duration of a spike
DROPOUT_DAYS = 7  # longest duration of a drop-out
IMPOSSIBLE_DAYS = 60  # longest duration of an impossible change


@dataclass(frozen=True)
class SharedRise:
    """A rise over several days, shared out among them.

    Attributes
    ----------
    days
        Numbers of the days.
    rise
        Rise of the depth, m.
    """

    days: range
    rise: float


@dataclass
class DepthSnow:
    """The new snow from the depth.

    Attributes
    ----------
    snow : (n,)
        New snow of each day, m; NaN: unknown.
    filled : (n,)
        Whether the snow is part of a rise over so many days that it counts as unobserved.
    depth : (n,)
        The depth without wrong readings, m.
    totals
        Rises over several days.
    notes
        Notes on left-out readings, with reasons.
    """

    snow: Floats
    filled: Booleans
    depth: Floats
    totals: list[SharedRise] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def snow_of_depth(days: StationDays, temperature: Floats) -> DepthSnow:
    """Return the new snow from the depths of a station.

    Parameters
    ----------
    days
        From `days_of_station`.
    temperature : (n,)
        Temperature of every day, degrees C.
    """
    ordinals = days.ordinals
    wrong = _invalid_readings(ordinals, days.level, temperature, days.seams)
    wrong |= _invalid_readings(ordinals, days.depth, temperature, days.seams)
    level = np.where(wrong, np.nan, days.level)
    snow = DepthSnow(
        np.full(len(ordinals), np.nan),
        np.zeros(len(ordinals), dtype=bool),
        np.where(wrong, np.nan, days.depth),
    )
    _note_jumps(days, snow)
    if wrong.any():
        numbers = np.flatnonzero(wrong)
        snow.notes.append(
            f"{plural(len(numbers), 'reading')} of the snow depth "
            f"({_dates_text(days.dates, numbers)}) went up or down by {MIN_SPIKE:g} m or more and "
            "back again: a spike or a drop-out of the sensor, not snow"
        )
    readings = np.flatnonzero(~np.isnan(level))
    if len(readings):
        snow.snow[readings[0]] = 0.0
    for before, after in zip(readings, readings[1:]):
        _enter_rise(days, snow, int(before), int(after), float(level[after] - level[before]))
    _note_gaps(days, snow)
    return snow


def _enter_rise(days: StationDays, snow: DepthSnow, before: int, after: int, rise: float) -> None:
    """Enter the rise from one reading to the next."""
    span = days.dates[after].toordinal() - days.dates[before].toordinal()
    span_days = slice(before + 1, after + 1)
    rise_text = f"{rise:.2f} m from {days.dates[before]} to {days.dates[after]}"
    if rise > RECORD_DAY * span:
        snow.notes.append(
            f"the snow depth rises by {rise_text}, which is not snowfall: {RECORD_WORDS}"
        )
        return
    if span > MAX_GAP_DAYS + 1:
        if rise >= MIN_RISE:
            snow.notes.append(f"the snow depth rises by {rise_text}, over a gap; it is not counted")
        snow.snow[after] = 0.0
        return
    if span > MAX_TOTAL_DAYS and rise < MIN_RISE:
        return  # the snow may have fallen and settled: unknown
    share = rise / span if rise >= MIN_RISE else 0.0
    snow.snow[span_days] = share
    if span > 1 and share:
        snow.totals.append(SharedRise(range(before + 1, after + 1), rise))
    if span > MAX_TOTAL_DAYS:
        snow.filled[span_days] = True


def _note_gaps(days: StationDays, snow: DepthSnow) -> None:
    """Note the rises that are spread over unobserved days."""
    gaps = [total for total in snow.totals if len(total.days) > MAX_TOTAL_DAYS]
    if not gaps:
        return
    largest = max(gaps, key=lambda total: total.rise)
    largest_total = (
        f"by {largest.rise:.2f} m in the {len(largest.days)} days to "
        f"{days.dates[largest.days[-1]]}, of which {len(largest.days) - 1} have no reading"
    )
    among = f" over {len(gaps)} gaps without readings, the most" if len(gaps) > 1 else ""
    snow.notes.append(
        f"the snow depth rises{among} {largest_total}: this is not snowfall of a day, and is "
        "divided evenly among the days"
    )


def _invalid_readings(
    ordinals: Integers, depth: Floats, temperature: Floats, seams: Booleans
) -> Booleans:
    """Return the days whose reading is a spike or a drop-out."""
    wrong = np.zeros(len(depth), dtype=bool)
    readings = np.flatnonzero(~np.isnan(depth)).tolist()
    joints = np.cumsum(seams)
    place = 1
    while place < len(readings):
        good, first = readings[place - 1], readings[place]
        change = depth[first] - depth[good]
        if abs(change) < MIN_SPIKE or joints[first] != joints[good]:
            place += 1
            continue
        limit, reverted_at = _max_spike_days(change, ordinals[first] - ordinals[good]), 0
        for later in range(place + 1, len(readings)):
            later_day = readings[later]
            if ordinals[later_day] - ordinals[first] > limit or joints[later_day] != joints[good]:
                break
            beyond = (depth[good] - depth[later_day]) / change  # below 0: not fully reverted
            frozen = change < 0.0 and temperature[good : first + 1].max() <= MELT_LIMIT
            if (
                MIN_REVERTED_SHARE - 1.0
                <= beyond
                <= (np.inf if frozen else 1.0 - MIN_REVERTED_SHARE)
            ):
                reverted_at = later
                break
        melted = 0.0 < change <= RECORD_DAY and reverted_at > 0
        if melted and temperature[first : readings[reverted_at] + 1].max() > MELT_LIMIT:
            reverted_at = 0
        if reverted_at:
            wrong[readings[place:reverted_at]] = True
            readings[place:reverted_at] = []
        place += 1
    return wrong


def _max_spike_days(change: float, days: int) -> int:
    """Return the largest number of days that a spike of this size lasts."""
    if abs(change) > RECORD_DAY * days:
        return IMPOSSIBLE_DAYS
    return SPIKE_DAYS if change > 0.0 else DROPOUT_DAYS


def _note_jumps(days: StationDays, snow: DepthSnow) -> None:
    seams = [(day, rise) for day, rise in days.jumps if day in _seam_dates(days)]
    others = [(day, rise) for day, rise in days.jumps if day not in _seam_dates(days)]
    rising = [(day, rise) for day, rise in seams if abs(rise) >= MIN_RISE]
    if rising:
        snow.notes.append(
            f"the snow depth jumps at {plural(len(rising), 'joint')} of two series "
            f"({_jumps_text(rising)}), which is not snowfall"
        )
    if others:
        snow.notes.append(
            f"the snow depth jumps {plural(len(others), 'time')} faster than snow falls "
            f"({_jumps_text(others)}), which is not snowfall"
        )


def _seam_dates(days: StationDays) -> set[date]:
    return {days.dates[number] for number in np.flatnonzero(days.seams).tolist()}


def _jumps_text(jumps: Sequence[tuple[date, float]]) -> str:
    largest = sorted(jumps, key=lambda jump: -abs(jump[1]))[:3]
    listed = ", ".join(f"{rise:+.2f} m on {day}" for day, rise in largest)
    return listed if len(jumps) <= len(largest) else f"the largest: {listed}"


def _dates_text(dates: Sequence[date], numbers: Integers) -> str:
    listed = ", ".join(str(dates[number]) for number in numbers[:3])
    return listed if len(numbers) <= 3 else f"{listed} and others"
