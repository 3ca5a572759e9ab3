"""Scatter of stacks from seeding to seeding, by each trimming rule of A.4.2."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from reproductions.frischholz2023.studies import PANEL
from reproductions.frischholz2023.variants import MEASURE_COLUMNS, SETTINGS, measured_as
from snowshed._core import InputError
from snowshed.io.csv_table import read_csv

if TYPE_CHECKING:
    import pandas as pd

COLUMNS = (*PANEL, "event", "seed", *SETTINGS, *MEASURE_COLUMNS)


def read_scatter(file: Path) -> pd.DataFrame:
    """Return stacks of several seeds below the same panels; raises InputError if none are."""
    table = read_csv(file)
    missing = set(COLUMNS) - set(table)
    if missing:
        raise InputError(f"{file}: no column {', '.join(sorted(missing))}")
    if table["seed"].nunique() < 2:
        raise InputError(f"{file}: a single seed; scatter needs several")
    return table[list(COLUMNS)]


def scatter(stacks: pd.DataFrame, trimming: str, quantity: str) -> float:
    """Return the deviation between seedings, relative to the mean.

    Parameters
    ----------
    stacks
        From `read_scatter`.
    trimming
        Trimming rule of A.4.2.
    quantity
        "height", "length" or "ratio".

    Returns
    -------
    float
        Root mean square over all panels and events.
    """
    values = measured_as(stacks, trimming, quantity)
    groups = values.groupby([stacks[name] for name in (*PANEL, "event")])
    return float(np.sqrt(((groups.std(ddof=1) / groups.mean()) ** 2).mean()))
