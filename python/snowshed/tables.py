"""Tables that grow row by row and are whole on disk after every row."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from snowshed.atomic import write_text


class Table:
    """A CSV file with a column `event`; it is rewritten atomically whenever rows are added.

    Parameters
    ----------
    path
        The file. Rows already in it are kept.
    columns
        Column names; taken from the first row if empty.

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
            with path.open(newline="", encoding="utf-8") as file:
                self.rows = list(csv.DictReader(file))
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
        return math.fsum(float(row[column]) for row in self.rows)

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
