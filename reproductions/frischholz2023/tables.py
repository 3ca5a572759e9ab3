"""Tables, texts and numbers that several sections of the report share."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from reproductions.common.hypothesis_tests import widening
from reproductions.frischholz2023.printed import Printed
from reproductions.frischholz2023.settings import MEASURED_FRICTION
from snowshed.base.arrays import Floats
from snowshed.base.formatting import MISSING
from snowshed.plot.html_page import HtmlTable
from snowshed.scene.labels import label
from snowshed.study.table import value_at

if TYPE_CHECKING:
    import pandas as pd

#: Resolution of the figures that stages save, see `snowshed.plot.figure_style.save_figure`.
SAVED_DPI = 160
#: Text of sections whose panel has a single friction.
PANEL_FRICTION = (
    f"The thesis does not print the panel's friction; here it is {MEASURED_FRICTION}, the least "
    "static coefficient that it measured."
)


def settings_grid(printed: Sequence[Printed], scenes: Sequence[str]) -> HtmlTable:
    """Return a table of parameters: printed values of the thesis, and values of the scenes.

    Parameters
    ----------
    printed
        The rows.
    scenes
        Complete scenes as JSON.

    Examples
    --------
    >>> row = Printed("snow.cohesion", "0.1, 0.2")
    >>> settings_grid([row], ['{"snow": {"cohesion": 0.1}}']).rows
    [['cohesion factor β', '0.1, 0.2', '0.1', '']]
    """
    data = [json.loads(scene) for scene in scenes]
    rows = []
    for row in printed:
        values = {value_at(scene, row.path) for scene in data} - {None}
        ours = ", ".join(_printed_value(value, row) for value in sorted(values)) or MISSING
        ours += "D" if row.path == "dimension" else ""
        rows.append([row.title, row.text, ours, label(row.path).unit])
    return HtmlTable(["parameter", "thesis", "here", "unit"], rows, "llll")


def _printed_value(value: Any, row: Printed) -> str:
    if isinstance(value, str):
        return value.upper()
    return label(row.path).value(value) if value else row.zero


def widenings(table: pd.DataFrame, noise: pd.DataFrame) -> Floats:
    """Return the factor that widens the noise of each row, because its seedings are few.

    Parameters
    ----------
    table
        With the columns ``event`` and ``target``.
    noise
        From `snowshed.analysis.sensitivity.seeding_noise`.
    """
    keys = zip(table["event"], table["target"])
    return np.array([widening(float(noise["freedom"].get(key, 0))) for key in keys])


def grouped(table: pd.DataFrame, *keys: str) -> Iterator[tuple[tuple[Any, ...], pd.DataFrame]]:
    """Yield the values of some columns, and the rows that have them, in the table's order."""
    for values, rows in table.groupby(list(keys), sort=False):
        yield tuple(values) if isinstance(values, tuple) else (values,), rows


def plus_minus(value: float, noise: float, digits: int = 3) -> str:
    """Return a number with its noise, to a fixed number of decimals.

    Examples
    --------
    >>> plus_minus(0.1234, 0.0056), plus_minus(0.1234, float("nan"))
    ('0.123 ± 0.006', '0.123')
    """
    text = f"{value:.{digits}f}"
    return text if noise != noise else f"{text} ± {noise:.{digits}f}"
