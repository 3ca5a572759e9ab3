"""The season file: when it snowed, how much, and what snow.

A table of comma-separated values with a header. Lines that are empty or begin with ``#`` are left
out. A row may be without snowfall: it then only lets time pass, and tests the release with the
friction and adhesion of that day.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timezone
from pathlib import Path
from typing import Optional

from snowshed._core import InputError
from snowshed.io.input_file import read_input
from snowshed.io.messages import quoted
from snowshed.scene.scene import PathLike


@dataclass(frozen=True)
class Weather:
    """One row of a season file.

    Attributes
    ----------
    line
        Its line in the file, from 1.
    date
        When the snow had fallen.
    snowfall
        Depth of the new snow on level ground, m.
    density
        Density of the new snow, kg/m3; None: not measured.
    temperature
        Of the air, degrees C; it holds until the next row.
    friction, adhesion
        Of the panel on that day, the latter in Pa; None: as on any day.
    """

    line: int
    date: datetime
    snowfall: float
    density: Optional[float]
    temperature: float
    friction: Optional[float] = None
    adhesion: Optional[float] = None


@dataclass(frozen=True)
class _Column:
    """What a column may hold."""

    low: float
    high: float
    unit: str
    required: bool = False  # the column
    filled: bool = False  # every cell of it


COLUMNS: Mapping[str, _Column] = {
    "snowfall_m": _Column(0.0, 10.0, "m", required=True, filled=True),
    "temperature_c": _Column(-90.0, 40.0, "degrees C", required=True, filled=True),
    "density_kg_m3": _Column(10.0, 700.0, "kg/m3"),
    "friction": _Column(0.0, 10.0, ""),
    "adhesion_pa": _Column(0.0, 1e6, "Pa"),
}
ALLOWED = ("date", *COLUMNS)
MOST_ROWS = 20_000  # twice an hourly season


def read_season(path: PathLike) -> list[Weather]:
    r"""Read a season file.

    Parameters
    ----------
    path
        A CSV file with the columns ``date`` (ISO 8601, increasing), ``snowfall_m``,
        ``temperature_c`` and, if known, ``density_kg_m3``, ``friction`` and ``adhesion_pa``.

    Raises
    ------
    InputError
        Naming the file, the line and the column, what is wrong there and what is allowed.
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder) / "season.csv"
    ...     _ = file.write_text("date,snowfall_m,temperature_c\n2024-12-01,0.2,-4\n")
    ...     read_season(file)[0].snowfall
    0.2
    """
    path = Path(path)
    rows = _rows(path)
    first = next(rows, None)
    if first is None:
        raise InputError(f"{path}: empty; the first line names the columns: {', '.join(ALLOWED)}")
    header = _header(first[1], f"{path}, line {first[0]}")
    season = [_weather(line, cells, header, f"{path}, line {line}") for line, cells in rows]
    _check_season(season, path)
    return season


def _rows(path: Path) -> Iterator[tuple[int, list[str]]]:
    """Yield the lines that hold something, with their numbers."""
    try:
        text = read_input(path).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = error.object[: error.start].count(b"\n")
        raise InputError(f"{path}, line {before + 1}: not UTF-8 text") from None
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        try:
            cells = next(csv.reader([line], strict=True))
        except csv.Error as error:
            raise InputError(f"{path}, line {number}: not a row of a CSV file: {error}") from None
        yield number, [cell.strip() for cell in cells]


def _header(cells: Sequence[str], where: str) -> list[str]:
    for name in cells:
        if name not in ALLOWED:
            raise InputError(
                f"{where}: unknown column {quoted(name)}; allowed: {', '.join(ALLOWED)}"
            )
        if cells.count(name) > 1:
            raise InputError(f"{where}: the column {name!r} is given twice")
    required = ("date", *(name for name, column in COLUMNS.items() if column.required))
    for name in required:
        if name not in cells:
            raise InputError(f"{where}: no column {name!r}; needed: {', '.join(required)}")
    return list(cells)


def _weather(line: int, cells: Sequence[str], header: Sequence[str], where: str) -> Weather:
    if len(cells) != len(header):
        raise InputError(
            f"{where}: {len(cells)} values in {len(header)} columns ({', '.join(header)})"
        )
    row = dict(zip(header, cells))
    number = {
        name: _number(row.get(name, ""), column, f"{where}, column {name}")
        for name, column in COLUMNS.items()
    }
    return Weather(
        line,
        _date(row["date"], f"{where}, column date"),
        number["snowfall_m"] or 0.0,
        number["density_kg_m3"],
        number["temperature_c"] or 0.0,
        number["friction"],
        number["adhesion_pa"],
    )


def _number(text: str, column: _Column, where: str) -> Optional[float]:
    if not text:
        if column.filled:
            raise InputError(f"{where}: empty; give a number ({_range(column)})")
        return None
    try:
        value = float(text)
    except ValueError:
        raise InputError(f"{where}: {quoted(text)} is not a number ({_range(column)})") from None
    if not (math.isfinite(value) and column.low <= value <= column.high):
        raise InputError(f"{where}: {value:g} is outside the allowed range ({_range(column)})")
    return value


def _range(column: _Column) -> str:
    return f"{column.low:g} <= value <= {column.high:g} {column.unit}".rstrip()


def _date(text: str, where: str) -> datetime:
    """Read a date or a time; one with an offset is turned into universal time."""
    try:
        date = datetime.fromisoformat(text.replace("Z", "+00:00"))
    except ValueError:
        raise InputError(
            f"{where}: {quoted(text)} is not a date such as 2024-12-31 or 2024-12-31T18:00"
        ) from None
    return date if date.tzinfo is None else date.astimezone(timezone.utc).replace(tzinfo=None)


def _check_season(season: Sequence[Weather], path: Path) -> None:
    if not season:
        raise InputError(f"{path}: no rows below the header")
    if len(season) > MOST_ROWS:
        raise InputError(f"{path}: {len(season)} rows; at most {MOST_ROWS} are allowed")
    for earlier, later in zip(season, season[1:]):
        if later.date <= earlier.date:
            raise InputError(
                f"{path}, line {later.line}, column date: {later.date.isoformat(' ')} is not after "
                f"line {earlier.line}, {earlier.date.isoformat(' ')}"
            )
    if not any(row.snowfall for row in season):
        raise InputError(f"{path}: it never snows; every snowfall_m is 0")
