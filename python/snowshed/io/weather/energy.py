"""Typical years of building and solar energy: EPW and TMY3, hour after hour.

Their months come from different years, so that they are no winters that were. A year is put
together again from July to June.
"""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime, timedelta

from snowshed._core import InputError
from snowshed.io.weather.observation import Observation, Quantity, Station, cells_of, time_of

EPW_HEADER, EPW_CELLS = 8, 35
EPW_TEMPERATURE, EPW_DEPTH, EPW_RAIN = 6, 30, 33
TMY3_NAMES = {
    "Dry-bulb (C)": Quantity("temperature", "degrees C"),
    "Lprecip depth (mm)": Quantity("precipitation", "mm"),
}
TMY3_DATE, TMY3_TIME = "Date (MM/DD/YYYY)", "Time (HH:MM)"


def is_epw(lines: Sequence[str]) -> bool:
    """Return whether a file is EPW."""
    return bool(lines) and lines[0].startswith("LOCATION,")


def read_epw(name: str, lines: Sequence[str]) -> Station:
    """Return an EPW file's observations; raises InputError naming line and column."""
    if len(lines) <= EPW_HEADER or not lines[EPW_HEADER - 1].startswith("DATA PERIODS"):
        raise InputError(
            f"{name}, line {min(len(lines), EPW_HEADER)}: no line DATA PERIODS, which "
            "ends the header of an EPW file"
        )
    columns = (
        (EPW_TEMPERATURE, "dry bulb temperature", Quantity("temperature", "degrees C"), "99.9"),
        (EPW_DEPTH, "snow depth", Quantity("snow_depth", "cm", 0.01), "999"),
        (EPW_RAIN, "liquid precipitation depth", Quantity("precipitation", "mm"), "999"),
    )
    rows = []
    for number, line in enumerate(lines[EPW_HEADER:], EPW_HEADER + 1):
        if not line.strip():
            continue
        place = f"{name}, line {number}"
        cells = cells_of(line, EPW_CELLS, place)
        year, month, day, hour = (
            _whole(cells[i], f"{place}, column {title}")
            for i, title in enumerate(("year", "month", "day", "hour"))
        )
        try:
            time = datetime(year, month, day) + timedelta(hours=hour - 1)
        except ValueError:
            raise InputError(
                f"{place}, column day: {year}-{month}-{day} hour {hour} is no date"
            ) from None
        values = {
            one.name: one.read(cells[i], f"{place}, column {title}", ("", missing))
            for i, title, one, missing in columns
        }
        rows.append(Observation(number, time, **values))
    return Station("EPW", lines[0].split(",")[1].strip(), rows, typical_year=True)


def is_tmy3(lines: Sequence[str]) -> bool:
    """Return whether a file is TMY3."""
    return len(lines) > 1 and TMY3_DATE in lines[1]


def read_tmy3(name: str, lines: Sequence[str]) -> Station:
    """Return a TMY3 file's observations; raises InputError naming line and column."""
    head = [cell.strip() for cell in lines[1].split(",")]
    for needed in (TMY3_TIME, *TMY3_NAMES):
        if needed not in head:
            raise InputError(f"{name}, line 2: no column {needed!r}")
    rows = []
    for number, line in enumerate(lines[2:], 3):
        if not line.strip():
            continue
        place = f"{name}, line {number}"
        cells = dict(zip(head, cells_of(line, len(head), place)))
        day = time_of(cells[TMY3_DATE], f"{place}, column {TMY3_DATE}", "%m/%d/%Y")
        hour = _whole(cells[TMY3_TIME].partition(":")[0], f"{place}, column {TMY3_TIME}")
        if not 1 <= hour <= 24:
            raise InputError(f"{place}, column {TMY3_TIME}: {hour}; allowed: 01:00 to 24:00")
        values = {
            one.name: one.read(cells[title], f"{place}, column {title}", ("", "-9900"))
            for title, one in TMY3_NAMES.items()
        }
        rows.append(Observation(number, day + timedelta(hours=hour - 1), **values))
    return Station("TMY3", lines[0].split(",")[1].strip(' "'), rows, typical_year=True)


def _whole(text: str, where: str) -> int:
    try:
        return int(float(text))
    except (ValueError, OverflowError):
        raise InputError(f"{where}: {text[:40]!r} is not a whole number") from None
