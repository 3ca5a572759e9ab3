"""The output of studies of grains."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from snowshed.analysis.grains.ratios import STRESSES
from snowshed.analysis.grains.variants import BASE
from snowshed.cli.terminal import plain_table, wide_console
from snowshed.io.formatting import NOTHING

if TYPE_CHECKING:
    import pandas as pd


def print_comparison(comparison: pd.DataFrame) -> None:
    """Print stresses of the base, and those of the variants over them.

    Parameters
    ----------
    comparison
        From `snowshed.analysis.grains.ratios.compare_variants`.
    """
    stresses = [name for name in STRESSES if name in set(comparison["stress"])]
    shown = plain_table("Stresses, and their ratio to the base (95 % by the samples' scatter)")
    shown.add_column("", no_wrap=True)
    for stress in stresses:
        shown.add_column(STRESSES[stress], justify="right", no_wrap=True)
    for variant in dict.fromkeys(comparison["variant"]):
        rows = comparison[comparison["variant"] == variant].set_index("stress")
        cells = [_cell(rows.loc[stress], base=variant == BASE) for stress in stresses]
        shown.add_row(str(variant), *cells)
    console = wide_console(140)
    console.print(shown)
    console.print("? may be none: 1 lies within the interval")


def _cell(row: Any, *, base: bool) -> str:
    if not np.isfinite(row["ratio"]):
        return NOTHING
    if base:
        scatter = f" x/ {np.exp(row['scatter']):.2f}" if np.isfinite(row["scatter"]) else ""
        return f"{row['value_pa'] / 1e3:.3g} kPa{scatter}  "
    if not np.isfinite(row["low"]):
        return f"{row['ratio']:.3g}  "
    doubt = " " if row["distinct"] else "?"
    return f"{row['ratio']:.3g} ({row['low']:.2g} to {row['high']:.2g}) {doubt}"
