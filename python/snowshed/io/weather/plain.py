"""Plain tables of one or more quantities, which complete a station's file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import date, datetime, timedelta
from pathlib import Path

from snowshed._core import InputError
from snowshed.base.messages import quoted
from snowshed.io.csv_table import read_text_table
from snowshed.io.weather.amounts import usual_step
from snowshed.io.weather.clock import on_one_clock
from snowshed.io.weather.columns import Column, Reading, observations
from snowshed.io.weather.gathering import with_hours
from snowshed.io.weather.observation import (
    DAY,
    Observation,
    Quantity,
    Station,
    replace_values,
    time_of,
)
from snowshed.io.weather.plausible import with_plausible_units

DATE = "date"
LIST_SPACING_HOURS = 36.0  # smallest median time between the rows of a list of snowfalls
COLUMNS: Mapping[str, Quantity] = {
    "temperature_c": Quantity("temperature", "degrees C"),
    "precipitation_mm": Quantity("precipitation", "mm"),
    "snowfall_m": Quantity("snowfall", "m"),
    "snow_depth_m": Quantity("snow_depth", "m"),
}


def read_plain(path: Path) -> Station:
    """Return the observations of a CSV table with the columns `date` and some of `COLUMNS`.

    An amount is the sum since the row before. If most rows with new snow are more than a day and a
    half apart, the table lists snowfalls, as a season file may: each falls on the day of its row,
    and on days without a row no snow falls.

    Raises
    ------
    InputError
        Naming the file, the line and the column.
    OSError
        If it cannot be read.
    """
    table = read_text_table(
        path, f"it needs the columns {DATE} and {_allowed_columns()}", _check_names
    )
    columns = [
        Column(i, title, COLUMNS[title]) for i, title in enumerate(table.columns) if title != DATE
    ]
    readings = [
        Reading(
            row.number,
            time_of(row.cells[DATE], f"{row.where}, column {DATE}"),
            [
                quantity.read(row.cells[title], f"{row.where}, column {title}")
                for _, title, quantity in columns
            ],
        )
        for row in table.rows
    ]
    if not readings:
        raise InputError(f"{path}: no rows below the header")
    rows, titles, notes = observations(columns, readings)
    station = on_one_clock(Station("table", "", rows, notes, columns=titles), str(path))
    return with_plausible_units(with_hours(_with_days_between(station)), str(path))


def _with_days_between(station: Station) -> Station:
    """Return a station whose list of snowfalls, if it has one, holds the days between, too."""
    falls = [row.time for row in station.rows if row.snowfall is not None]
    if len(falls) < 2 or usual_step(falls) <= LIST_SPACING_HOURS:
        return station
    rows: list[Observation] = []
    for row in station.rows:
        if rows and row.snowfall is not None:
            first, end = rows[-1].time.date() + timedelta(1), row.time.date()
            rows += [
                Observation(row.line, day, snowfall=0.0, snowfall_hours=DAY)
                for day in _days(first, end)
            ]
        hours = None if row.snowfall is None else DAY
        rows.append(replace_values(row, snowfall_hours=hours))
    note = (
        "it lists snowfalls; each counts on the day of its row, and days without a row count as "
        "days without snow"
    )
    return replace(station, rows=rows, notes=[*station.notes, note])


def _days(first: date, end: date) -> list[datetime]:
    """Return the days from the first one to the last before the end."""
    midnight = datetime(first.year, first.month, first.day)
    return [midnight + timedelta(number) for number in range((end - first).days)]


def _check_names(names: Sequence[str], where: str) -> None:
    for name in names:
        if name != DATE and name not in COLUMNS:
            raise InputError(
                f"{where}: neither a weather file of a known format nor a table: unknown column "
                f"{quoted(name)}; allowed: {DATE}, {_allowed_columns()}"
            )
    if DATE not in names or len(names) < 2:
        raise InputError(
            f"{where}: needed: the column {DATE}, and one or more of {_allowed_columns()}"
        )


def _allowed_columns() -> str:
    return ", ".join(COLUMNS)
