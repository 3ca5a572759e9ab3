"""CSV tables: tables that grow row by row, hand-written tables, and any others.

All follow the same rules: UTF-8, a unique name for each column, and a cell for each in every row.
"""

from __future__ import annotations

import csv
import hashlib
import io
import itertools
import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from snowshed._core import InputError
from snowshed.base.field_type import shown
from snowshed.base.formatting import number_in
from snowshed.base.limits import (
    MAX_COLUMNS,
    MAX_LINE_BYTES,
    MAX_ROWS,
    MAX_TABLE_BYTES,
    MAX_TEXT_BYTES,
    MAX_WRITTEN_ROWS,
    MB,
)
from snowshed.base.messages import csv_cell, quoted
from snowshed.base.paths import PathLike
from snowshed.io.atomic import write_text
from snowshed.io.input_file import is_utf16, read_input
from snowshed.io.packed import unpacked

if TYPE_CHECKING:
    import pandas as pd

WHOLE = re.compile("[0-9]{1,9}")
#: Separators that programs write in place of commas.
OTHER_SEPARATORS = {";": "semicolons", "\t": "tabs", "|": "bars"}
LINES = re.compile(r"[^\r\n]*(?:\r\n|\r|\n)|[^\r\n]+")  # lines with their line ends


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
        If the file is not such a table.

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
        self._written: list[str] = []  # the columns in the file
        if path.exists():
            self.rows = self._read()
        self.columns = self.columns or self._written

    def add(self, rows: Iterable[Mapping[str, Any]]) -> None:
        """Add rows and write the file."""
        for row in rows:
            self.columns = self.columns or list(row)
            self.rows.append({name: _cell(row[name]) for name in self.columns})
        self._write()

    def keep_through(self, event: int) -> None:
        """Drop the rows of later events."""
        rows = [row for row in self.rows if int(row["event"]) <= event]
        if len(rows) < len(self.rows):
            self.rows = rows
            self._write()

    def fill_columns(self) -> None:
        """Write columns that are missing in the file, which an earlier version may have written."""
        if self._written and self._written != self.columns:
            self._write()

    def total(self, column: str) -> float:
        """Return the sum of a column."""
        try:
            total = math.fsum(number_in(row[column]) for row in self.rows)
        except (KeyError, OverflowError):
            total = math.nan
        if not math.isfinite(total):
            raise self._damaged(f"no numbers in the column {column}")
        return total

    def _read(self) -> list[dict[str, str]]:
        records = _records(self.path, _read_table_text(self.path, MAX_TABLE_BYTES))
        _, names = next(records, (0, []))
        self._written = names
        rows = [dict(zip(names, cells)) for _, cells in records]
        for row in rows:
            if self.columns and not set(row) <= set(self.columns):
                raise self._damaged(f"its columns are not {', '.join(self.columns)}")
            if not WHOLE.fullmatch(row.get("event", "")):
                raise self._damaged("a row without the number of its event")
        return rows

    def _damaged(self, what: str) -> InputError:
        return InputError(f"{self.path}: damaged: {what}")

    def checksum(self, event: int) -> str:
        """Return a checksum of the rows through an event, with the names of their columns."""
        rows = [row for row in self.rows if int(row["event"]) <= event]
        return hashlib.blake2b(self._csv_text(rows).encode(), digest_size=16).hexdigest()

    def _write(self) -> None:
        write_text(self.path, self._csv_text(self.rows))
        self._written = self.columns

    def _csv_text(self, rows: Iterable[Mapping[str, str]]) -> str:
        text = io.StringIO()
        writer = csv.DictWriter(text, self.columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
        return text.getvalue()


def _cell(value: Any) -> str:
    """Format a value with nine significant digits; NaN is an empty cell."""
    if isinstance(value, float):
        return "" if math.isnan(value) else f"{value:.9g}"
    return str(value)


@dataclass(frozen=True)
class TableRow:
    """A row of a table of texts.

    Attributes
    ----------
    table, place
        Position for messages: the table, and the line or row.
    number
        Line, or else row, from 1.
    cells
        Texts by the names of their columns.
    """

    table: str
    place: str
    number: int
    cells: Mapping[str, str]

    @property
    def where(self) -> str:
        """Name of the table with its line."""
        return f"{self.table}, {self.place}"


@dataclass(frozen=True)
class TextTable:
    """A table of texts, as people write them.

    Attributes
    ----------
    columns
        Names of the columns.
    rows
        The rows below the head.
    """

    columns: Sequence[str]
    rows: Sequence[TableRow]


def read_text_table(
    path: Path, hint: str, check_columns: Callable[[Sequence[str], str], None]
) -> TextTable:
    """Return a hand-written CSV table of texts, without its comments (#) and empty lines.

    Parameters
    ----------
    path
        The file, packed with gzip or xz or not.
    hint
        Advice for an empty file, for the message.
    check_columns
        Called with the names and their position before any row is read; raises InputError for
        unsuitable names.

    Raises
    ------
    InputError
        As for `read_csv`; the message names the line.
    OSError
        If it cannot be read.
    """
    records = _records(
        path, _read_table_text(path, MAX_TEXT_BYTES), comment="#", most=MAX_WRITTEN_ROWS
    )
    head = next(records, None)
    if head is None:
        raise InputError(f"{path}: empty; {hint}")
    line, columns = head
    check_columns(columns, f"{path}, line {line}")
    rows = [TableRow(str(path), f"line {n}", n, dict(zip(columns, cells))) for n, cells in records]
    return TextTable(columns, rows)


def csv_text(table: pd.DataFrame, **options: Any) -> str:
    """Return a table as CSV without its index; its texts are safe in a spreadsheet.

    Parameters
    ----------
    table
        Any table.
    **options
        As for `pandas.DataFrame.to_csv`.

    Examples
    --------
    >>> import pandas as pd
    >>> csv_text(pd.DataFrame({"name": ["=A1", "b"], "x": [-1.0, 2.0]})).split()
    ['name,x', "'=A1,-1.0", 'b,2.0']
    """
    text_columns = [i for i, kind in enumerate(table.dtypes) if kind.kind not in "biufcmM"]
    safe = table.rename(columns=csv_cell)
    for i in text_columns:
        safe = safe.assign(**{str(safe.columns[i]): table.iloc[:, i].map(csv_cell)})
    return str(safe.to_csv(index=False, lineterminator="\n", **options))


def write_csv(table: pd.DataFrame, path: PathLike, **options: Any) -> None:
    """Write a table as a CSV file, as `csv_text` returns it, atomically.

    Examples
    --------
    >>> import pandas as pd
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     write_csv(pd.DataFrame({"name": ["@b"], "x": [0.25]}), Path(folder) / "a.csv")
    ...     (Path(folder) / "a.csv").read_text().split()
    ['name,x', "'@b,0.25"]
    """
    write_text(path, csv_text(table, **options))


def frame_as_text(table: pd.DataFrame, name: str, *, index: str = "") -> TextTable:
    """Return a DataFrame as the table of texts that its CSV file would be.

    Parameters
    ----------
    table
        Any DataFrame; a missing value becomes an empty text, numbers keep their value.
    name
        Name of the table in messages.
    index
        The column for the index, if the table has no column of this name; empty: the index does
        not count.

    Raises
    ------
    InputError
        If it is no DataFrame, its index has several levels, or a column occurs twice.
    """
    if not hasattr(table, "itertuples"):
        raise InputError(f"{name}: {shown(table)}; needed: a DataFrame")
    if index and table.index.nlevels > 1:
        raise InputError(f"{name}: its index has {table.index.nlevels} levels; needed: one")
    if index and index not in table:
        table = table.rename_axis(index).reset_index()
    columns = [str(column) for column in table]
    twice = next((column for column in columns if columns.count(column) > 1), None)
    if twice is not None:
        raise InputError(f"{name}: the column {twice!r} occurs twice")
    rows = [
        TableRow(name, f"row {number}", number, dict(zip(columns, map(_cell_text, cells))))
        for number, cells in enumerate(table.itertuples(index=False, name=None), 1)
    ]
    return TextTable(columns, rows)


def _cell_text(value: object) -> str:
    """Return a cell of a DataFrame as text; a number is the same when it is read."""
    import pandas as pd

    if value is None or value is pd.NaT or value is pd.NA or value != value:
        return ""
    return value.isoformat() if hasattr(value, "isoformat") else str(value)


def read_csv(path: Path, *, as_text: bool = False) -> pd.DataFrame:
    """Return a table from a CSV file that may hold anything.

    Parameters
    ----------
    path
        The file.
    as_text
        Whether every cell is text; else cells with numbers become numbers.

    Raises
    ------
    InputError
        If it is not a table in UTF-8, names of columns are missing or repeated, there are too many,
        or a row has too few or too many cells.
    OSError
        If it cannot be read.
    """
    return parse_csv(_read_table_text(path, MAX_TABLE_BYTES), path, as_text=as_text)


def parse_csv(text: str, where: Path | str, *, as_text: bool = False) -> pd.DataFrame:
    """Return a table from the text of a CSV file; see `read_csv`. Errors name `where`."""
    import pandas as pd

    for _ in _records(where, text):
        pass
    options: dict[str, Any] = {"dtype": str, "keep_default_na": False} if as_text else {}
    try:  # bytes, because a StringIO takes four bytes for each character
        table: pd.DataFrame = pd.read_csv(io.BytesIO(text.encode()), **options)
    except ValueError as error:  # all errors of pandas on content are ValueErrors
        raise InputError(f"{where}: not a table: {error}") from None
    return table


def _read_table_text(path: Path, largest: int) -> str:
    content = unpacked(read_input(path, largest), path, largest)
    if is_utf16(content):
        raise InputError(f"{path}: not a table: text in UTF-16; save it in UTF-8")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        raise InputError(f"{path}, line {line}: not a table: not UTF-8 text") from None
    if b"\0" in content:
        line = content[: content.index(b"\0")].count(b"\n") + 1
        raise InputError(f"{path}, line {line}: not a table: it contains NUL bytes")
    return text


def _records(
    path: Path | str, text: str, comment: str = "", most: int = MAX_ROWS
) -> Iterator[tuple[int, list[str]]]:
    """Yield the first line and the cells of each record, all of the same length."""
    pulled: list[int] = []
    reader = csv.reader(_content_lines(path, text, comment, pulled), strict=True)
    names: list[str] = []
    for count in itertools.count():
        if count > most + 1:
            raise InputError(f"{path}: not a table: more than {most} rows")
        pulled.clear()
        try:
            cells = [cell.strip() for cell in next(reader)]
        except StopIteration:
            return
        except csv.Error as error:
            raise InputError(f"{path}, line {pulled[0]}: not a table: {error}") from None
        if not cells:
            continue
        if not names:
            _check_names(cells, f"{path}, line {pulled[0]}")
            names = cells
        elif len(cells) != len(names):
            raise InputError(
                f"{path}, line {pulled[0]}: not a table: {len(cells)} cells in {len(names)} columns"
            )
        yield pulled[0], cells


def _content_lines(path: Path | str, text: str, comment: str, pulled: list[int]) -> Iterator[str]:
    """Yield the lines that are neither empty nor comments, noting their numbers in `pulled`."""
    length = 0
    for number, match in enumerate(LINES.finditer(text), 1):
        start, end = match.span()
        length = end - start if not pulled else length + end - start
        if length > MAX_LINE_BYTES:  # checked before cells are made
            raise InputError(
                f"{path}, line {number}: not a table: a row longer than {MAX_LINE_BYTES // MB} MB"
            )
        line = match.group()
        if comment and (not line.strip() or line.lstrip().startswith(comment)):
            continue
        pulled.append(number)
        yield line


def _check_names(names: Sequence[str], where: str) -> None:
    if len(names) > MAX_COLUMNS:
        raise InputError(
            f"{where}: not a table: {len(names)} columns; at most {MAX_COLUMNS} are allowed"
        )
    other = next((word for mark, word in OTHER_SEPARATORS.items() if mark in names[0]), None)
    if len(names) == 1 and other is not None:
        raise InputError(
            f"{where}: its cells are separated by {other}; separate them by commas, and write "
            "numbers with a decimal point"
        )
    for number, name in enumerate(names):  # at most MAX_COLUMNS names
        if name in names[:number]:
            raise InputError(f"{where}: not a table: the column {quoted(name)} occurs twice")
