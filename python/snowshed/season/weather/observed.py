"""Days of a season from a station's observations; this module alone chooses their source.

`SnowSource` names the origin of a day's new snow, for every format. Each day uses the first of the
winter's columns (`columns`) with a value; days without a value are filled by a stated rule, or are
missing. A missing value is not zero, and is marked.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import Optional

import numpy as np

from snowshed._core import InputError
from snowshed.base.arrays import Booleans, Floats, Integers
from snowshed.base.formatting import plural
from snowshed.io.weather.observation import Station
from snowshed.season.weather.daily_means import StationDays, days_of_station
from snowshed.season.weather.depth_rises import MIN_RISE, DepthSnow, SharedRise, snow_of_depth
from snowshed.season.weather.extremes import RECORD_DAY, RECORD_WORDS
from snowshed.season.weather.gauge import RULE, snow_of_gauge
from snowshed.season.weather.row import Weather
from snowshed.season.weather.season_record import SeasonRecord
from snowshed.season.weather.source import SnowSource
from snowshed.season.weather.station_choice import (
    CONTRADICTION,
    Chooser,
    StationChoice,
    StationColumn,
)
from snowshed.season.weather.temperatures import filled_temperatures, some_days
from snowshed.season.weather.winter_years import Calendar, calendar_of

MAX_NAMED_WINTERS = 3  # winters that a note names


@dataclass
class _DailySnow:
    """The new snow of every day, m, its source, and the reason if the file does not give it."""

    fall: Floats
    source: list[SnowSource]
    reason: list[str]
    choices: dict[int, StationChoice] = field(default_factory=dict)


def record_of(station: Station, source: str, only: Optional[SnowSource] = None) -> SeasonRecord:
    """Return the days of a station as a record.

    Parameters
    ----------
    station
        From `read_station`.
    source
        The file, for messages.
    only
        The only column that observes snow; None: the best column of each winter.

    Raises
    ------
    InputError
        If no row has snow, no row has a temperature, or the requested column is missing.
    """
    _check_order(station, source)
    days = days_of_station(station)
    if np.isnan(days.temperature).all():
        raise InputError(
            f"{source}: no air temperature in any row of this {station.format} file; a season "
            "needs temperatures; give the file that contains them as well"
        )
    warm, far, of_temperature = filled_temperatures(days.dates, days.temperature, days.there)
    depth = snow_of_depth(days, warm)
    notes = [*station.notes, *_gaps(days), *of_temperature, *depth.notes]
    columns = _columns(days, warm, far, depth, notes)
    _check_columns(columns, only, station.format, source)
    calendar = _calendar(days, warm, station.latitude)
    snow = _daily_snow(days, Chooser(columns, warm, only), columns, calendar, depth.totals)
    notes += _notes(snow, days, calendar)
    modelled = station.typical_year
    rows = [
        Weather(
            int(days.lines[n]),
            datetime(day.year, day.month, day.day),
            round(float(snow.fall[n]), 4),
            None,
            round(float(warm[n]), 2),
            snow_depth=None if np.isnan(depth.depth[n]) else float(depth.depth[n]),
            source=SnowSource.MODEL
            if modelled and snow.source[n] is SnowSource.GAUGE
            else snow.source[n],
            reason=snow.reason[n],
        )
        for n, day in enumerate(days.dates)
    ]
    sums = {year: choice.sums for year, choice in snow.choices.items()}
    return SeasonRecord(rows, notes, station.latitude, sums)


def _check_order(station: Station, source: str) -> None:
    for earlier, later in zip(station.rows, station.rows[1:]):
        if later.time <= earlier.time:
            raise InputError(
                f"{source}, line {later.line}, column date: {later.time.isoformat(' ')} is not "
                f"after line {earlier.line}, {earlier.time.isoformat(' ')}"
            )


def _columns(
    days: StationDays, warm: Floats, far: Booleans, depth: DepthSnow, notes: list[str]
) -> dict[SnowSource, StationColumn]:
    """Return the columns of a station with snow; appends notes on left-out values."""
    hand = days.new_snow.copy()
    beyond = hand > RECORD_DAY
    if beyond.any():
        first = int(np.flatnonzero(beyond)[0])
        notes.append(
            f"new snow of {hand[first]:.2f} m on {days.dates[first]}"
            f"{' and on other days' if beyond.sum() > 1 else ''} is left out: {RECORD_WORDS}"
        )
        hand[beyond] = np.nan
    gauge = snow_of_gauge(days.water, warm)
    if (gauge >= RECORD_DAY).any():
        first = int(np.flatnonzero(gauge >= RECORD_DAY)[0])
        notes.append(
            f"the precipitation of {days.dates[first]} ({days.water[first]:g} mm) counts as "
            f"{RECORD_DAY:g} m of snow: {RECORD_WORDS}"
        )
    return {
        SnowSource.HAND: StationColumn(SnowSource.HAND, *_mask_partial_days(hand, days.part_snow)),
        SnowSource.GAUGE: StationColumn(
            SnowSource.GAUGE,
            *_mask_partial_days(gauge, days.part_water | (far & (days.water > 0.0))),
        ),
        SnowSource.DEPTH: StationColumn(SnowSource.DEPTH, depth.snow, depth.filled),
    }


def _mask_partial_days(snow: Floats, part: Booleans) -> tuple[Floats, Booleans]:
    """Return snow, NaN where part of a day had none, and whether it fell in part of a day only."""
    return np.where(part & (snow == 0.0), np.nan, snow), part & (snow > 0.0)


def _check_columns(
    columns: Mapping[SnowSource, StationColumn], only: Optional[SnowSource], form: str, source: str
) -> None:
    if only is not None and np.isnan(columns[only].snow).all():
        raise InputError(f"{source}: no {only.label} in any row of this {form} file")
    if all(np.isnan(column.snow).all() for column in columns.values()):
        raise InputError(
            f"{source}: neither new snow, precipitation nor snow depth in any row of this {form} "
            "file"
        )


def _calendar(days: StationDays, warm: Floats, latitude: Optional[float]) -> Calendar:
    rows = [
        Weather(0, datetime(day.year, day.month, day.day), 0.0, None, float(temperature))
        for day, temperature in zip(days.dates, warm)
    ]
    return calendar_of(rows, latitude)


def _daily_snow(
    days: StationDays,
    chooser: Chooser,
    columns: Mapping[SnowSource, StationColumn],
    calendar: Calendar,
    totals: Sequence[SharedRise],
) -> _DailySnow:
    """Return the new snow of every day by the columns of its winter."""
    count = len(days.dates)
    snow = _DailySnow(np.zeros(count), [SnowSource.MISSING] * count, [""] * count)
    years = np.array([calendar.year(day) for day in days.dates])
    for year in np.unique(years).tolist():
        choice = chooser.of(years == year)
        snow.choices[year] = choice
        for n in np.flatnonzero(years == year).tolist():
            _assign_day(snow, n, choice, columns)
    for total in totals:
        _subtract_observed(snow, total)
    return snow


def _assign_day(
    snow: _DailySnow, n: int, choice: StationChoice, columns: Mapping[SnowSource, StationColumn]
) -> None:
    for source in choice.observing:
        if columns[source].known[n]:
            snow.fall[n], snow.source[n] = columns[source].snow[n], source
            return
    for source in (*choice.observing, *([choice.filling] if choice.filling else [])):
        fall = columns[source].snow[n]
        if not np.isnan(fall):
            snow.fall[n], snow.source[n] = fall, SnowSource.FILLED
            part = columns[source].filled[n]
            snow.reason[n] = f"from {'a part of ' if part else ''}the {source.label}"
            return


def _subtract_observed(snow: _DailySnow, total: SharedRise) -> None:
    """Subtract the snow that other columns observed from a rise over several days."""
    own, observed = [], 0.0
    for n in total.days:
        if snow.source[n] is SnowSource.DEPTH or snow.reason[n].endswith(SnowSource.DEPTH.label):
            own.append(n)
            snow.reason[n] = f"part of a rise of {total.rise:.2f} m over {len(total.days)} days"
        else:
            observed += snow.fall[n]
    if len(own) < len(total.days):
        for n in own:
            snow.fall[n] = max(total.rise - observed, 0.0) / len(own)


def _gaps(days: StationDays) -> list[str]:
    """Return a note on the days that are missing in the file."""
    ordinals = days.ordinals[days.there]
    spans = np.diff(ordinals)
    if not (spans > 1).any():
        return []
    longest = int(np.argmax(spans))
    first, last = (
        datetime.fromordinal(int(ordinals[longest + n] + (1, -1)[n])).date() for n in (0, 1)
    )
    missing = int((spans - 1).sum())
    verb = "is" if missing == 1 else "are"
    return [f"{plural(missing, 'day')} {verb} missing in {_gaps_text(spans)}from {first} to {last}"]


def _gaps_text(spans: Integers) -> str:
    gaps = int((spans > 1).sum())
    return "1 gap, " if gaps == 1 else f"{gaps} gaps, the longest "


def _notes(snow: _DailySnow, days: StationDays, calendar: Calendar) -> Iterator[str]:
    if SnowSource.GAUGE in snow.source:
        yield RULE
    if SnowSource.DEPTH in snow.source:
        yield (
            f"new snow is the daily rise of the snow depth, if at least {100 * MIN_RISE:g} cm; it "
            "is too small, because snow settles meanwhile"
        )
    yield from _contradictions(snow, calendar)
    filled = [n for n, source in enumerate(snow.source) if source is SnowSource.FILLED]
    if filled:
        kinds = sorted({_fill_kind(snow.reason[n]) for n in filled})
        yield (
            f"the snow of {some_days(days.dates, filled)} is filled, "
            f"{sum(snow.fall[n] for n in filled):.2f} m in all: {'; '.join(kinds)}"
        )
    missing = [n for n, source in enumerate(snow.source) if source is SnowSource.MISSING]
    if missing:
        yield (
            f"the snow of {some_days(days.dates, missing)} is unknown; no snow is laid on the "
            "panel, and these days count as not observed"
        )


def _fill_kind(reason: str) -> str:
    return "the rise over a gap, shared out" if reason.startswith("part") else reason


def _contradictions(snow: _DailySnow, calendar: Calendar) -> Iterator[str]:
    """Yield notes on columns that contradict each other, with their sums in some winters."""
    groups: dict[tuple[SnowSource, frozenset[SnowSource]], list[int]] = {}
    for year, choice in snow.choices.items():
        wrong = choice.contradicted or _contradicting_sources(choice)
        if wrong and choice.observing:
            groups.setdefault((choice.observing[0], wrong), []).append(year)
    for (used, wrong), years in groups.items():
        named = "; ".join(
            f"{calendar.name(year)}: "
            + ", ".join(
                f"{source.label} {total:.3g} m" for source, total in snow.choices[year].sums.items()
            )
            for year in years[:MAX_NAMED_WINTERS]
        )
        more = (
            f"; and {len(years) - MAX_NAMED_WINTERS} more winters"
            if len(years) > MAX_NAMED_WINTERS
            else ""
        )
        yield (
            f"columns contradict each other by more than a factor of {CONTRADICTION:g} ({named}"
            f"{more}); the {used.label} is used, not the "
            f"{' or the '.join(sorted(source.label for source in wrong))}"
            f"{_preference_reason(used, wrong)}"
        )


def _contradicting_sources(choice: StationChoice) -> frozenset[SnowSource]:
    """Return the sources that contradict the one in use, which is kept."""
    if not choice.observing:
        return frozenset()
    own = choice.sums.get(choice.observing[0])
    if own is None:
        return frozenset()
    return frozenset(
        source
        for source, total in choice.sums.items()
        if max(total, own) > CONTRADICTION * min(total, own) and abs(total - own) > 0.1
    )


def _preference_reason(used: SnowSource, wrong: frozenset[SnowSource]) -> str:
    if used is SnowSource.DEPTH and SnowSource.GAUGE in wrong:
        return ": gauges catch too little snow in wind or stand still (WMO/TD-872, 1998)"
    if used is SnowSource.DEPTH:
        return ": a cover cannot rise by more than the snowfall"
    if used is SnowSource.GAUGE and SnowSource.DEPTH in wrong:
        return ": a cover settles, melts and drifts away while it snows"
    if used is SnowSource.GAUGE:
        return ": no new snow was entered all winter"
    return ": measured new snow is preferred to derived"
