"""Typical years of building and solar energy: EPW and TMY3, hour after hour.

Their months come from different years, so that they are no winters that were. A year is put
together again from July to June.
"""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime, timedelta

from snowshed._core import InputError
from snowshed.io.messages import quoted
from snowshed.io.number_text import number_in
from snowshed.io.weather.observation import (
    Observation,
    Quantity,
    Station,
    cells_of,
    split_cells,
    time_of,
)

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
EPW_OLDER = 32  # columns of files from before albedo and rain were added
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


def is_epw(lines: Sequence[str]) -> bool:
    """Return whether a file is EPW."""
    return lines[0].startswith("LOCATION,")


def read_epw(name: str, lines: Sequence[str]) -> Station:
    """Return an EPW file's observations; raises InputError naming line and column."""
    if len(lines) < EPW_HEADER or not lines[EPW_HEADER - 1].startswith(EPW_LAST):
        found = lines[EPW_HEADER - 1].split(",")[0] if len(lines) >= EPW_HEADER else "nothing"
        raise InputError(
            f"{name}, line {min(len(lines), EPW_HEADER)}, column 1: {quoted(found)}; allowed: "
            f"{EPW_LAST}, which ends the header of an EPW file"
        )
    rows = []
    for number, line in enumerate(lines[EPW_HEADER:], EPW_HEADER + 1):
        if not line.strip():
            continue
        place = f"{name}, line {number}"
        older = line.count(",") == EPW_OLDER - 1
        head = EPW_HEAD[:EPW_OLDER] if older else EPW_HEAD
        cells = dict(zip(head, cells_of(line, head, place)))
        values = {
            one.name: one.read(cells.get(title, ""), f"{place}, column {title}", ("", missing))
            for title, one, missing in EPW_COLUMNS
        }
        rows.append(Observation(number, _epw_time(cells, place), **values))
    return Station("EPW", lines[0].split(",")[1].strip(), rows, typical_year=True)


def _epw_time(cells: dict[str, str], place: str) -> datetime:
    """Return the time of a row: a minute before the end of its hour, or of its part of an hour."""
    year, month, day, minute = (
        _whole(cells[title], f"{place}, column {title}", 0, 9999)
        for title in ("year", "month", "day", "minute")
    )
    hour = _whole(cells["hour"], f"{place}, column hour", 1, 24)
    try:
        return datetime(year, month, day, hour - 1, max(min(minute, 60) - 1, 0))
    except ValueError:
        raise InputError(f"{place}, column day: {year}-{month}-{day} is no date") from None


def is_tmy3(lines: Sequence[str]) -> bool:
    """Return whether a file is TMY3."""
    return len(lines) > 1 and TMY3_DATE in lines[1]


def read_tmy3(name: str, lines: Sequence[str]) -> Station:
    """Return a TMY3 file's observations; raises InputError naming line and column."""
    head = split_cells(lines[1], f"{name}, line 2")
    for needed in (TMY3_DATE, TMY3_TIME, *TMY3_NAMES):
        if needed not in head:
            raise InputError(f"{name}, line 2, column {needed}: missing")
    rows = []
    for number, line in enumerate(lines[2:], 3):
        if not line.strip():
            continue
        place = f"{name}, line {number}"
        cells = dict(zip(head, cells_of(line, head, place)))
        day = time_of(cells[TMY3_DATE], f"{place}, column {TMY3_DATE}", "%m/%d/%Y")
        # midnight is 24:00 in files of NREL, and 00:00 of the next day in those of others
        hour = _whole(cells[TMY3_TIME].partition(":")[0], f"{place}, column {TMY3_TIME}", 0, 24)
        values = {
            one.name: one.read(cells[title], f"{place}, column {title}", ("", "-9900"))
            for title, one in TMY3_NAMES.items()
        }
        rows.append(Observation(number, _hour_before(day, hour, place), **values))
    title = [*split_cells(lines[0], f"{name}, line 1"), ""][1]
    return Station("TMY3", title, rows, typical_year=True)


def _hour_before(day: datetime, hour: int, place: str) -> datetime:
    try:
        return day + timedelta(hours=hour - 1)
    except OverflowError:
        raise InputError(f"{place}, column {TMY3_DATE}: {day.year} is no year of weather") from None


def _whole(text: str, where: str, low: int, high: int) -> int:
    number = number_in(text)
    if not (low <= number <= high and number == int(number)):
        raise InputError(f"{where}: {quoted(text)}; allowed: whole numbers from {low} to {high}")
    return int(number)
