"""Years of building and solar energy, hour after hour: EPW and TMY3.

Most are typical years, whose months come from different years. Precipitation is given as totals
over one or more hours, which may contain one another.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import datetime, timedelta
from typing import Any, NamedTuple, Optional

from snowshed._core import InputError
from snowshed.base.formatting import number_in
from snowshed.base.messages import quoted
from snowshed.io.weather.amounts import Total, usual_step, without_overlap
from snowshed.io.weather.observation import (
    Observation,
    Quantity,
    Station,
    cells_of,
    coordinate,
    split_cells,
    time_of,
)
from snowshed.io.weather.years import arrange_winters

EPW_HEADER, EPW_LAST = 8, "DATA PERIODS"
EPW_HEAD = (
    "year", "month", "day", "hour", "minute", "data sources", "dry bulb temperature",
    "dew point temperature", "relative humidity", "pressure", "extraterrestrial horizontal",
    "extraterrestrial direct normal", "horizontal infrared", "global horizontal", "direct normal",
    "diffuse horizontal", "global illuminance", "direct illuminance", "diffuse illuminance",
    "zenith luminance", "wind direction", "wind speed", "total sky cover", "opaque sky cover",
    "visibility", "ceiling height", "present weather", "weather codes", "precipitable water",
    "aerosol optical depth", "snow depth", "days since snow", "albedo",
    "liquid precipitation depth", "liquid precipitation quantity",
)  # fmt: skip
EPW_OLDER = 32  # columns of older files, without albedo and rain
EPW_COLUMNS = (
    ("dry bulb temperature", Quantity("temperature", "degrees C"), "99.9"),
    ("snow depth", Quantity("snow_depth", "cm", 0.01), "999"),
    ("liquid precipitation depth", Quantity("precipitation", "mm"), "999"),
)
TMY3_NAMES = {
    "Dry-bulb (C)": Quantity("temperature", "degrees C"),
    "Lprecip depth (mm)": Quantity("precipitation", "mm"),
}
TMY3_DATE, TMY3_TIME = "Date (MM/DD/YYYY)", "Time (HH:MM)"
EPW_PERIOD = "liquid precipitation quantity"
#: Columns of name, latitude, longitude, altitude and time zone in the first line of an EPW file.
EPW_PLACE = (1, 6, 7, 9, 8)
#: The same of a TMY3 file.
TMY3_PLACE = (1, 4, 5, 6, 3)
NUMBERS = (("latitude", 90.0), ("longitude", 360.0), ("elevation", 9000.0), ("time zone", 15.0))
TMY3_PERIOD = "Lprecip quantity (hr)"
UNKNOWN = 99.0  # hours of a total that stand for a missing value in EPW
MISSING_TMY3 = -9900.0  # hours of a total that stand for a missing value in TMY3
MINUTE = timedelta(minutes=1)


class _StationHeader(NamedTuple):
    """A station: its name, latitude, longitude, altitude, and hours ahead of universal time."""

    name: str
    latitude: Optional[float]
    longitude: Optional[float]
    altitude: Optional[float]
    utc_offset: Optional[float]

    @classmethod
    def of(cls, line: str, name: str, columns: Sequence[int]) -> _StationHeader:
        """Return the station in the first line; its name and numbers are in the given columns."""
        cells = [*split_cells(line, f"{name}, line 1"), *[""] * 10]
        numbers = [
            coordinate(cells[i], f"{name}, line 1, column {title}", largest)
            for i, (title, largest) in zip(columns[1:], NUMBERS)
        ]
        return cls(cells[columns[0]], *numbers)


def is_epw(lines: Sequence[str]) -> bool:
    """Return whether a file is EPW."""
    return lines[0].startswith("LOCATION,")


def read_epw(name: str, lines: Sequence[str]) -> Station:
    """Return an EPW file's observations; raises InputError naming line and column."""
    if len(lines) < EPW_HEADER or not lines[EPW_HEADER - 1].startswith(EPW_LAST):
        beginning = lines[EPW_HEADER - 1].split(",")[0] if len(lines) >= EPW_HEADER else "nothing"
        raise InputError(
            f"{name}, line {min(len(lines), EPW_HEADER)}, column 1: {quoted(beginning)}; allowed: "
            f"{EPW_LAST}, which ends the header of an EPW file"
        )
    rows, periods = [], []
    for number, line in enumerate(lines[EPW_HEADER:], EPW_HEADER + 1):
        if not line.strip():
            continue
        place = f"{name}, line {number}"
        older = line.count(",") == EPW_OLDER - 1
        head = EPW_HEAD[:EPW_OLDER] if older else EPW_HEAD
        cells = dict(zip(head, cells_of(line, head, place)))
        values: dict[str, Any] = {
            quantity.name: quantity.read(
                cells.get(title, ""), f"{place}, column {title}", ("", missing)
            )
            for title, quantity, missing in EPW_COLUMNS
        }
        time, end = _epw_time(cells, place)
        rows.append(Observation(number, time, **values, end=end))
        periods.append(_period(cells.get(EPW_PERIOD, ""), f"{place}, column {EPW_PERIOD}"))
    columns = {quantity.name: title for title, quantity, _ in EPW_COLUMNS}
    return _station(
        "EPW", name, _StationHeader.of(lines[0], name, EPW_PLACE), rows, periods, columns
    )


