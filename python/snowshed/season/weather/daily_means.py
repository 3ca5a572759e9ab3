"""Daily quantities of a station, and their gaps."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import date, datetime, timedelta

import numpy as np

from snowshed.base.arrays import Booleans, Floats, Integers
from snowshed.io.weather.observation import Observation, Station

#: Longest gap between two rows that is filled with days, days; longer gaps have no days.
MAX_GAP_DAYS = 60
MIN_DAY_HOURS = 18.0  # hours of a day that an amount must cover to count as the day's amount
#: The clock time at which new snow is read in most countries.
USUAL_READING_HOUR = 7.0
CLOCK_TOLERANCE = timedelta(hours=3)  # of a reading that stands for one at the usual clock time
#: Largest rate of snowfall; MeteoIO's filters cut the rate of the snow depth at 0.2 m/h.
MAX_RATE = 0.3  # m/h
MIN_DAILY_CHANGES = 3  # changes of the depth on a day that show a sensor with readings all day
MAX_RATE_SPAN_H = 2.0  # longest time between readings that are compared with that rate, h


@dataclass(frozen=True)
class StationDays:
    """Days of a station, in order; NaN: unknown.

    Attributes
    ----------
    dates
        The days (n).
    lines : (n,)
        Position of each day in the file; a day without a row has that of the next row.
    there : (n,)
        Whether the file has any value of the day.
    temperature, new_snow, water, depth : (n,)
        Mean, degrees C; sums, m and mm; depth of the snow cover, m, as median of its readings, so
        that neither noise nor a single wrong reading counts as snow.
    level : (n,)
        The depth without jumps that are not weather (seams, and rises faster than snowfall). Only
        its differences are meaningful.
    part_snow, part_water : (n,)
        Whether the sum covers a part of the day only.
    seams : (n,)
        Whether the depth begins another series on that day.
    jumps
        Date and size, m, of the jumps that were taken out of `level`.
    """

    dates: Sequence[date]
    lines: Integers
    there: Booleans
    temperature: Floats
    new_snow: Floats
    water: Floats
    depth: Floats
    level: Floats
    part_snow: Booleans
    part_water: Booleans
    seams: Booleans
    jumps: Sequence[tuple[date, float]]

    @property
    def ordinals(self) -> Integers:
        """The numbers of the days (n,)."""
        return np.array([day.toordinal() for day in self.dates], dtype=np.int64)


def days_of_station(station: Station) -> StationDays:
    """Return the days of a station from its first to its last row, without longer gaps.

    Examples
    --------
    >>> rows = [
    ...     Observation(n + 1, datetime(2024, 1, 1) + timedelta(hours=n), -4.0, None, None, 0.5)
    ...     for n in range(0, 72, 12)
    ... ]
    >>> days = days_of_station(Station("made", "", rows))
    >>> days.depth.tolist(), days.water.tolist()
    ([0.5, 0.5, 0.5], [nan, nan, nan])
    """
    new, part_new = _sums(_disjoint(station), "snowfall")
    water, part_water = _sums(station.rows, "precipitation")
    warm: dict[date, list[float]] = {}
    lines: dict[date, int] = {}
    for row in station.rows:
        lines.setdefault(row.time.date(), row.line)
        if row.temperature is not None:
            warm.setdefault(row.time.date(), []).append(row.temperature)
    depths, levels, seams, jumps = _depths(station)
    dates = _calendar({*lines, *new, *water})
    return StationDays(
        dates,
        np.array(_lines(dates, lines)),
        np.array([day in lines or day in new or day in water for day in dates]),
        np.array([np.mean(warm[day]) if day in warm else np.nan for day in dates]),
        np.array([new.get(day, np.nan) for day in dates]),
        np.array([water.get(day, np.nan) for day in dates]),
        np.array([np.median(depths[day]) if day in depths else np.nan for day in dates]),
        np.array([np.median(levels[day]) if day in levels else np.nan for day in dates]),
        np.array([day in part_new for day in dates]),
        np.array([day in part_water for day in dates]),
        np.array([day in seams for day in dates]),
        jumps,
    )


def _calendar(dates: set[date]) -> list[date]:
    """Return the days that are known and those of short gaps between them."""
    days: list[date] = []
    for day in sorted(dates):
        if days and (day - days[-1]).days - 1 <= MAX_GAP_DAYS:
            days += [days[-1] + timedelta(n) for n in range(1, (day - days[-1]).days)]
        days.append(day)
    return days


def _lines(dates: Sequence[date], lines: dict[date, int]) -> list[int]:
    indices: list[int] = []
    following = lines[max(lines)]
    for day in reversed(dates):
        following = lines.get(day, following)
        indices.append(following)
    return indices[::-1]


def _sums(rows: Sequence[Observation], name: str) -> tuple[dict[date, float], set[date]]:
    """Return the sum of an amount on each day, and the days that it covers only partly."""
    total: dict[date, float] = {}
    hours: dict[date, float] = {}
    for row in rows:
        amount = getattr(row, name)
        if amount is None:
            continue
        span = getattr(row, f"{name}_hours")
        for day, part in row.shares(span).items():
            total[day] = total.get(day, 0.0) + part * amount
            hours[day] = hours.get(day, 0.0) + part * (24.0 if span is None else span)
    partly = {day for day, covered in hours.items() if covered < MIN_DAY_HOURS}
    if rows:
        first = rows[0].time.date()
        for day in [day for day in partly if day < first]:
            # the file's first row, just after midnight, holds an amount of the day before
            total[first] = total.get(first, 0.0) + total.pop(day)
            partly.discard(day)
    return total, partly


def _disjoint(station: Station) -> Sequence[Observation]:
    """Return rows whose new snow does not overlap: rolling sums are taken at one clock time."""
    if "snowfall" not in station.rolling:
        return station.rows
    rows_with_snowfall = [row for row in station.rows if row.snowfall is not None]
    clocks = Counter((row.time.hour, row.time.minute) for row in rows_with_snowfall)
    if not clocks:
        return ()
    hour, minute = max(
        clocks,
        key=lambda clock: (clocks[clock], -abs(clock[0] + clock[1] / 60 - USUAL_READING_HOUR)),
    )
    return list(_read_at(rows_with_snowfall, hour, minute))


def _read_at(rows: Sequence[Observation], hour: int, minute: int) -> Iterator[Observation]:
    """Yield rows at a clock time, or near it, whose spans do not overlap."""
    last: datetime | None = None
    for number, row in enumerate(rows):
        clock = row.time.replace(hour=hour, minute=minute, second=0, microsecond=0)
        following = rows[number + 1].time if number + 1 < len(rows) else None
        due = row.time == clock or (
            abs(row.time - clock) <= CLOCK_TOLERANCE
            and (following is None or abs(following - clock) > abs(row.time - clock))
        )
        span = timedelta(hours=row.snowfall_hours or 24.0)
        if due and (last is None or row.time - last >= span - CLOCK_TOLERANCE):
            last = row.time
            yield row


def _depths(
    station: Station,
) -> tuple[dict[date, list[float]], dict[date, list[float]], set[date], list[tuple[date, float]]]:
    """Return the depths by day, the same with jumps removed, the days of seams, and the jumps."""
    depths: dict[date, list[float]] = {}
    levels: dict[date, list[float]] = {}
    seams: set[date] = set()
    jumps: list[tuple[date, float]] = []
    fastest = MAX_RATE if _is_continuous(station.rows) else np.inf
    shift, seam = 0.0, False
    before: Observation | None = None
    for row in station.rows:
        seam = seam or row.seam
        if row.snow_depth is None:
            continue
        day = row.time.date()
        if before is not None and before.snow_depth is not None:
            rise = row.snow_depth - before.snow_depth
            hours = (row.time - before.time).total_seconds() / 3600.0
            if seam or (station.typical_year and row.time.month != before.time.month):
                shift += rise
                seams.add(day)
                jumps.append((day, rise))
            elif hours <= MAX_RATE_SPAN_H and abs(rise) > fastest * max(hours, 1.0):
                shift += rise
                jumps.append((day, rise))
        depths.setdefault(day, []).append(row.snow_depth)
        levels.setdefault(day, []).append(row.snow_depth - shift)
        before, seam = row, False
    return depths, levels, seams, jumps


def _is_continuous(rows: Sequence[Observation]) -> bool:
    """Return whether the depth changes several times a day, so that hourly changes are real.

    Hourly files may repeat a depth that is read once a day; then a change belongs to the whole day.
    """
    changes: Counter[date] = Counter()
    before: float | None = None
    for row in rows:
        if row.snow_depth is not None:
            if before is not None and abs(row.snow_depth - before) >= 0.001:
                changes[row.time.date()] += 1
            before = row.snow_depth
    return bool(changes) and float(np.median(list(changes.values()))) >= MIN_DAILY_CHANGES
