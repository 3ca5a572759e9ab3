"""The weather of a season as JSON data, which holds every number."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from datetime import datetime
from typing import Any

from snowshed._core import InputError
from snowshed.season.weather.row import Weather
from snowshed.season.weather.season_record import SeasonRecord
from snowshed.season.weather.source import SnowSource


def rows_data(rows: Sequence[Weather]) -> dict[str, list[Any]]:
    """Return the columns of rows as JSON data; those in which all rows have the default are out.

    Examples
    --------
    >>> rows_data([Weather(2, datetime(2024, 12, 1), 0.1, None, -4.0)])
    {'line': [2], 'date': ['2024-12-01T00:00:00'], 'snowfall': [0.1], 'density': [None], \
'temperature': [-4.0]}
    """
    data = {}
    for field in fields(Weather):
        values = [getattr(row, field.name) for row in rows]
        if any(value != field.default for value in values):
            data[field.name] = [_plain(value) for value in values]
    return data


def rows_of(data: Mapping[str, Any], where: str) -> list[Weather]:
    """Return the rows that `rows_data` has written.

    Raises
    ------
    InputError
        If they are damaged; the message begins with `where`.
    """
    try:
        columns = {name: [_value(name, value) for value in data[name]] for name in data}
        count = len(columns["line"])
        if any(len(values) != count for values in columns.values()):
            raise ValueError("columns of different lengths")
        return [Weather(**dict(zip(columns, row))) for row in zip(*columns.values())]
    except (KeyError, TypeError, ValueError) as error:
        raise InputError(f"{where}: damaged: {error}") from None


def weather_data(record: SeasonRecord) -> dict[str, Any]:
    """Return the weather of a season or of many winters as JSON data."""
    return {
        "rows": rows_data(record.rows),
        "notes": list(record.notes),
        "latitude": record.latitude,
        "sums": {
            str(year): {source.value: total for source, total in sums.items()}
            for year, sums in record.sums.items()
        },
    }


def weather_of(data: Mapping[str, Any], where: str) -> SeasonRecord:
    """Return the weather that `weather_data` has written; raises InputError as `rows_of` does."""
    try:
        sums = {
            int(year): {SnowSource(name): float(total) for name, total in sums.items()}
            for year, sums in data["sums"].items()
        }
        rows = rows_of(data["rows"], where)
        return SeasonRecord(rows, list(data["notes"]), data["latitude"], sums)
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(f"{where}: damaged: {error}") from None


def _plain(value: Any) -> Any:
    if isinstance(value, datetime):
        return value.isoformat()
    if isinstance(value, SnowSource):
        return value.value
    return value.item() if hasattr(value, "item") else value


def _value(name: str, value: Any) -> Any:
    if name == "date":
        return datetime.fromisoformat(value)
    return SnowSource(value) if name == "source" else value
