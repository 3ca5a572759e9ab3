"""Stacks with each deviation from the thesis undone or a setting varied, and their changes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import numpy as np

from reproductions.common.hypothesis_tests import Estimate, widening
from reproductions.frischholz2023.deviations import DEVIATIONS, deviating_trimming
from reproductions.frischholz2023.studies import DEFAULTS, PANEL, VARIANTS, VARIATIONS, study_of
from snowshed._core import InputError
from snowshed.io.csv_table import read_csv
from snowshed.snow.stack.quantities import MEASURES
from snowshed.snow.stack.trimming import DEFAULT_TRIMMING, TRIMMINGS
from snowshed.study.store import Store
from snowshed.study.table import read_table

if TYPE_CHECKING:
    import pandas as pd

#: Quantiles of Table 5.3.1: three quartiles and the maximum.
QUANTILES = (0.25, 0.5, 0.75, 1.0)
ROW_KEYS = (*PANEL, "event", "seed")
MEASURE_COLUMNS = tuple(
    MEASURES[name].column(quantity) for name in TRIMMINGS for quantity in ("height", "length")
)
SETTINGS = ("dx",)


def read_variants(store: Path) -> pd.DataFrame:
    """Return the stacks of all variants and variations that are computed, from a store.

    Returns
    -------
    pandas.DataFrame
        ``variant``, the panel, ``event``, ``seed``, ``dx``, the measures by both trimming rules,
        and ``same_runs``: whether all runs of the variant are those of the defaults.
    """
    import pandas as pd

    with Store.open(store) as opened:
        present = opened.studies()
        hashes = {
            name: [run.hash for run in opened.runs(study_of(name))]
            for name in (*VARIANTS, *VARIATIONS)
            if study_of(name) in present
        }
    tables = []
    for name, runs in hashes.items():
        table = read_table(store, study_of(name)).dropna(subset=list(MEASURE_COLUMNS))
        same = runs == hashes.get(DEFAULTS)
        columns = [*ROW_KEYS, *SETTINGS, *MEASURE_COLUMNS]
        tables.append(table[columns].assign(variant=name, same_runs=same))
    if not tables or tables[0].empty:
        raise InputError("no panel of the sample is computed yet")
    stacks = pd.concat(tables, ignore_index=True)
    return stacks[["variant", "same_runs", *(name for name in stacks if name in columns)]]


def read_variants_file(file: Path) -> pd.DataFrame:
    """Return the stacks of all variants from a file; raises InputError if columns are missing."""
    table = read_csv(file)
    missing = {"variant", "same_runs", *ROW_KEYS, *SETTINGS, *MEASURE_COLUMNS} - set(table)
    if missing:
        raise InputError(f"{file}: no column {', '.join(sorted(missing))}")
    return table


def ratios(stacks: pd.DataFrame, trimming: str) -> pd.Series:
    """Return H/L of stacks by a trimming rule of A.4.2."""
    measure = MEASURES[trimming]
    return stacks[measure.column("height")] / stacks[measure.column("length")]


def measured_as(stacks: pd.DataFrame, trimming: str, quantity: str) -> pd.Series:
    """Return "height", "length" or "ratio" of stacks by a trimming rule of A.4.2."""
    if quantity == "ratio":
        return ratios(stacks, trimming)
    return stacks[MEASURES[trimming].column(quantity)]


def quartiles(stacks: pd.DataFrame, trimming: str) -> list[float]:
    """Return the quartiles of H/L by a trimming rule of A.4.2; the last one is the maximum."""
    return [float(quartile) for quartile in np.quantile(ratios(stacks, trimming), QUANTILES)]


def distinct_variants(stacks: pd.DataFrame) -> Iterator[tuple[str, pd.DataFrame]]:
    """Yield the defaults, and each variant that has runs of its own, with its stacks."""
    for name, of_one in stacks.groupby("variant", sort=False):
        if name == DEFAULTS or not of_one["same_runs"].all():
            yield str(name), of_one


def trimming_of(variant: str) -> str:
    """Return the trimming rule of a variant or a variation."""
    return deviating_trimming(VARIANTS.get(variant, ()))


def change(
    stacks: pd.DataFrame, variant: str, quantity: str, trimming: Optional[str] = None
) -> Estimate:
    """Return the relative change of a stack by a deviation.

    Each stack is compared with that of the defaults below the same panel after the same event with
    the same seed. The change is the geometric mean of their ratios over panels, minus 1. Its noise
    is the standard error over panels, which are independent, widened if panels are few.

    Parameters
    ----------
    stacks
        From `read_variants`.
    variant
        The name of a deviation or of a variation, or "thesis".
    quantity
        "height", "length" or "ratio".
    trimming
        The trimming rule for the variant's stacks; None: its own.

    Raises
    ------
    LookupError
        If there are no stacks to compare.
    """
    ours = measured_as(_rows(stacks, DEFAULTS), DEFAULT_TRIMMING, quantity)
    theirs = measured_as(_rows(stacks, variant), trimming or trimming_of(variant), quantity)
    both = (theirs / ours).dropna().map(math.log)
    by_panel = both.groupby(level=list(range(len(PANEL)))).mean()
    if by_panel.empty:
        raise LookupError(f"stacks of {variant} and of the defaults below the same panels")
    count = len(by_panel)
    noise = float(by_panel.std(ddof=1)) / np.sqrt(count) if count > 1 else np.nan
    mean = float(np.exp(by_panel.mean()))
    return Estimate(mean - 1, mean * noise * widening(count - 1) if noise else 0.0)


def _rows(stacks: pd.DataFrame, variant: str) -> pd.DataFrame:
    return stacks[stacks["variant"] == variant].set_index(list(ROW_KEYS))


def by_size(stacks: pd.DataFrame) -> list[str]:
    """Return the computed deviations by their change of H/L, the largest first."""
    present_names = [name for name in DEVIATIONS if name in set(stacks["variant"])]
    sizes = {name: abs(change(stacks, name, "ratio").value) for name in present_names}
    return sorted(present_names, key=lambda name: (is_unswitched(stacks, name), -sizes[name]))


def is_unswitched(stacks: pd.DataFrame, name: str) -> bool:
    """Return whether a simulated deviation has the same scenes as our settings."""
    same = stacks.loc[stacks["variant"] == name, "same_runs"]
    return DEVIATIONS[name].simulated and bool(same.all())
