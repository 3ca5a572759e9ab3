"""Plain tables of one or more quantities, which complete a station's file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from snowshed._core import InputError
from snowshed.base.messages import quoted
from snowshed.io.csv_table import read_text_table
from snowshed.io.weather.clock import on_one_clock
from snowshed.io.weather.columns import Column, Reading, observations
from snowshed.io.weather.gathering import with_hours
from snowshed.io.weather.observation import Quantity, Station, time_of
from snowshed.io.weather.plausible import with_plausible_units

DATE = "date"
COLUMNS: Mapping[str, Quantity] = {
    "temperature_c": Quantity("temperature", "degrees C"),
    "precipitation_mm": Quantity("precipitation", "mm"),
    "snowfall_m": Quantity("snowfall", "m"),
    "snow_depth_m": Quantity("snow_depth", "m"),
}


def read_plain(path: Path) -> Station:
    """Return the observations of a CSV table with the columns `date` and some of `COLUMNS`.

    An amount is the sum since the row before.

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
    return with_plausible_units(with_hours(station), str(path))


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
