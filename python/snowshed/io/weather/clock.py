"""One clock for all rows of a station: times with offsets, and hours shifted by summer time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timedelta, timezone
from typing import Optional

from snowshed._core import InputError
from snowshed.io.weather.amounts import HOUR, usual_step
from snowshed.io.weather.observation import DAY, Observation, Station, replace_values

YEARS = (1700, 2200)  # from before any thermometer to after any scenario
SUNDAY = 6


def on_one_clock(station: Station, source: str) -> Station:
    """Return a station whose rows have increasing times on one clock, without offsets.

    Times with offsets are converted to the smallest offset, which is standard time.

    Raises
    ------
    InputError
        If only some times have offsets, or a time is not after the previous one.
    """
    rows, offset, notes = station.rows, station.utc_offset, [*station.notes]
    aware = rows[0].time.tzinfo is not None
    clock = standard_clock(
        [row.time for row in rows],
        lambda number: (
            f"{source}, line {rows[number].line}, column date: {rows[number].time.isoformat(' ')}"
        ),
        f"line {rows[0].line}",
    )
    if aware:
        rows = [replace_values(row, time=time) for row, time in zip(rows, clock.times)]
    if clock.utc_offset is not None:
        offset = clock.utc_offset
    notes += clock.notes
    _check_years(rows, source)
    step = usual_step([row.time for row in rows])
    _check_order(rows, source, step)
    if not aware and step <= 1.0:
        notes += _missing_hour_notes(rows, step)
    return replace(station, rows=rows, utc_offset=offset, notes=notes)


@dataclass(frozen=True)
class StandardClock:
    """Times without offsets on the clock of their smallest offset, hours; None if it is unknown."""

    times: Sequence[datetime]
    utc_offset: Optional[float] = None
    notes: Sequence[str] = ()


def standard_clock(
    times: Sequence[datetime], describe: Callable[[int], str], first: str
) -> StandardClock:
    """Return times on the clock of their smallest offset, which is standard time.

    Times without offsets, and midnights of local days, stay as they are.

    Parameters
    ----------
    times
        The times of a table.
    describe
        Returns the place and the text of a time by its number, for messages.
    first
        The place of the first time.

    Raises
    ------
    InputError
        If only some times have offsets, or one has no universal time.
    """
    aware = bool(times) and times[0].tzinfo is not None
    for number, time in enumerate(times):
        if (time.tzinfo is not None) != aware:
            raise InputError(
                f"{describe(number)} has {'no' if aware else 'a'} UTC offset, but {first} has "
                f"{'one' if aware else 'none'}; give all times an offset, or none"
            )
    if not aware:
        return StandardClock(times)
    if _are_local_days(times):
        return StandardClock([time.replace(tzinfo=None) for time in times])
    offsets = {time.utcoffset() or timedelta(0) for time in times}
    standard = timezone(min(offsets))
    moved = []
    for number, time in enumerate(times):
        try:
            moved.append(time.astimezone(standard).replace(tzinfo=None))
        except OverflowError:
            raise InputError(f"{describe(number)} has no universal time") from None
    hours = min(offsets) / HOUR
    notes = [
        f"its times have {len(offsets)} UTC offsets; they are converted to UTC{hours:+g} h, which "
        "also defines the days"
    ]
    return StandardClock(moved, hours, notes if len(offsets) > 1 else [])


def _are_local_days(times: Sequence[datetime]) -> bool:
    """Return whether times with several offsets all are the midnight of a local day.

    Examples
    --------
    >>> zones = [timezone(timedelta(hours=hours)) for hours in (2, 1)]
    >>> times = [datetime(2024, 10, 27, tzinfo=zones[0]), datetime(2024, 10, 28, tzinfo=zones[1])]
    >>> _are_local_days(times), _are_local_days(times[:1])
    (True, False)
    """
    offsets = {time.utcoffset() for time in times}
    return len(offsets) > 1 and all(
        (time.hour, time.minute, time.second, time.microsecond) == (0, 0, 0, 0) for time in times
    )


def _check_years(rows: Sequence[Observation], source: str) -> None:
    low, high = YEARS
    for row in rows:
        if not low <= row.time.year <= high:
            raise InputError(
                f"{source}, line {row.line}, column date: the year {row.time.year}; allowed: "
                f"{low} to {high}"
            )


def _check_order(rows: Sequence[Observation], source: str, step: float) -> None:
    for earlier, later in zip(rows, rows[1:]):
        if later.time <= earlier.time:
            hour = repeated_hour(earlier.time, later.time, step)
            raise InputError(
                f"{source}, line {later.line}, column date: {later.time.isoformat(' ')} is not "
                f"after line {earlier.line}, {earlier.time.isoformat(' ')}"
                f"{backwards(rows[0].time, rows[-1].time) or hour}"
            )


def backwards(first: datetime, last: datetime) -> str:
    """Return a hint if the last row of a file is earlier than its first; otherwise nothing."""
    return "; the latest row comes first: sort the rows by time" if last < first else ""


def repeated_hour(earlier: datetime, later: datetime, step: float) -> str:
    """Return a hint if an hour may occur twice; otherwise nothing.

    Parameters
    ----------
    earlier, later
        Times of a row and of the next, which is not later.
    step
        Usual hours from row to row.

    Examples
    --------
    >>> time = datetime(2024, 10, 27, 2)
    >>> repeated_hour(time, time, 1.0)[:25], repeated_hour(time, time, 24.0)
    ('; this hour occurs twice,', '')
    """
    back = (earlier - later) / HOUR
    if step < DAY and 0.0 <= back <= 1.0:
        return (
            "; this hour occurs twice, as at the end of summer time: give times of standard time, "
            "or times with offsets such as 2024-10-27T02:00+01:00"
        )
    return ""


def _missing_hour_notes(rows: Sequence[Observation], step: float) -> list[str]:
    missing = [
        earlier.time
        for earlier, later in zip(rows, rows[1:])
        if abs((later.time - earlier.time) / HOUR - step - 1.0) < 1e-6
        and earlier.time.weekday() == SUNDAY
        and earlier.time.hour <= 3
        and earlier.time.month in (3, 4, 9, 10)
    ]
    if not missing:
        return []
    return [
        f"the hour after {missing[0]:%Y-%m-%d %H:%M} is missing"
        + (f", and {len(missing) - 1} more like it" if len(missing) > 1 else "")
        + ", as at the beginning of summer time; the times are used unchanged"
    ]
