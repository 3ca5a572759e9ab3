"""Several files of one station, which hold different quantities or different years."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from datetime import date, datetime, timedelta
from pathlib import Path
from typing import Any, NamedTuple, Optional

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.io.weather.amounts import usual_step
from snowshed.io.weather.columns import HOURS, WORDS
from snowshed.io.weather.observation import RANGES, Observation, Station, replace_values
from snowshed.io.weather.plain import read_plain
from snowshed.io.weather.recognise import read_station

MAX_FILES = 200
#: Largest distance between the files of a station, km.
MAX_STATION_DISTANCE_KM = 2.0
#: Largest difference of altitude between the files of a station, m.
MAX_STATION_HEIGHT_M = 100.0
DEGREE = 111.2  # km of latitude
TEMPERATURE, DEPTH = "temperature", "snow_depth"


class _File(NamedTuple):
    name: str
    station: Station


class _Value(NamedTuple):
    """Value of a quantity in a row of a file."""

    file: int
    row: Observation
    quantity: str


@checked
def read_stations(paths: Sequence[Path], temperature: Optional[Path] = None) -> Station:
    """Return the observations of one station from several files.

    Every quantity is taken, day by day, from the first file that has it on that day. Files may
    complete one another, such as snow by hand and an automatic thermometer, or follow one another,
    such as years. A file may also be a table with the columns ``date`` and one or more of
    ``temperature_c``, ``precipitation_mm``, ``snowfall_m`` and ``snow_depth_m``.

    Parameters
    ----------
    paths
        The files, in order of preference.
    temperature
        Another file, whose temperatures are preferred to those of `paths`.

    Raises
    ------
    InputError
        If a file is not from a station, is a typical year, or the snow and the temperatures have no
        day in common.
    OSError
        If one cannot be read.
    """
    if len(paths) > MAX_FILES:
        raise InputError(f"{len(paths)} weather files; at most {MAX_FILES} are allowed")
    if not paths:
        raise InputError("no weather file is given")
    files = [_read(path) for path in paths]
    if temperature is not None:
        files.append(_read(temperature))
        if TEMPERATURE not in files[-1].station.quantities:
            raise InputError(f"{temperature}: no temperature of the air in any row")
    if len(files) == 1:
        return files[0].station
    files, notes = _on_common_clock(files)
    own = -1 if temperature is not None else None
    values = [value for name in RANGES for value in _quantity_values(files, name, own)]
    rows = _rows(values, _series_of_depth(files))
    _check_common_days(files, values)
    return _station(files, rows, values, notes)


def _read(path: Path) -> _File:
    station = read_station(path) or read_plain(path)
    if station.typical_year:
        raise InputError(
            f"{path}: a typical year of the format {station.format}, which cannot be combined "
            "with another file"
        )
    return _File(Path(path).name, station)


def _on_common_clock(files: Sequence[_File]) -> tuple[list[_File], list[str]]:
    """Return the files on the clock of the first, and notes on their differences."""
    first, *others = files
    clocked, notes = [first], []
    for name, station in others:
        if station.name and first.station.name and not _same_name(station.name, first.station.name):
            notes.append(
                f"{name} is of {station.name}, and {first.name} of {first.station.name}; they are "
                "taken as one station"
            )
        notes += _distance_notes(first, _File(name, station))
        clocked.append(_File(name, _on_clock(station, first.station.utc_offset)))
        if clocked[-1].station is not station:
            notes.append(
                f"{name} is converted from UTC{station.utc_offset:+g} h to the clock of "
                f"{first.name}, UTC{first.station.utc_offset:+g} h"
            )
    return clocked, notes


def _same_name(first: str, other: str) -> bool:
    return first.casefold().strip() == other.casefold().strip()


def _distance_notes(first: _File, other: _File) -> Iterator[str]:
    a, b = first.station, other.station
    if None not in (a.latitude, a.longitude, b.latitude, b.longitude):
        north = ((a.latitude or 0.0) - (b.latitude or 0.0)) * DEGREE
        east = ((a.longitude or 0.0) - (b.longitude or 0.0)) * DEGREE
        distance = math.hypot(north, east * math.cos(math.radians(a.latitude or 0.0)))
        if distance > MAX_STATION_DISTANCE_KM:
            yield f"the stations of {first.name} and {other.name} are {distance:.3g} km apart"
    if a.altitude is not None and b.altitude is not None:
        higher = abs(a.altitude - b.altitude)
        if higher > MAX_STATION_HEIGHT_M:
            yield f"the altitudes of {first.name} and {other.name} differ by {higher:.0f} m"


def _on_clock(station: Station, offset: Optional[float]) -> Station:
    """Return a station on another clock, if its own is known and its rows are shorter than days."""
    if offset is None or station.utc_offset in (None, offset):
        return station
    if usual_step([row.time for row in station.rows]) > 12.0:
        return station
    shift = timedelta(hours=offset - (station.utc_offset or 0.0))
    rows = [
        replace_values(row, time=row.time + shift, end=row.end and row.end + shift)
        for row in station.rows
    ]
    return replace(station, rows=rows, utc_offset=offset)


def _quantity_values(files: Sequence[_File], name: str, own: Optional[int]) -> list[_Value]:
    """Return the values of a quantity; each day uses the first file with a value."""
    order = list(range(len(files)))
    if own is not None:  # the temperature file supplies only the temperature
        order = [order[own], *order[:own]] if name == TEMPERATURE else order[:own]
    taken: set[date] = set()
    values = []
    for number in order:
        new: set[date] = set()
        for row in files[number].station.rows:
            if getattr(row, name) is None:
                continue
            days = _days(row, name)
            if taken.isdisjoint(days):
                values.append(_Value(number, row, name))
                new.update(days)
        taken |= new
    return values


def _days(row: Observation, name: str) -> set[date]:
    hours = getattr(row, HOURS[name]) if name in HOURS else None
    return set(row.shares(hours))


def _series_of_depth(files: Sequence[_File]) -> list[int]:
    """Return for each file the index of the first file of the same depth sensor.

    Such files have the same station and column, and equal values at common times.
    """
    by_time = [
        {row.time: row.snow_depth for row in file.station.rows if row.snow_depth is not None}
        for file in files
    ]
    series = list(range(len(files)))
    for n, file in enumerate(files):
        for i in range(n):
            other = files[i].station
            same = (other.name, other.columns.get(DEPTH)) == (
                file.station.name,
                file.station.columns.get(DEPTH),
            )
            if same and all(
                by_time[i][time] == by_time[n][time] for time in by_time[i].keys() & by_time[n]
            ):
                series[n] = series[i]
                break
    return series


def _rows(values: Sequence[_Value], series: Sequence[int]) -> list[Observation]:
    """Return one row for each time; a row whose depth begins another series is a seam."""
    by_time: dict[datetime, list[_Value]] = {}
    for value in values:
        by_time.setdefault(value.row.time, []).append(value)
    rows, source = [], None
    for time, own in sorted(by_time.items()):
        given: dict[str, Any] = {"seam": False, "end": None}
        for number, row, name in own:
            given[name] = getattr(row, name)
            if name in HOURS:
                given[HOURS[name]] = getattr(row, HOURS[name])
                given["end"] = given["end"] or row.end
            if name == DEPTH:
                given["seam"] = row.seam or source not in (None, series[number])
                source = series[number]
        rows.append(Observation(min(value.row.line for value in own), time, **given))
    return rows


def _check_common_days(files: Sequence[_File], values: Sequence[_Value]) -> None:
    days: dict[bool, set[date]] = {True: set(), False: set()}
    for _, row, name in values:
        days[name == TEMPERATURE] |= _days(row, name)
    if days[True] and days[False] and days[True].isdisjoint(days[False]):
        periods = "; ".join(
            f"{name} from {station.rows[0].time.date()} to {station.rows[-1].time.date()}"
            for name, station in files
        )
        raise InputError(
            f"{files[0].name}: its temperatures and its snow have no day in common: {periods}"
        )


def _station(
    files: Sequence[_File], rows: Sequence[Observation], values: Sequence[_Value], notes: list[str]
) -> Station:
    columns: dict[str, str] = {}
    rolling: set[str] = set()
    used: set[int] = set()
    for name in RANGES:
        days: dict[int, set[date]] = {}
        for number, row, quantity in values:
            if quantity == name:
                days.setdefault(number, set()).update(_days(row, name))
        titles = [
            f"{files[i].station.columns.get(name, name)} of {files[i].name}" for i in sorted(days)
        ]
        if titles:
            columns[name] = " and ".join(titles)
            parts = (
                f"{title} on {len(own)} days" for title, own in zip(titles, _days_by_number(days))
            )
            notes.append(f"{WORDS[name]} is from {', '.join(parts)}")
        used |= days.keys()
        rolling |= {name for i in days if name in files[i].station.rolling}
    notes += [
        f"{file.name} adds nothing" for number, file in enumerate(files) if number not in used
    ]
    notes += [f"{file.name}: {note}" for file in files for note in file.station.notes]
    stations = [file.station for file in files]
    return Station(
        " and ".join(dict.fromkeys(station.format for station in stations)),
        next((station.name for station in stations if station.name), ""),
        rows,
        notes,
        False,
        next((station.latitude for station in stations if station.latitude is not None), None),
        next((station.longitude for station in stations if station.longitude is not None), None),
        next((station.altitude for station in stations if station.altitude is not None), None),
        stations[0].utc_offset,
        columns,
        frozenset(rolling),
    )


def _days_by_number(days: dict[int, set[date]]) -> list[set[date]]:
    return [days[number] for number in sorted(days)]
