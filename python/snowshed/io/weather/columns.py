"""Choice of the column of a quantity, if several hold it."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import Any, NamedTuple, Optional

from snowshed.io.weather.observation import Observation, Quantity

HOURS = {"precipitation": "precipitation_hours", "snowfall": "snowfall_hours"}
MIN_COLUMN_SHARE = 0.9  # share of the fullest column's values that a column needs
MAX_REMEMBERED = 50_000  # parsed texts of a column that are kept
WORDS = {
    "temperature": "the temperature",
    "precipitation": "precipitation",
    "snowfall": "new snow",
    "snow_depth": "the snow depth",
}


class Column(NamedTuple):
    """A column of a file: its index, its name, and its quantity."""

    place: int
    title: str
    quantity: Quantity


class Cells:
    """Cells of some columns; each text is parsed once, because most values repeat.

    Parameters
    ----------
    columns
        Columns to read.
    missing
        Texts that stand for a missing value.
    """

    def __init__(self, columns: Sequence[Column], missing: Sequence[str]) -> None:
        self.missing = missing
        self.known: list[tuple[Column, dict[str, Optional[float]]]] = [
            (column, {}) for column in columns
        ]

    def read(self, cells: Sequence[str], place: str) -> list[Optional[float]]:
        """Return the values of a row; raises InputError naming the place and the column."""
        values = []
        for (i, title, quantity), parsed in self.known:
            text = cells[i]
            if text not in parsed:
                if len(parsed) >= MAX_REMEMBERED:
                    parsed.clear()
                parsed[text] = quantity.read(text, f"{place}, column {title}", self.missing)
            values.append(parsed[text])
        return values


class Reading(NamedTuple):
    """A row of a file: its line, its time, and the values of its columns."""

    line: int
    time: datetime
    values: Sequence[Optional[float]]


def observations(
    columns: Sequence[Column], readings: Sequence[Reading]
) -> tuple[list[Observation], dict[str, str], list[str]]:
    """Return the rows with one column for each quantity, the names of these columns, and notes.

    Parameters
    ----------
    columns
        Columns by preference. Among several columns of a quantity, the first one is used that
        has at least nine tenths of the values of the fullest column.
    readings
        Values of the `columns`, row by row.
    """
    counts = [
        sum(reading.values[i] is not None for reading in readings) for i in range(len(columns))
    ]
    taken: dict[str, int] = {}
    notes = []
    for name in dict.fromkeys(column.quantity.name for column in columns):
        own = [i for i, column in enumerate(columns) if column.quantity.name == name]
        most = max(counts[i] for i in own)
        taken[name] = next(i for i in own if counts[i] >= MIN_COLUMN_SHARE * most)
        others = [
            f"{columns[i].title} ({counts[i]} values)"
            for i in own
            if i != taken[name] and counts[i] > 0
        ]
        if others:
            best = columns[taken[name]].title
            notes.append(
                f"{WORDS[name]} is that of {best} ({counts[taken[name]]} values); not used: "
                f"{', '.join(others)}"
            )
    rows = []
    for line, time, values in readings:
        given: dict[str, Any] = {name: values[i] for name, i in taken.items()}
        for name, i in taken.items():
            if name in HOURS and values[i] is not None:
                given[HOURS[name]] = columns[i].quantity.hours
        rows.append(Observation(line, time, **given))
    return rows, {name: columns[i].title for name, i in taken.items()}, notes
