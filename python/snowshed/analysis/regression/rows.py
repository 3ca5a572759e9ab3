"""The rows that are regressed: inputs and targets out of a study's table, checked."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.io.arrays import Booleans, Floats, Integers
from snowshed.io.csv_table import read_csv
from snowshed.io.extras import require
from snowshed.io.messages import shortened
from snowshed.scene.accuracy_settings import ACCURACY, FORMER_NAMES
from snowshed.scene.scene import PathLike

if TYPE_CHECKING:
    import pandas as pd

#: The inputs of section 5.2.2 with the tilt of section 5.1.3; columns of a study's table.
INPUTS = ("event", "panel.height", "panel.length", "panel.tilt")
#: What messages call the inputs, and their units.
INPUT_WORDS = ("event", "panel height", "panel length", "panel tilt")
INPUT_UNITS = ("", "m", "m", "degrees")
#: What can be predicted, and its unit.
TARGETS: Mapping[str, str] = {"ratio": "", "height": "m", "length": "m"}
#: Columns of height and length, by what counts as the stack.
MEASURES: Mapping[str, tuple[str, str]] = {
    "stack": ("height_m", "length_m"),
    "body": ("body_height_m", "body_length_m"),
}
#: Columns that make two rows the result of different physics or methods where they differ.
SETTINGS = ("version", "dimension", *ACCURACY)
#: Kernel matrices grow with the square of the rows, the time to fit with their cube.
FEWEST_ROWS, MOST_ROWS = 20, 5000
LARGEST_TABLE = 1_000_000  # rows of a Parquet file, which packs them well


@dataclass(frozen=True)
class StackRows:
    """Inputs and targets, one row per panel and event.

    Attributes
    ----------
    inputs
        Shape (n, 4): the columns of `INPUTS`, heights and lengths in m, tilts in degrees.
    stacks
        For each name of `TARGETS` an array of shape (n, m): ratio of stack height to length, stack
        height in m, stack length in m, of up to m stacks that differ in their seeds only; NaN where
        a row has fewer.
    left_out
        How many rows of the table had no stack: the run failed, or the snow stayed on the panel.
    moving
        How many stacks were not at rest when the time of their event was over.
    settings
        Parameters and settings that all rows have in common, by their columns, as text.
    """

    inputs: Floats
    stacks: Mapping[str, Floats]
    left_out: int = 0
    moving: int = 0
    settings: Mapping[str, str] = field(default_factory=dict)

    @property
    def targets(self) -> Mapping[str, Floats]:
        """For each name of `TARGETS` what is regressed, shape (n,).

        The mean stack: mean height, mean length, and the ratio of these. A mean of ratios would be
        led by the few stacks that by chance are short.
        """
        height, length = (np.nanmean(self.stacks[name], axis=1) for name in ("height", "length"))
        return {"ratio": height / length, "height": height, "length": length}

    def scatter(self, target: str) -> float:
        """Return the mean absolute deviation of a single stack from the mean of very many.

        NaN if no row has several stacks.
        """
        values = self.stacks[target]
        count = np.isfinite(values).sum(axis=1)
        repeated = count > 1
        if not repeated.any():
            return float("nan")
        count, values = count[repeated], values[repeated]
        deviations = np.nanmean(np.abs(values - np.nanmean(values, axis=1)[:, None]), axis=1)
        return float((deviations * np.sqrt(count / (count - 1))).mean())

    def __len__(self) -> int:
        return len(self.inputs)

    @property
    def panels(self) -> Integers:
        """Which panel each row belongs to, counted from 0: shape (n,)."""
        _, which = np.unique(self.inputs[:, 1:], axis=0, return_inverse=True)
        return np.asarray(which, dtype=np.int64).reshape(-1)

    @property
    def panel_count(self) -> int:
        """How many panels there are."""
        return int(self.panels.max()) + 1

    @property
    def digest(self) -> str:
        """What tells these rows from any others."""
        content = hashlib.sha256(np.ascontiguousarray(self.inputs).tobytes())
        for name in TARGETS:
            content.update(np.ascontiguousarray(self.stacks[name]).tobytes())
        return content.hexdigest()[:32]


def read_rows(
    file: PathLike,
    measure: str = "stack",
    where: Optional[Mapping[str, str]] = None,
) -> StackRows:
    """Read the rows to regress from a table that ``snowshed study export`` wrote.

    Parameters
    ----------
    file
        A CSV file, or a Parquet file (.parquet).
    measure
        "stack": height and length of 97 % of the snow, as the thesis measures; "body": of the
        largest connected body.
    where
        Columns and the value they must have: only these rows are read.

    Raises
    ------
    InputError
        If columns are missing, a cell is not a positive number, the rows differ in something that
        is not an input, or there are too few. It names file, column and line.
    """
    if measure not in MEASURES:
        raise InputError(f"measure: {measure!r} is unknown; allowed: {', '.join(MEASURES)}")
    path = Path(file)
    table = _read(path).rename(columns=FORMER_NAMES)
    try:
        return _rows(_chosen(table, where or {}), MEASURES[measure])
    except InputError as error:
        raise InputError(f"{path}: {error}") from None


def rows_of(inputs: Floats, height: Floats, length: Floats) -> StackRows:
    """Return rows from arrays; stacks with the same inputs make one row.

    Parameters
    ----------
    inputs
        Shape (n, 4), the columns of `INPUTS`.
    height, length
        Of the stack, shape (n,), m.

    Examples
    --------
    >>> inputs = np.array([[1, 2, 4, 40], [2, 2, 4, 40], [2, 2, 4, 40]])
    >>> rows = rows_of(inputs, np.array([1, 2, 3]), np.array([4, 5, 5]))
    >>> rows.targets["ratio"].tolist(), rows.panels.tolist()
    ([0.25, 0.5], [0, 0])
    """
    import pandas as pd

    inputs = np.asarray(inputs, float)
    height, length = np.asarray(height, float), np.asarray(length, float)
    alike = pd.DataFrame(inputs).groupby(list(range(inputs.shape[1])), sort=False)
    row, repetition = alike.ngroup().to_numpy(), alike.cumcount().to_numpy()
    first = repetition == 0

    def arranged(values: Floats) -> Floats:
        stacks = np.full((int(first.sum()), int(repetition.max(initial=0)) + 1), np.nan)
        stacks[row, repetition] = values
        return stacks

    measured = {"ratio": height / length, "height": height, "length": length}
    return StackRows(inputs[first], {name: arranged(values) for name, values in measured.items()})


def _read(path: Path) -> pd.DataFrame:
    import pandas as pd

    try:
        if path.suffix != ".parquet":
            return read_csv(path, as_text=True)
        parquet = require("pyarrow.parquet", "study", "reading Parquet")
        count = parquet.read_metadata(path).num_rows
        if count > LARGEST_TABLE:
            raise InputError(f"{path}: {count} rows; at most {LARGEST_TABLE} are allowed")
        return pd.read_parquet(path)
    except InputError:
        raise
    except OSError as error:
        raise InputError(f"{path}: {error.strerror or error}") from None
    except ValueError as error:
        raise InputError(f"{path}: not a table: {error}") from None


def _chosen(table: pd.DataFrame, where: Mapping[str, str]) -> pd.DataFrame:
    """Return the rows that `where` asks for."""
    for given, value in where.items():
        column = FORMER_NAMES.get(given, given)
        if column not in table:
            raise InputError(f"{column}: no such column; the table has {_names(table)}")
        cells = table[column].astype(str)
        if not (cells == value).any():
            there = ", ".join(sorted(set(cells))[:8])
            raise InputError(f"{column}: no row has the value {value}; there are: {there}")
        table = table.loc[cells == value]
    return table


def _rows(table: pd.DataFrame, measures: tuple[str, str]) -> StackRows:
    import pandas as pd

    _check_columns(table, (*INPUTS, *measures))
    cells = table[list(measures)]
    # A failed run has no measures; where all snow stayed on the panel there is no stack.
    nothing = cells.isna() | (cells.astype(str) == "")
    nothing |= cells.apply(pd.to_numeric, errors="coerce") == 0
    measured = ~nothing.any(axis=1)
    left_out = int((~measured).sum())
    table = table.loc[measured]
    _check_enough(len(table), left_out)
    settings = _common(table)
    inputs = np.column_stack([_numbers(table, name) for name in INPUTS])
    height, length = (_numbers(table, name, positive=True) for name in measures)
    events = inputs[:, 0]
    _check_seeds(table, inputs)
    _complain(table, INPUTS[0], (events < 1) | (events % 1 != 0), "a whole number, 1 or more")
    found = rows_of(inputs, height, length)
    _check_enough(len(found), left_out)
    if len(found) > MOST_ROWS:
        raise InputError(f"{len(found)} rows; at most {MOST_ROWS} are allowed")
    moving = int((table["ended"] == "time_limit").sum()) if "ended" in table else 0
    return replace(found, left_out=left_out, moving=moving, settings=settings)


def _check_enough(rows: int, left_out: int) -> None:
    if rows < FEWEST_ROWS:
        lost = f" (and {left_out} without a stack)" if left_out else ""
        raise InputError(f"{rows} rows{lost}; at least {FEWEST_ROWS} are needed")


def _check_columns(table: pd.DataFrame, needed: Sequence[str]) -> None:
    missing = [name for name in needed if name not in table]
    if missing:
        hint = (
            "; a study's table has a column for each parameter in its axes, also with a single "
            "value: axes.panel.tilt = 40"
            if any(name.startswith("panel.") for name in missing)
            else ""
        )
        raise InputError(f"no column {', '.join(missing)}; it has {_names(table)}{hint}")


def _names(table: pd.DataFrame) -> str:
    return shortened(", ".join(map(str, table)), 300)


def _common(table: pd.DataFrame) -> dict[str, str]:
    """Return what all rows have in common; refuse rows that differ in what is not an input."""
    common = {}
    for name in map(str, table):
        parameter = "." in name and name not in INPUTS and name != "seeding.seed"
        if not (parameter or name in SETTINGS):
            continue
        values = sorted(set(table[name].astype(str)))
        if len(values) > 1:
            raise InputError(
                f"{name}: the rows have different values ({', '.join(values[:6])}), and it is "
                f"not an input; choose some with --where {name}={values[0]}"
            )
        common[name] = values[0]
    return common


def _check_seeds(table: pd.DataFrame, inputs: Floats) -> None:
    """Refuse stacks with the same inputs that are not known to differ in their seeds."""
    import pandas as pd

    stacks = pd.DataFrame(inputs).assign(seed=table["seed"].to_numpy() if "seed" in table else "")
    again = stacks.duplicated()
    if again.any():
        row = int(again.argmax())
        first = int((stacks == stacks.iloc[row]).all(axis=1).argmax())
        raise InputError(
            f"lines {_line(table, first)} and {_line(table, row)}: the same panel, event and seed "
            "twice"
        )


def _numbers(table: pd.DataFrame, column: str, *, positive: bool = False) -> Floats:
    import pandas as pd

    numbers = np.asarray(pd.to_numeric(table[column], errors="coerce"), dtype=float)
    wrong = ~np.isfinite(numbers) | (numbers <= 0 if positive else False)
    _complain(table, column, wrong, "a positive number" if positive else "a number")
    return numbers


def _complain(table: pd.DataFrame, column: str, wrong: Booleans, expected: str) -> None:
    """Raise an error about the first wrong cell, with its line in the file."""
    if wrong.any():
        row = int(np.argmax(wrong))
        cell = str(table[column].iloc[row])
        raise InputError(f"line {_line(table, row)}, {column}: {cell!r} is not {expected}")


def _line(table: pd.DataFrame, row: int) -> int:
    """Return a row's line in the file: lines count from 1, and the first holds the names."""
    return int(table.index[row]) + 2
