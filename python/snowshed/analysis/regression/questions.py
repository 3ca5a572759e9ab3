"""Questions to a model: panels and their events, given as numbers, arrays or a table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Optional, Union

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.regression.rows import INPUTS
from snowshed.base.arrays import Booleans, Floats, Integers, number_array

if TYPE_CHECKING:
    import pandas as pd

#: A number, or one for each panel.
Numbers = Union[float, Sequence[float], Floats, Integers, "pd.Series[float]", "pd.Series[int]"]

#: Short names of inputs in tables and options; the names of other inputs are their paths.
SHORT_NAMES: Mapping[str, str] = {
    "panel.height": "height", "panel.length": "length", "panel.tilt": "tilt"
}  # fmt: skip
EVENTS = "events"
MAX_EVENTS = 1000  # of a panel
MAX_TOTAL_EVENTS = 20_000  # events of all panels: kernel matrices have a row for each


@dataclass(frozen=True)
class Questions:
    """The events of one or more panels.

    Attributes
    ----------
    labels
        One for each of the p panels: the index of the table, or 0, 1, ...
    panel
        Panel of each event, counted from 0, shape (n,).
    inputs
        Shape (n, k), the inputs of the model that is asked.
    """

    labels: pd.Index[int]
    panel: Integers
    inputs: Floats

    @classmethod
    def of(
        cls,
        table: Optional[pd.DataFrame],
        columns: Mapping[str, Optional[Numbers]],
        inputs: Sequence[str] = INPUTS,
    ) -> Questions:
        """Return the questions of a table, or of columns by name.

        Parameters
        ----------
        table
            One row for each panel, with a column for each input (by its short name, or its path)
            and ``events``, in any order and no other.
        columns
            The same columns, each a number or a value per panel; None if there is a table.
        inputs
            Inputs of the model; the event is the first.

        Raises
        ------
        InputError
            If a column is missing, unknown, of another length, or holds an impossible value.

        Examples
        --------
        >>> asked = Questions.of(None, {"height": 2, "length": [1, 4], "tilt": 40, "events": 2})
        >>> asked.panel.tolist(), asked.inputs[2].tolist()  # event, height, length, tilt
        ([0, 0, 1, 1], [1.0, 2.0, 4.0, 40.0])
        """
        import pandas as pd

        names = [*(SHORT_NAMES.get(name, name) for name in inputs[1:]), EVENTS]
        given = [name for name, value in columns.items() if value is not None]
        if table is not None:
            if given:
                raise InputError(
                    f"{given[0]}: not allowed beside a table of panels, which has it as a column"
                )
            columns = _table_columns(table, names)
        panels = _panel_rows(columns, names)
        labels = pd.RangeIndex(panels.shape[1]) if table is None else table.index
        _check(dict(zip(names, panels)), labels)
        counts = panels[-1].astype(int)
        which = np.repeat(np.arange(len(counts)), counts)
        events = np.concatenate([np.arange(1, count + 1) for count in counts])
        return cls(labels, which, np.column_stack([events, panels[:-1, which].T]))


def _table_columns(table: pd.DataFrame, allowed: Sequence[str]) -> dict[str, Optional[Numbers]]:
    import pandas as pd

    if not isinstance(table, pd.DataFrame):
        raise InputError(
            f"panels: {type(table).__name__} is not a DataFrame; give arrays as "
            f"{', '.join(allowed[:-1])} and {EVENTS}"
        )
    names = list(table.columns)
    for name in names:
        if name not in allowed:
            raise InputError(f"column {name!r} is unknown; allowed: {', '.join(allowed)}")
        if names.count(name) > 1:
            raise InputError(f"column {name!r} occurs twice")
    if not table.index.is_unique:
        twice = table.index[table.index.duplicated()][0]
        raise InputError(f"the table's index must be unique; it holds {twice} twice")
    return {name: table.get(name) for name in allowed}


def _panel_rows(columns: Mapping[str, Optional[Numbers]], names: Sequence[str]) -> Floats:
    """Return the columns as rows of an array, numbers repeated for each panel."""
    arrays = {}
    for name, value in columns.items():
        if name not in names and value is not None:
            raise InputError(f"{name}: not an input of this model; allowed: {', '.join(names)}")
    for name in names:
        value = columns.get(name)
        if value is None:
            raise InputError(f"{name}: missing; needed are {', '.join(names)}")
        arrays[name] = number_array(name, value)
        if arrays[name].ndim > 1:
            raise InputError(f"{name}: shape {arrays[name].shape}; must be a number or a sequence")
    lengths = {name: array.size for name, array in arrays.items() if array.ndim}
    count = next(iter(lengths.values()), 1)
    for name, length in lengths.items():
        if length != count:
            first = next(iter(lengths))
            raise InputError(
                f"{name}: {length} values, but {first} has {count}; give a number, or one for "
                "each panel"
            )
    if count == 0:
        raise InputError("no panels")
    return np.stack([np.broadcast_to(arrays[name], count) for name in names])


def _check(panels: Mapping[str, Floats], labels: pd.Index[int]) -> None:
    """Raise an InputError about the first impossible value, naming its panel if there are more."""
    events = panels[EVENTS]
    for name, values in panels.items():
        if name in ("height", "length"):
            wrong = ~(values > 0) | np.isinf(values)
            _refuse(name, values, wrong, "is not a positive length in m", labels)
        elif name == "tilt":
            outside = "is outside the allowed range (0 <= value < 90 degrees)"
            _refuse(name, values, ~((values >= 0) & (values < 90)), outside, labels)
        elif name != EVENTS:
            _refuse(name, values, ~np.isfinite(values), "is not a finite number", labels)
    outside = f"is outside the allowed range (1 to {MAX_EVENTS})"
    _refuse("events", events, ~((events >= 1) & (events <= MAX_EVENTS)), outside, labels)
    _refuse("events", events, events % 1 != 0, "is not a whole number", labels)
    if events.sum() > MAX_TOTAL_EVENTS:
        raise InputError(
            f"{events.sum():g} events of all panels; at most {MAX_TOTAL_EVENTS} are allowed"
        )


def _refuse(name: str, values: Floats, wrong: Booleans, why: str, labels: pd.Index[int]) -> None:
    if wrong.any():
        row = int(wrong.argmax())
        where = f"panel {labels[row]}, {name}" if len(labels) > 1 else name
        raise InputError(f"{where}: {values[row]:g} {why}")
