"""The output of loading tests of grains."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

from rich.table import Table

from snowshed.cli.terminal import PlainConsole
from snowshed.methods.grains.summary import GrainsSummary


def print_grains(summary: GrainsSummary, folder: Path) -> None:
    """Print the figures of a loading test."""
    shown = Table(title="Loading test", show_header=False, box=None, title_justify="left")
    shown.add_column(style="bold")
    broken = summary.broken_in_tension + summary.broken_in_shear
    for name, value in {
        "ended": f"{summary.ended} after {summary.duration_s:.4g} s",
        "sample": f"{summary.grains:,} grains of {summary.spheres:,} spheres, "
        f"{summary.density_kg_m3:.0f} kg/m3" + (", synthetic" if summary.synthetic else ""),
        "bonds broken": f"{broken:,} of {summary.bonds:,}, "
        f"{summary.broken_in_tension:,} in tension and {summary.broken_in_shear:,} in shear",
        "elastic up to": _percent(summary.elastic_limit_strain),
        "tangent modulus": _pressure(summary.tangent_modulus_pa),
        "strength": _pressure(summary.strength_pa),
        "mean stress, 5 to 10 %": _pressure(summary.mean_stress_5_10_pa),
        "mean stress, 10 to 15 %": _pressure(summary.mean_stress_10_15_pa),
        "mean stress, 25 to 30 %": _pressure(summary.mean_stress_25_30_pa),
        "hardening from": _percent(summary.hardening_onset_strain),
        "force on the cone": f"up to {summary.largest_cone_force_n:.3g} N"
        if summary.largest_cone_force_n
        else "",
    }.items():
        if value:
            shown.add_row(name, value)
    PlainConsole().print(shown)
    console = PlainConsole(soft_wrap=True)
    for note in summary.notes:
        console.note(note)
    console.print(f"results, curve.csv, grains.png and forces.png in {folder}")


def _percent(strain: Optional[float]) -> str:
    return "" if strain is None else f"{100 * strain:.3g} % strain"


def _pressure(pascals: Optional[float]) -> str:
    if pascals is None:
        return ""
    unit, factor = ("MPa", 1e-6) if abs(pascals) >= 1e6 else ("kPa", 1e-3)
    return f"{pascals * factor:.3g} {unit}"
