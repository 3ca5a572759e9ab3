"""Tables in CSV files: those that grow row by row, whole on disk after every row, and any other."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from snowshed._core import InputError
from snowshed.io.atomic import write_text
from snowshed.io.input_file import LARGEST_TABLE, read_input
from snowshed.io.messages import quoted

if TYPE_CHECKING:
    import pandas as pd

MOST_COLUMNS = 1000  # pandas takes minutes for a line of a hundred thousand names


class Table:
    """A CSV file with a column `event`; it is rewritten atomically whenever rows are added.

    Parameters
    ----------
    path
        The file. Rows already in it are kept.
    columns
        Column names; taken from the first row if empty.

    Raises
    ------
    InputError
        If the file is no such table.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     table = Table(Path(folder) / "t.csv", ["event", "height_m"])
    ...     table.add([{"event": 1, "height_m": 0.25}])
    ...     table.path.read_text().split()
    ['event,height_m', '1,0.25']
    """

    def __init__(self, path: Path, columns: Sequence[str] = ()) -> None:
        self.path = path
        self.columns = list(columns)
        self.rows: list[dict[str, str]] = []
        if path.exists():
            self.rows = self._read()
        if self.rows and not self.columns:
            self.columns = list(self.rows[0])

    def add(self, rows: Iterable[Mapping[str, Any]]) -> None:
        """Add rows and write the file."""
        for row in rows:
            self.columns = self.columns or list(row)
            self.rows.append({name: _cell(row[name]) for name in self.columns})
        self._write()

    def keep_through(self, event: int) -> None:
        """Drop the rows of later events."""
        kept = [row for row in self.rows if int(row["event"]) <= event]
        if len(kept) < len(self.rows):
            self.rows = kept
            self._write()

    def total(self, column: str) -> float:
        """Return the sum of a column."""
        try:
            total = math.fsum(float(row[column]) for row in self.rows)
        except (KeyError, ValueError, OverflowError):
            total = math.nan
        if not math.isfinite(total):
            raise self._damaged(f"no numbers in the column {column}")
        return total

    def _read(self) -> list[dict[str, str]]:
        try:
            with self.path.open(newline="", encoding="utf-8") as file:
                rows = list(csv.DictReader(file, strict=True))
        except (UnicodeDecodeError, csv.Error) as error:
            raise self._damaged(str(error)) from None
        for row in rows:
            if None in row or None in row.values():
                raise self._damaged(f"a row that has not {len(row)} cells")
            if self.columns and not set(row) <= set(self.columns):
                raise self._damaged(f"its columns are not {', '.join(self.columns)}")
            if not row.get("event", "").isdecimal():
                raise self._damaged("a row without the number of its event")
        return rows

    def _damaged(self, what: str) -> InputError:
        return InputError(f"{self.path}: damaged: {what}")

    def _write(self) -> None:
        text = io.StringIO()
        writer = csv.DictWriter(text, self.columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(self.rows)
        write_text(self.path, text.getvalue())


def _cell(value: Any) -> str:
    """Format a value with nine significant digits; NaN is an empty cell."""
    if isinstance(value, float):
        return "" if math.isnan(value) else f"{value:.9g}"
    return str(value)


def read_csv(path: Path, **options: Any) -> pd.DataFrame:
    """Return a table from a CSV file that may hold anything.

    Parameters
    ----------
    path
        The file.
    **options
        As of `pandas.read_csv`.

    Raises
    ------
    InputError
        If it is no table in UTF-8, a column has no name of its own, there are too many, or a row
        has not a cell for each.
    OSError
        If it cannot be read.
    """
    import pandas as pd

    content = read_input(path, LARGEST_TABLE)
    try:
        _check_rows(io.StringIO(content.decode("utf-8"), newline=""))
        table: pd.DataFrame = pd.read_csv(io.BytesIO(content), **options)
        return table
    except (ValueError, csv.Error) as error:  # of pandas all errors on content are ValueErrors
        raise InputError(f"{path}: not a table: {error}") from None


def _check_rows(file: Iterable[str]) -> None:
    rows = csv.reader(file)
    names = next(rows, [])
    _check_names(names)
    for row in rows:
        if row and len(row) != len(names):
            raise ValueError(
                f"line {rows.line_num}: {len(row)} cells, but there are {len(names)} columns"
            )


def _check_names(names: Sequence[str]) -> None:
    if len(names) > MOST_COLUMNS:
        raise ValueError(f"{len(names)} columns; at most {MOST_COLUMNS} are allowed")
    for number, name in enumerate(names):
        if name in names[:number]:
            raise ValueError(f"the column {quoted(name)} is there twice")
