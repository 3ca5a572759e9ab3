"""Rows of other people's tables: inputs and stacks in other units, copies, ignored columns."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from snowshed._core import InputError
from snowshed.base.arrays import Floats
from snowshed.base.formatting import plural
from snowshed.base.notes import InputNote, issue_note
from snowshed.scene.accuracy_settings import ACCURACY, FORMER_NAMES, NUMBERS
from snowshed.scene.scene import Scene
from snowshed.study.database import STORED_TYPES, TIMING
from snowshed.study.factors import Factor
from snowshed.study.stack_table import StackTable
from snowshed.study.unusual_factors import note_on_unusual_values

OUTSIDE = "outside the allowed range"  # words of the core
#: Columns of a study's table besides parameters, settings and measures.
FACTS = (
    *("hash", "seed", "event", "error", "notes", "version", "build", "dimension", "wall_s"),
    *TIMING,
)
#: Columns of tables of earlier versions.
FORMER_COLUMNS = ("step_factor", *FORMER_NAMES)
MAX_SWAPPED = 0.5  # share of stacks that are higher than long


def check_inputs(table: StackTable, names: Sequence[str]) -> None:
    """Refuse inputs that no scene can have, and note unusual ones, such as panels in millimetres.

    Parameters
    ----------
    table
        The table; the named columns hold numbers.
    names
        Names of the inputs, without the event.

    Raises
    ------
    InputError
        If a value is outside the range of its parameter; the message has line and column.
    """
    scene = Scene.preset("geometry").set("dimension", 2)
    factors = []
    for name in names:
        numbers = table.numbers(name)
        for value in (numbers.min(), numbers.max()):
            reason = _reason_against(scene, name, float(value))
            if reason:
                raise InputError(f"line {table.line(int(np.argmax(numbers == value)))}: {reason}")
        factors.append(Factor({name: np.unique(numbers).tolist()}))
    note_on_unusual_values(scene, [factors])


def _reason_against(scene: Scene, name: str, value: float) -> str:
    """Return the message of the core about a value outside the range of its parameter, or ""."""
    try:
        scene.with_({name: value}).resolve()
    except InputError as error:
        if OUTSIDE in str(error) and str(error).startswith(f"/{name.replace('.', '/')}: "):
            return str(error)
    return ""


def note_on_unusual_stacks(
    table: StackTable, inputs: Floats, height: Floats, length: Floats
) -> None:
    """Issue notes on stacks that reach above their panels, are higher than long, or are copies.

    Parameters
    ----------
    table
        The table that has the stacks.
    inputs
        The inputs of each stack, shape (n, k).
    height, length
        Their heights and lengths, shape (n,), m.
    """
    for note in _notes_on_stacks(table, inputs, height, length):
        issue_note(note, InputNote)


def _notes_on_stacks(
    table: StackTable, inputs: Floats, height: Floats, length: Floats
) -> Iterator[str]:
    above = height > _top_of_panel(table)
    if above.any():
        row = int(np.argmax(above))
        yield (
            f"{above.sum()} of {plural(len(height), 'stack')} reach above the top of their panel, "
            f"the first in line {table.line(row)}: {height[row]:.4g} m; check its unit, and that "
            "of the panels"
        )
    elif (height > length).mean() > MAX_SWAPPED:
        share = f"{(height > length).sum()} of {plural(len(height), 'stack')}"
        yield f"{share} are higher than long: are the columns of height and length swapped?"
    stacks = pd.DataFrame(inputs).assign(height=height, length=length)
    copies = int(stacks.duplicated().sum())
    if copies:
        yield (
            f"{plural(copies, 'stack')} equal another stack of the same panel and event to the "
            "last digit: are they copies? The scatter of the seeds is too small then"
        )


def _top_of_panel(table: StackTable) -> Floats:
    """Return the height of the upper edge of each row's panel, m; infinite where it is unknown."""
    frame = table.frame
    names = ("panel.height", "panel.length", "panel.tilt")
    if any(name not in frame for name in names):
        return np.full(len(frame), np.inf)
    height, length, tilt = (pd.to_numeric(frame[name], errors="coerce") for name in names)
    top = height + length * np.sin(np.radians(tilt))
    return np.asarray(top.fillna(np.inf), dtype=float)


def note_on_ignored_columns(table: StackTable) -> None:
    """Issue a note on columns that differ between rows, but are not of a study's table."""
    known = {*FACTS, *FORMER_COLUMNS, *STORED_TYPES, *ACCURACY, *NUMBERS}
    frame = table.frame
    ignored = [
        str(name)
        for name in frame
        if "." not in str(name) and str(name) not in known and frame[name].nunique(dropna=False) > 1
    ]
    if ignored:
        issue_note(
            f"{', '.join(ignored[:6])}: the rows differ here, but this is no column of a study's "
            "table and is ignored; a parameter has its path, such as snow.cohesion",
            InputNote,
        )