def _epw_time(cells: dict[str, str], place: str) -> tuple[datetime, datetime]:
    """Return the time of a row, a minute before the end of its period, and that end."""
    year, month, day, minute = (
        _integer(cells[title], f"{place}, column {title}", 0, 9999)
        for title in ("year", "month", "day", "minute")
    )
    hour = _integer(cells["hour"], f"{place}, column hour", 1, 24)
    try:
        begin = datetime(year, month, day, hour - 1)
        time = begin.replace(minute=max(min(minute, 60) - 1, 0))
        return time, begin + timedelta(minutes=min(minute, 60) or 60)
    except (ValueError, OverflowError):
        raise InputError(f"{place}, column day: {year}-{month}-{day} is not a date") from None


def is_tmy3(lines: Sequence[str]) -> bool:
    """Return whether a file is TMY3."""
    return len(lines) > 1 and TMY3_DATE in lines[1]


def read_tmy3(name: str, lines: Sequence[str]) -> Station:
    """Return a TMY3 file's observations; raises InputError naming line and column."""
    head = split_cells(lines[1], f"{name}, line 2")
    for needed in (TMY3_DATE, TMY3_TIME, *TMY3_NAMES):
        if needed not in head:
            raise InputError(f"{name}, line 2, column {needed}: missing")
    rows, periods = [], []
    for number, line in enumerate(lines[2:], 3):
        if not line.strip():
            continue
        place = f"{name}, line {number}"
        cells = dict(zip(head, cells_of(line, head, place)))
        values: dict[str, Any] = {
            quantity.name: quantity.read(cells[title], f"{place}, column {title}", ("", "-9900"))
            for title, quantity in TMY3_NAMES.items()
        }
        end = _tmy3_end(cells, place)
        rows.append(Observation(number, end - MINUTE, **values, end=end))
        periods.append(_period(cells.get(TMY3_PERIOD, ""), f"{place}, column {TMY3_PERIOD}"))
    columns = {quantity.name: title for title, quantity in TMY3_NAMES.items()}
    return _station(
        "TMY3", name, _StationHeader.of(lines[0], name, TMY3_PLACE), rows, periods, columns
    )


def _tmy3_end(cells: dict[str, str], place: str) -> datetime:
    """Return the end of a row's hour: midnight is 24:00, or 00:00 of the next day."""
    day = time_of(cells[TMY3_DATE], f"{place}, column {TMY3_DATE}", "%m/%d/%Y")
    where = f"{place}, column {TMY3_TIME}"
    hour, _, minute = cells[TMY3_TIME].partition(":")
    hours, minutes = _integer(hour, where, 0, 24), _integer(minute or "0", where, 0, 59)
    try:
        end = day + timedelta(hours=hours, minutes=minutes)
        _ = end - MINUTE, end + timedelta(days=1)
    except OverflowError:
        raise InputError(f"{where}: no time before or after that") from None
    return end


def _integer(text: str, where: str, low: int, high: int) -> int:
    number = number_in(text)
    if not (low <= number <= high and number == int(number)):
        raise InputError(f"{where}: {quoted(text)}; allowed: whole numbers from {low} to {high}")
    return int(number)


def _period(text: str, where: str) -> Optional[float]:
    """Return the hours of a total of precipitation; None: missing, or 0."""
    number = number_in(text) if text else 0.0
    if number == MISSING_TMY3:
        return None
    if not 0.0 <= number <= UNKNOWN:
        raise InputError(f"{where}: {quoted(text)}; allowed: hours from 0 to {UNKNOWN:g}")
    return number if 0.0 < number < UNKNOWN else None


def _station(
    form: str,
    source: str,
    place: _StationHeader,
    rows: Sequence[Observation],
    periods: Sequence[Optional[float]],
    columns: Mapping[str, str],
) -> Station:
    completed, of_amounts = _with_amounts(rows, periods)
    completed, typical, of_years = arrange_winters(completed, place.latitude, source)
    return Station(
        form, place.name, completed, (*of_amounts, *of_years), typical, *place[1:], columns
    )


def _with_amounts(
    rows: Sequence[Observation], periods: Sequence[Optional[float]]
) -> tuple[list[Observation], list[str]]:
    """Return the rows with amounts that do not overlap, and notes on overlapping ones."""
    step = usual_step([row.time for row in rows])
    if not any(period for row, period in zip(rows, periods) if row.precipitation is not None):
        periods = [step] * len(rows)  # no row states its period
    totals = {
        i: Total(row.end or row.time, period, row.precipitation)
        for i, (row, period) in enumerate(zip(rows, periods))
        if row.precipitation is not None and period is not None
    }
    amounts, notes = without_overlap(list(totals.values()), min(step, 1.0), "mm of precipitation")
    unknown = [row for i, row in enumerate(rows) if row.precipitation and i not in totals]
    if unknown:
        notes.append(
            f"{sum(row.precipitation or 0.0 for row in unknown):g} mm of precipitation in "
            f"{len(unknown)} rows are totals over an unknown time, and left out"
        )
    own = dict(zip(totals, amounts))
    return [
        replace(row, precipitation=own.get(i), precipitation_hours=periods[i] if i in own else None)
        for i, row in enumerate(rows)
    ], notes
