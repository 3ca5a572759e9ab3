"""The weather of a season: the dates, depths and densities of its snowfalls.

It is a table: a CSV file, in which empty lines and lines that begin with ``#`` are ignored, or a
DataFrame. A row without snowfall lets time pass and tests the release with the friction and
adhesion of that day.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Optional, Union

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.formatting import number_in
from snowshed.base.messages import quoted
from snowshed.base.notes import InputNote, issue_note
from snowshed.base.paths import PathLike
from snowshed.io.csv_table import TableRow, frame_as_text, read_text_table
from snowshed.io.weather.clock import standard_clock
from snowshed.io.weather.joined import read_stations
from snowshed.io.weather.observation import Station, iso_time
from snowshed.io.weather.recognise import read_station
from snowshed.season.weather.checks import (
    NO_SNOW,
    check_given_rows,
    check_rows,
    unusual_numbers,
    warm_snow,
)
from snowshed.season.weather.columns import ALLOWED, COLUMNS, MeasuredColumn
from snowshed.season.weather.observed import record_of
from snowshed.season.weather.quality import gap_notes
from snowshed.season.weather.row import Weather
from snowshed.season.weather.season_record import ReadSeason, SeasonRecord
from snowshed.season.weather.source import AUTO, CHOICES

if TYPE_CHECKING:
    import pandas as pd


#: Other spellings of units.
SAME_UNITS: Mapping[str, Sequence[str]] = {"degrees C": ("degC", "°C"), "": ("1",)}


Season = Union[PathLike, Sequence[PathLike], "pd.DataFrame", Sequence[Weather]]


@checked
def read_season(season: Season) -> list[Weather]:
    r"""Return the rows of a season, checked.

    Parameters
    ----------
    season
        A weather file in one of the formats of `snowshed.io.weather.FORMATS`, recognised by its
        content, or a CSV file or a pandas DataFrame with the columns ``date`` (ISO 8601 or
        timestamps, increasing; of a DataFrame also its index), ``snowfall_m``, ``temperature_c``
        and, if known, ``density_kg_m3``, ``friction``, ``adhesion_pa``, ``snow_depth_m`` (of the
        natural snow cover) and ``irradiance_w_m2`` (of the panel's plane). The names tell the
        units. If ``attrs["units"]`` of a DataFrame has the unit of a column, it must agree. Rows of
        `Weather` are checked and returned unchanged. Several weather files of one station are read
        as one (`snowshed.io.weather.read_stations`).

    Raises
    ------
    InputError
        Naming the file, the line (in a DataFrame the row) and the column, the error and the allowed
        values.
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> import pandas as pd
    >>> dates = pd.to_datetime(["2024-12-01", "2024-12-02"])
    >>> table = pd.DataFrame({"date": dates, "snowfall_m": [0.2, 0.0], "temperature_c": [-4, 1.5]})
    >>> [(row.snowfall, row.temperature) for row in read_season(table)]
    [(0.2, -4.0), (0.0, 1.5)]
    """
    record = read_record(season)
    for note in record.notes:
        issue_note(note, InputNote)
    return ReadSeason(record.rows, record.notes)


@checked
def read_weather(
    season: Season, temperature: Optional[PathLike] = None
) -> tuple[list[Weather], list[str]]:
    """Return the rows of a season, as `read_season` does, and notes on assumptions made in reading.

    Parameters
    ----------
    season, temperature
        As for `read_record`, which raises the same errors.
    """
    record = read_record(season, temperature=temperature)
    return [*record.rows], [*record.notes]


@checked
def read_record(
    season: Season, snow_from: str = AUTO, temperature: Optional[PathLike] = None
) -> SeasonRecord:
    """Return the weather of a season or of many winters, with its quality.

    Parameters
    ----------
    season
        As for `read_season`, which raises the same errors.
    snow_from
        The column of a station that observes snow, a name in `CHOICES`; "auto": the best of each
        winter (`snowshed.season.weather.station_choice`).
    temperature
        Another file of the same station, whose temperatures come first
        (`snowshed.io.weather.read_stations`).
    """
    if snow_from != AUTO and snow_from not in CHOICES:
        allowed = ", ".join((AUTO, *CHOICES))
        raise InputError(f"snow from: {quoted(snow_from)}; allowed: {allowed}")
    files = weather_files(season)
    if snow_from != AUTO and not files:
        raise InputError(f"snow from: {snow_from}: allowed with weather files only, not with rows")
    if temperature is not None and not files:
        raise InputError(
            "a file of temperatures is allowed with weather files only, not with a table"
        )
    if files and not isinstance(season, (str, os.PathLike)) and len(files) < len(season):
        raise InputError("the season: both files and rows; give one of the two")
    if len(files) > 1 or temperature is not None:
        joined = read_stations(files, None if temperature is None else Path(temperature))
        return _station_record(joined, " and ".join(map(str, files)), snow_from)
    if files:
        season = files[0]
    if isinstance(season, (str, os.PathLike)):
        station = read_station(Path(season))
        if station is not None:
            return _station_record(station, str(season), snow_from)
        hint = f"the first line names the columns: {', '.join(ALLOWED)}"
        table, name = read_text_table(Path(season), hint, _check_columns), str(season)
    elif isinstance(season, Sequence):
        if not season:
            raise InputError("the season: no rows")
        rows = check_given_rows(season)
        return SeasonRecord(rows, _notes_on_rows(rows))
    else:
        table, name = frame_as_text(season, "the season", index="date"), "the season"
        _check_columns(table.columns, name)
        _check_units(season.attrs.get("units", {}))
    if snow_from != AUTO:
        raise InputError(f"{name}: its snow is that of its column snowfall_m, not {snow_from}")
    written = table.rows
    clock = standard_clock(
        [_date(row.cells["date"], f"{row.where}, column date") for row in written],
        lambda number: (
            f"{written[number].where}, column date: {quoted(written[number].cells['date'])}"
        ),
        written[0].place if written else "",
    )
    rows = [_weather(row, date) for row, date in zip(written, clock.times)]
    check_rows(rows, table.rows, name)
    return SeasonRecord(rows, [*clock.notes, *_notes_on_rows(rows)])


def _notes_on_rows(rows: Sequence[Weather]) -> list[str]:
    """Return the notes on a table or on rows that no station's file gave."""
    return [*gap_notes(rows), *unusual_numbers(rows), *warm_snow(rows)]


def weather_files(season: Season) -> list[Path]:
    """Return the weather files of a season; none if it is a table or rows."""
    if isinstance(season, (str, os.PathLike)):
        return [Path(season)]
    if isinstance(season, Sequence):
        return [Path(path) for path in season if isinstance(path, (str, os.PathLike))]
    return []


def input_files(season: Season, temperature: Optional[PathLike]) -> list[str]:
    """Return the paths of all files of a season: of the weather, and of the temperatures."""
    files = [*weather_files(season), *([] if temperature is None else [Path(temperature)])]
    return list(map(str, files))


def _station_record(station: Station, source: str, snow_from: str) -> SeasonRecord:
    record = record_of(station, source, CHOICES.get(snow_from))
    table_rows = [TableRow(source, f"line {row.line}", row.line, {}) for row in record.rows]
    notes = [f"the weather is of a file in the format {station.format}", *record.notes]
    check_rows(record.rows, table_rows, source, snowless=True)
    if not any(row.snowfall for row in record.rows):
        notes.append(f"{NO_SNOW} in this file")
    return replace(record, notes=[*notes, *warm_snow(record.rows)])


def _check_columns(names: Sequence[str], where: str) -> None:
    for name in names:
        if name not in ALLOWED:
            raise InputError(
                f"{where}: unknown column {quoted(name)}; allowed: {', '.join(ALLOWED)}"
            )
    required = ("date", *(name for name, column in COLUMNS.items() if column.required))
    for name in required:
        if name not in names:
            raise InputError(f"{where}: no column {name!r}; needed: {', '.join(required)}")


def _check_units(units: Mapping[str, str]) -> None:
    for name, column in COLUMNS.items():
        unit = units.get(name, column.unit)
        if unit not in (column.unit, *SAME_UNITS.get(column.unit, ())):
            raise InputError(
                f"the season, column {name}: its units are {unit!r}; convert it to "
                f"{column.unit or 'a plain number'}"
            )


def _weather(row: TableRow, date: datetime) -> Weather:
    number = {
        name: _number(row.cells.get(name, ""), column, f"{row.where}, column {name}")
        for name, column in COLUMNS.items()
    }
    return Weather(
        row.number,
        date,
        number["snowfall_m"] or 0.0,
        number["density_kg_m3"],
        number["temperature_c"] or 0.0,
        number["friction"],
        number["adhesion_pa"],
        number["snow_depth_m"],
        irradiance=number["irradiance_w_m2"],
    )


def _number(text: str, column: MeasuredColumn, where: str) -> Optional[float]:
    if not text:
        if column.filled:
            raise InputError(f"{where}: empty; give a number ({column.range_text})")
        return None
    value = number_in(text)
    if math.isnan(value):
        raise InputError(f"{where}: {quoted(text)} is not a number ({column.range_text})")
    column.check(value, where)
    return value


def _date(text: str, where: str) -> datetime:
    """Read a date or a time, which keeps its offset from universal time."""
    try:
        return iso_time(text)
    except ValueError:
        raise InputError(
            f"{where}: {quoted(text)} is not a date such as 2024-12-31 or 2024-12-31T18:00"
        ) from None
