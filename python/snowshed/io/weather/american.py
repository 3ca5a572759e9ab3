"""Daily data of the United States: NOAA's GHCN-daily (.dly and by station), and ACIS columns."""

from __future__ import annotations

import calendar
import re
from collections.abc import Mapping, Sequence
from datetime import datetime
from typing import Any

from snowshed._core import InputError
from snowshed.io.weather.observation import Observation, Quantity, Station, cells_of, time_of

#: Elements of GHCN-daily: SNOW and SNWD in mm, PRCP in tenths of mm, temperatures in tenths of C.
ELEMENTS: Mapping[str, Quantity] = {
    "SNOW": Quantity("snowfall", "mm", 1e-3),
    "SNWD": Quantity("snow_depth", "mm", 1e-3),
    "PRCP": Quantity("precipitation", "tenths of mm", 0.1),
    "TMAX": Quantity("temperature", "tenths of degrees C", 0.1),
    "TMIN": Quantity("temperature", "tenths of degrees C", 0.1),
    "TAVG": Quantity("temperature", "tenths of degrees C", 0.1),
}
DLY = re.compile(r"^[A-Z0-9_-]{11}\d{6}[A-Z0-9]{4}")
DLY_LINE, DLY_CELL, DLY_DAYS = 21, 8, 31
BY_STATION = re.compile(r"^[A-Z0-9_-]{11},\d{8},[A-Z0-9]{4},")
BY_STATION_CELLS = 8
MISSING = ("", "-9999")
INCH = 0.0254  # m
FAHRENHEIT = (5.0 / 9.0, -160.0 / 9.0)
#: ACIS columns, by what is left of their names in small letters without blanks.
ACIS: Mapping[str, tuple[str, Quantity]] = {
    "maxt": ("TMAX", Quantity("temperature", "degrees F", *FAHRENHEIT)),
    "maxtemperature": ("TMAX", Quantity("temperature", "degrees F", *FAHRENHEIT)),
    "mint": ("TMIN", Quantity("temperature", "degrees F", *FAHRENHEIT)),
    "mintemperature": ("TMIN", Quantity("temperature", "degrees F", *FAHRENHEIT)),
    "avgt": ("TAVG", Quantity("temperature", "degrees F", *FAHRENHEIT)),
    "avgtemperature": ("TAVG", Quantity("temperature", "degrees F", *FAHRENHEIT)),
    "pcpn": ("PRCP", Quantity("precipitation", "inches", 1e3 * INCH)),
    "precipitation": ("PRCP", Quantity("precipitation", "inches", 1e3 * INCH)),
    "snow": ("SNOW", Quantity("snowfall", "inches", INCH)),
    "snowfall": ("SNOW", Quantity("snowfall", "inches", INCH)),
    "snwd": ("SNWD", Quantity("snow_depth", "inches", INCH)),
    "snowdepth": ("SNWD", Quantity("snow_depth", "inches", INCH)),
}
TRACE, LACKING = "T", ("M", "", "S")

Days = dict[datetime, dict[str, Any]]


def is_dly(lines: Sequence[str]) -> bool:
    """Return whether a file is GHCN-daily of fixed width."""
    return bool(lines) and bool(DLY.match(lines[0]))


def read_dly(name: str, lines: Sequence[str]) -> Station:
    """Return a .dly file's observations; raises InputError naming line and column."""
    days: Days = {}
    for number, line in enumerate(lines, 1):
        if not line.strip():
            continue
        place = f"{name}, line {number}"
        if not DLY.match(line):
            raise InputError(f"{place}: does not begin with station, year, month and element")
        element = line[17:21]
        if element not in ELEMENTS:
            continue
        year, month = int(line[11:15]), int(line[15:17])
        if not 1 <= month <= 12 or year < 1:
            raise InputError(f"{place}, column month: {line[15:17]!r}; allowed: 01 to 12")
        full = DLY_LINE + DLY_CELL * DLY_DAYS - 3  # flags at the end may be cut off
        if len(line.rstrip("\r\n")) < full - 5:
            raise InputError(f"{place}: {len(line.rstrip())} characters; needed: {full}")
        for day in range(1, calendar.monthrange(year, month)[1] + 1):
            start = DLY_LINE + DLY_CELL * (day - 1)
            if line[start + 6 : start + 7].strip():  # failed a check of quality
                continue
            where = f"{place}, column day {day}"
            value = ELEMENTS[element].read(line[start : start + 5], where, MISSING)
            _enter(days, datetime(year, month, day), number, element, value)
    return Station("GHCN-daily", lines[0][:11], _rows(days), NOTES)


