"""The output of studies of grains."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from snowshed.analysis.grains.material.fit import FittedSnow, Range, exponents
from snowshed.analysis.grains.ratios import STRESSES
from snowshed.analysis.grains.variants import BASE
from snowshed.base.formatting import NOTHING
from snowshed.cli.terminal import plain_table, wide_console

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


#: Parameters of a fitted snow: what they are called, their unit and its size in SI units.
PARAMETERS = {
    "youngs_modulus": ("E of the grains", "MPa", 1e6),
    "poissons_ratio": ("nu", "", 1.0),
    "preconsolidation_pressure": ("p0", "kPa", 1e3),
    "critical_state_slope": ("M", "", 1.0),
    "cohesion": ("beta", "", 1.0),
    "hardening_factor": ("xi", "", 1.0),
    "tension_pa": ("tensile strength", "kPa", 1e3),
    "yield_residual": ("residual of the yield surface", "", 1.0),
    "hardening_residual": ("residual of the hardening", "", 1.0),
    "confined_yield_over_law": ("confined peak over law", "", 1.0),
}


def print_material(fits: Sequence[FittedSnow]) -> None:
    """Print the parameters of fitted snows with their intervals, and what to know of them."""
    shown = plain_table("Snow of the grains (95 % interval of the mean, by the samples' scatter)")
    shown.add_column("", no_wrap=True)
    for one in fits:
        shown.add_column(f"{one.law.density:.0f} kg/m3", justify="right", no_wrap=True)
    for name, (words, unit, size) in PARAMETERS.items():
        head = f"{words}, {unit}" if unit else words
        shown.add_row(head, *(_range(one.ranges[name], size) for one in fits))
    console = wide_console(100)
    console.print(shown)
    for name, exponent in exponents([one.law for one in fits]).items():
        console.print(f"{PARAMETERS[name][0]} grows as density^{exponent:.2g}")
    for one in fits:
        for note in one.notes:
            console.print(f"note, {one.law.density:.0f} kg/m3: {note}", soft_wrap=True)


def _range(found: Range, size: float) -> str:
    text = f"{found.value / size:.3g}"
    if not np.isfinite(found.low):
        return text
    return f"{text} ({found.low / size:.2g} to {found.high / size:.2g})"
