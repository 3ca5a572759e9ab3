"""Durations of amounts: since the previous row, since a counter's reset, or over hours."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from datetime import datetime
from statistics import median
from typing import Optional

from snowshed.io.weather.amounts import HOUR, hours_before
from snowshed.io.weather.observation import Observation, Station, replace_values

#: A quantity, the field of its hours, and its unit and name in notes.
AMOUNTS = (
    ("precipitation", "precipitation_hours", "mm", "precipitation"),
    ("snowfall", "snowfall_hours", "m", "new snow"),
)
MIN_RISES = 8  # rises of a counter; snow or rain of a storm has fewer
#: Noise of a counter, relative to its value.
COUNTER_NOISE = 0.02
#: Largest value of a counter after emptying, relative to its value before.
EMPTIED_SHARE = 0.2
#: Smallest number of rises of a counter per reset.
MIN_RISES_PER_RESET = 10
MIN_FILLED_SHARE = 0.5  # share of the rows, from the first amount on, in which a counter is above 0
MINUTE = 1.0 / 60.0


def with_hours(station: Station) -> Station:
    """Return a station whose amounts all have a duration.

    Counters become increments. Of overlapping sums of precipitation over the last hours, only those
    are kept that do not overlap; overlapping sums of new snow are named by `rolling`.
    """
    rows, notes, rolling = list(station.rows), [*station.notes], set(station.rolling)
    for name, hours, unit, label in AMOUNTS:
        own = [i for i, row in enumerate(rows) if getattr(row, name) is not None]
        if not own:
            continue
        title = station.columns.get(name, label)
        fixed = [getattr(rows[i], hours) for i in own]
        if fixed[0] is None:
            notes += _fill_in(rows, own, (name, hours), f"{title}, in {unit},")
        elif _overlap([rows[i].time for i in own], fixed):
            if name == "snowfall":
                rolling.add(name)
                notes.append(
                    f"{title} holds the new snow of the last {fixed[0]:g} hours in every row"
                )
            else:
                notes.append(_thin_out(rows, own, fixed, title))
        notes += _drop_first(rows, own[0], (name, hours), title)
    return replace(station, rows=rows, notes=notes, rolling=frozenset(rolling))


def _drop_first(
    rows: list[Observation], first: int, fields: tuple[str, str], title: str
) -> list[str]:
    """Drop a first amount that belongs to the day before the file's rows."""
    row, (name, hours) = rows[first], fields
    amount = getattr(row, name)
    if amount is None or row.time.date() in row.shares(getattr(row, hours)):
        return []
    rows[first] = replace_values(row, **{name: None, hours: None})
    if amount == 0.0:
        return []
    return [
        f"the first {title} ({amount:g}) fell on the day before the file begins, and is left out"
    ]


def _fill_in(
    rows: list[Observation], own: Sequence[int], fields: tuple[str, str], title: str
) -> list[str]:
    """Set the hours of amounts since the previous row, and the increments of a counter."""
    name, hours = fields
    values = [getattr(rows[i], name) for i in own]
    times = [rows[i].time for i in own]
    notes = []
    added = added_to_counter(times, values)
    if added is not None:
        notes.append(
            f"{title} only rises, up to {max(values):g}: it is a counter, so its increments are "
            f"used, {sum(added):.4g} in all"
        )
    for n, (i, span) in enumerate(zip(own, hours_before(times))):
        amount = values[n] if added is None else added[n]
        rows[i] = replace_values(rows[i], **{name: amount, hours: span})
    return notes


def added_to_counter(times: Sequence[datetime], values: Sequence[float]) -> Optional[list[float]]:
    """Return the increments of a counter, mm or m; None if the values are not a counter.

    A counter rises or stands still, except when it is emptied, which happens seldom or at the same
    time of the day.

    Examples
    --------
    >>> hours = [datetime(2024, 1, 1, hour) for hour in range(10)]
    >>> [round(one) for one in added_to_counter(hours, [0, 1, 1, 2, 4, 5, 7, 8, 9, 10])]
    [0, 1, 0, 1, 2, 1, 2, 1, 1, 1]
    >>> added_to_counter(hours, [0, 1, 3, 2, 0, 0, 4, 0, 0, 0])
    """
    rises = sum(later > earlier for earlier, later in zip(values, values[1:]))
    falls = [i for i in range(1, len(values)) if values[i] < (1.0 - COUNTER_NOISE) * values[i - 1]]
    if rises < MIN_RISES or any(values[i] > EMPTIED_SHARE * values[i - 1] for i in falls):
        return None
    daily = len(falls) >= 3 and len({times[i].time() for i in falls}) == 1
    if rises < MIN_RISES_PER_RESET * len(falls) and not daily:
        return None
    begin = next(i for i, value in enumerate(values) if value > 0.0)
    if sum(value > 0.0 for value in values[begin:]) < MIN_FILLED_SHARE * (len(values) - begin):
        return None
    added, highest = [0.0], values[0]
    for i in range(1, len(values)):
        if values[i] < (1.0 - COUNTER_NOISE) * values[i - 1]:
            highest = 0.0
        added.append(max(values[i] - highest, 0.0))
        highest = max(highest, values[i])
    return added


def _overlap(times: Sequence[datetime], hours: Sequence[float]) -> bool:
    """Return whether most rows are closer together than the hours of their amounts."""
    steps = [
        (later - earlier) / HOUR / own for earlier, later, own in zip(times, times[1:], hours[1:])
    ]
    return bool(steps) and median(steps) < 0.75


def _thin_out(
    rows: list[Observation], own: Sequence[int], hours: Sequence[float], title: str
) -> str:
    last: Optional[datetime] = None
    left = 0
    for i, span in zip(own, hours):
        if last is not None and (rows[i].time - last) / HOUR < span - MINUTE:
            rows[i] = replace_values(rows[i], precipitation=None, precipitation_hours=None)
        else:
            last, left = rows[i].time, left + 1
    return (
        f"{title} holds the sum of the last {hours[0]:g} hours in every row; {left} of "
        f"{len(own)} rows are used, which do not overlap"
    )
