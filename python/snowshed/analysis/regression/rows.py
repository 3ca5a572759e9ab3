"""Rows for a regression: checked inputs and targets from a study's table."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Optional

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.regression.unusual_rows import (
    check_inputs,
    note_on_ignored_columns,
    note_on_unusual_stacks,
)
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats, Integers, number_array
from snowshed.base.notes import InputNote, issue_note
from snowshed.base.paths import PathLike
from snowshed.snow.stack.quantities import Measure, measure_named
from snowshed.study.factors import SEED
from snowshed.study.stack_table import StackTable

#: The inputs of section 5.2.2 with the tilt of section 5.1.3; columns of a study's table.
INPUTS = ("event", "panel.height", "panel.length", "panel.tilt")
#: Targets, and their units.
TARGETS: Mapping[str, str] = {"ratio": "", "height": "m", "length": "m"}
#: Columns of a stack that are regressed.
STACK = ("height", "length")
PATH = re.compile(r"[a-z]\w{0,60}(\.\w{1,60}){1,6}", re.ASCII)
#: Kernel matrices grow with the square of the rows, the time to fit with their cube.
MIN_ROWS, MAX_ROWS = 20, 5000


@dataclass(frozen=True)
class StackRows:
    """Inputs and targets, one row per panel and event.

    Attributes
    ----------
    inputs
        Shape (n, k): the columns of `names`, in SI units, angles in degrees.
    stacks
        For each name of `TARGETS` an array of shape (n, m): ratio of stack height to length, stack
        height in m, stack length in m, of up to m stacks that differ in their seeds only; NaN where
        a row has fewer.
    left_out
        Number of rows of the table without a stack: the run failed, or the snow stayed on the
        panel.
    moving
        Number of stacks that were still moving at the time limit of their event.
    settings
        Parameters and settings that all rows have in common, by their columns, as text.
    names
        Names of the inputs: "event", and parameters of the scene by their paths.
    """

    inputs: Floats
    stacks: Mapping[str, Floats]
    left_out: int = 0
    moving: int = 0
    settings: Mapping[str, str] = field(default_factory=dict)
    names: Sequence[str] = INPUTS

    @property
    def targets(self) -> Mapping[str, Floats]:
        """Values of each name of `TARGETS`, shape (n,).

        The mean stack: mean height, mean length, and the ratio of these. A mean of ratios would be
        dominated by the few stacks that are short by chance.
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

    @property
    def most_seeds(self) -> int:
        """Largest number of stacks of a row."""
        return int(np.isfinite(self.stacks["ratio"]).sum(axis=1).max(initial=0))

    def of_one_seed(self) -> StackRows:
        """Return the rows with only the first stack of each, as in the thesis.

        Examples
        --------
        >>> rows = stack_rows([[1, 2, 4, 40]] * 2, np.array([1.0, 3.0]), np.array([4.0, 4.0]))
        >>> rows.targets["height"].tolist(), rows.of_one_seed().targets["height"].tolist()
        ([2.0], [1.0])
        """
        stacks = {name: values[:, :1] for name, values in self.stacks.items()}
        return replace(self, stacks=stacks)

    def __len__(self) -> int:
        return len(self.inputs)

    @property
    def panels(self) -> Integers:
        """Panel of each row, counted from 0: shape (n,)."""
        _, which = np.unique(self.inputs[:, 1:], axis=0, return_inverse=True)
        return np.asarray(which, dtype=np.int64).reshape(-1)

    @property
    def panel_count(self) -> int:
        """Number of panels."""
        return int(self.panels.max()) + 1

    @property
    def digest(self) -> str:
        """Hash of the inputs and the stacks."""
        content = hashlib.sha256(np.ascontiguousarray(self.inputs).tobytes())
        if tuple(self.names) != INPUTS:
            content.update(repr(tuple(self.names)).encode())
        for name in TARGETS:
            content.update(np.ascontiguousarray(self.stacks[name]).tobytes())
        return content.hexdigest()[:32]


def is_input(name: object) -> bool:
    """Return whether a name may be that of an input: a path in a scene, but not its seed.

    Examples
    --------
    >>> [is_input(name) for name in ("snow.cohesion", "slab.layers.0.thickness", "height", SEED)]
    [True, True, False, False]
    """
    return isinstance(name, str) and PATH.fullmatch(name) is not None and name != SEED


@checked
def read_rows(
    file: PathLike,
    measure: str = "stack",
    where: Optional[Mapping[str, str]] = None,
    inputs: Sequence[str] = INPUTS[1:],
) -> StackRows:
    """Read the rows to regress from a table that ``snowshed study export`` wrote.

    Parameters
    ----------
    file
        A CSV file, or a Parquet file (.parquet); or the folder of a study's store.
    measure
        One of `snowshed.snow.stack.quantities.MEASURES`. "stack": height and length of 97 % of the
        snow, as the thesis measures, by the trimming rule that the table names; "body": of the
        largest connected body; "outermost_first" or "equal_pace": as "stack", by that rule.
    where
        Columns and the value they must have: only these rows are read.
    inputs
        Inputs besides the event: any parameters of the scene that the study varied.

    Raises
    ------
    InputError
        If columns are missing, a cell is not a positive number, the rows differ in something that
        is not an input, or there are too few. It names file, column and line.
    """
    columns = measure_named(measure)
    names = _input_names(inputs)
    table = StackTable.read(file)
    try:
        return _rows(table.chosen(where or {}), columns, names)
    except InputError as error:
        raise InputError(f"{file}: {error}") from None