def is_by_station(lines: Sequence[str]) -> bool:
    """Return whether a file is GHCN-daily as of its folder by_station."""
    return bool(lines) and bool(BY_STATION.match(lines[0]))


def read_by_station(name: str, lines: Sequence[str]) -> Station:
    """Return a by_station file's observations; raises InputError naming line and column."""
    days: Days = {}
    for number, line in enumerate(lines, 1):
        if not line.strip():
            continue
        place = f"{name}, line {number}"
        _, date, element, text, _, quality, *_ = cells_of(line, BY_STATION_CELLS, place)
        if element not in ELEMENTS or quality:
            continue
        value = ELEMENTS[element].read(text, f"{place}, column value ({element})", MISSING)
        _enter(days, time_of(date, f"{place}, column date", "%Y%m%d"), number, element, value)
    return Station("GHCN-daily", lines[0][:11], _rows(days), NOTES)


def is_acis(lines: Sequence[str]) -> bool:
    """Return whether a file has the columns of ACIS."""
    return _acis_head(lines) is not None


def read_acis(name: str, lines: Sequence[str]) -> Station:
    """Return ACIS columns as observations; raises InputError naming line and column."""
    start = _acis_head(lines)
    assert start is not None
    head = [cell.strip().strip('"') for cell in lines[start].split(",")]
    columns = {i: ACIS[key] for i, key in enumerate(map(_key, head)) if key in ACIS}
    days: Days = {}
    for number, line in enumerate(lines[start + 1 :], start + 2):
        if not line.strip() or line.startswith("#"):
            continue
        place = f"{name}, line {number}"
        cells = cells_of(line, len(head), place)
        day = time_of(cells[0], f"{place}, column {head[0]}", "%Y-%m-%d", "%m/%d/%Y")
        days.setdefault(day, {"line": number})
        for i, (element, quantity) in columns.items():
            cell = cells[i].removesuffix("A")  # what gathered over several days
            where = f"{place}, column {head[i]}"
            value = 0.0 if cell == TRACE else quantity.read(cell, where, LACKING)
            _enter(days, day, number, element, value)
    title = lines[0].strip().strip('"') if start else ""
    return Station("ACIS", title, _rows(days), ("temperatures in F, depths in inches",))


NOTES = ("values that failed a check of quality are left out",)


def _acis_head(lines: Sequence[str]) -> int | None:
    """Return the line, from 0, that names ACIS columns."""
    for number, line in enumerate(lines[:3]):
        keys = [_key(cell) for cell in line.split(",")]
        if keys and keys[0] == "date" and len([key for key in keys if key in ACIS]) >= 2:
            return number
    return None


def _key(text: str) -> str:
    return re.sub(r"[^a-z]", "", text.lower())


def _enter(days: Days, day: datetime, line: int, element: str, value: float | None) -> None:
    days.setdefault(day, {"line": line})[element] = value


def _rows(days: Days) -> list[Observation]:
    rows = []
    for day, found in sorted(days.items()):
        if all(value is None for key, value in found.items() if key != "line"):
            continue  # nothing was measured, which is a gap
        mean = found.get("TAVG")
        if mean is None and None not in (found.get("TMAX"), found.get("TMIN")):
            mean = 0.5 * (found["TMAX"] + found["TMIN"])
        rows.append(
            Observation(
                found["line"], day, mean, found.get("PRCP"), found.get("SNOW"), found.get("SNWD")
            )
        )
    return rows