@checked
def stack_rows(inputs: Floats, height: Floats, length: Floats) -> StackRows:
    """Return rows from arrays; stacks with the same inputs make one row.

    Parameters
    ----------
    inputs
        Shape (n, 4), the columns of `INPUTS`.
    height, length
        Height and length of the stack, shape (n,), m.

    Raises
    ------
    InputError
        If the arrays have different lengths, or a height or length is not a positive number.

    Examples
    --------
    >>> inputs = np.array([[1, 2, 4, 40], [2, 2, 4, 40], [2, 2, 4, 40]])
    >>> rows = stack_rows(inputs, np.array([1, 2, 3]), np.array([4, 5, 5]))
    >>> rows.targets["ratio"].tolist(), rows.panels.tolist()
    ([0.25, 0.5], [0, 0])
    """
    import pandas as pd

    inputs = number_array("inputs", inputs)
    height, length = number_array("height", height), number_array("length", length)
    _check_arrays(inputs, height, length)
    alike = pd.DataFrame(inputs).groupby(list(range(inputs.shape[1])), sort=False)
    row, repetition = alike.ngroup().to_numpy(), alike.cumcount().to_numpy()
    first = repetition == 0

    def arranged(values: Floats) -> Floats:
        stacks = np.full((int(first.sum()), int(repetition.max(initial=0)) + 1), np.nan)
        stacks[row, repetition] = values
        return stacks

    measured = {"ratio": height / length, "height": height, "length": length}
    return StackRows(inputs[first], {name: arranged(values) for name, values in measured.items()})


def _check_arrays(inputs: Floats, height: Floats, length: Floats) -> None:
    """Refuse arrays of different lengths, and stacks that are no stacks."""
    if inputs.ndim != 2:
        raise InputError(f"inputs: {inputs.ndim} dimensions; needed: 2, a row for each stack")
    for name, values in (("height", height), ("length", length)):
        if values.shape != (len(inputs),):
            raise InputError(f"{name}: shape {values.shape}; needed: ({len(inputs)},), as inputs")
        wrong = ~(np.isfinite(values) & (values > 0))
        if wrong.any():
            row = int(np.argmax(wrong))
            raise InputError(f"{name}[{row}]: {values[row]:g} m; needed: a positive number")


def _input_names(inputs: Sequence[str]) -> tuple[str, ...]:
    """Return the names of all inputs, the event first."""
    for name in inputs:
        if not is_input(name):
            raise InputError(
                f"input: {name!r} is not a parameter of a scene, such as {', '.join(INPUTS[1:])}"
            )
    if not inputs or len(set(inputs)) < len(inputs):
        raise InputError(f"inputs: {', '.join(inputs) or 'none'}; needed: one or more, each once")
    return (INPUTS[0], *inputs)


def _rows(table: StackTable, measure: Measure, names: Sequence[str]) -> StackRows:
    table.check_columns([*names, *measure.columns(STACK)])
    nothing = table.without_stack(measure, STACK)
    left_out = int(nothing.sum())
    frame = table.frame.loc[~nothing]
    if measure.trimming is not None and "trimming" in frame:
        frame = frame.assign(trimming=measure.trimming)
    table = replace(table, frame=frame)
    _check_enough(len(table.frame), left_out)
    settings = table.common_settings(names)
    inputs = np.column_stack([table.numbers(name) for name in names])
    height, length = (table.numbers(measure.column(quantity), positive=True) for quantity in STACK)
    events = inputs[:, 0]
    _check_seeds(table, inputs)
    table.refuse(INPUTS[0], (events < 1) | (events % 1 != 0), "a whole number, 1 or more")
    check_inputs(table, names[1:])
    note_on_unusual_stacks(table, inputs, height, length)
    note_on_ignored_columns(table)
    selected = stack_rows(inputs, height, length)
    _check_enough(len(selected), left_out)
    if len(selected) > MAX_ROWS:
        raise InputError(f"{len(selected)} rows; at most {MAX_ROWS} are allowed")
    frame = table.frame
    moving = int((frame["ended"] == "time_limit").sum()) if "ended" in frame else 0
    if left_out:
        rows = (
            "1 row has no stack and is"
            if left_out == 1
            else f"{left_out} rows have no stack and are"
        )
        issue_note(f"{rows} left out", InputNote)
    if moving:
        stacks = "1 stack was" if moving == 1 else f"{moving} stacks were"
        issue_note(f"{stacks} still moving at the time limit", InputNote)
    return replace(
        selected, left_out=left_out, moving=moving, settings=settings, names=tuple(names)
    )


def _check_enough(rows: int, left_out: int) -> None:
    if rows < MIN_ROWS:
        lost = f" (and {left_out} without a stack)" if left_out else ""
        raise InputError(f"{rows} rows{lost}; at least {MIN_ROWS} are needed")


def _check_seeds(table: StackTable, inputs: Floats) -> None:
    """Refuse stacks with the same inputs that are not known to differ in their seeds."""
    import pandas as pd

    frame = table.frame
    seeds = frame["seed"].to_numpy() if "seed" in frame else np.full(len(frame), "")
    stacks = pd.DataFrame(inputs)
    unknown = pd.isna(seeds) | (seeds.astype(str) == "")
    if unknown.any():  # any of these may be the seed of any other stack
        seeds = np.where(stacks.duplicated(keep=False) & unknown.any(), "", seeds)
    stacks = stacks.assign(seed=seeds)
    again = stacks.duplicated()
    if again.any():
        row = int(again.argmax())
        first = int((stacks == stacks.iloc[row]).all(axis=1).argmax())
        raise InputError(
            f"lines {table.line(first)} and {table.line(row)}: the same panel, event and seed "
            "twice" + (" (some rows have no seed)" if unknown.any() else "")
        )
