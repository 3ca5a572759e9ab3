"""The output of ``snowshed slide``."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console
from rich.table import Table

from snowshed.analysis.hazard_maps import LEVELS, HazardMaps, wilson_interval
from snowshed.run.slides import SlideSummary


def print_slide(summary: SlideSummary, folder: Path) -> None:
    """Print the figures of a slide."""
    shown = Table(title="Snow slide", show_header=False, box=None, title_justify="left")
    shown.add_column(style="bold")
    broken = f"{summary.bonds_broken:,} of {summary.bonds_made:,}"
    for name, value in {
        "ended": f"{summary.ended} after {summary.duration_s:.2f} s",
        "released": f"{summary.released_kg:,.0f} kg",
        "entrained": f"{summary.entrained_kg:,.0f} kg",
        "left the terrain": f"{summary.left_terrain_kg:,.0f} kg",
        "bonds broken": broken if summary.bonds_made else "no bonds",
        "peak speed": f"{summary.peak_speed_m_s:.2f} m/s",
        "peak thickness": f"{summary.peak_thickness_m:.2f} m",
        "peak pressure": f"{summary.peak_pressure_kpa:.2f} kPa",
        "area reached": f"{summary.reached_m2:,.0f} m2",
        "run-out": f"{summary.run_out_m:.1f} m from the middle of the release",
        "drop": f"{summary.drop_m:.1f} m",
    }.items():
        shown.add_row(name, value)
    Console().print(shown, highlight=False)
    Console().print(f"results, maps and slide.png in {folder}", highlight=False)


def print_hazard(maps: HazardMaps, folder: Path) -> None:
    """Print the areas that are reached with some probabilities, and where the maps are."""
    shown = Table(title=f"{maps.runs} slides", box=None, title_justify="left")
    shown.add_column("area, m2, with a probability of", style="bold")
    for level in LEVELS:
        shown.add_column(f"at least {100 * level:.0f} %", justify="right")
    for one in maps.exceedances:
        shown.add_row(one.label, *(f"{maps.area(one, level):,.0f}" for level in LEVELS))
    console = Console(highlight=False, soft_wrap=True)
    console.print(shown)
    low, high = (100.0 * end for end in wilson_interval(maps.runs / 2, maps.runs))
    rare = 100.0 * float(wilson_interval(0, maps.runs)[1])
    console.print(
        f"95 % intervals: a probability of 50 % is {low:.0f} to {high:.0f} %; a place that no run"
        f" reached is reached with at most {rare:.1f} %"
    )
    if maps.failed:
        console.print(f"note: {maps.failed} further runs failed and are left out")
    console.print(f"maps, hazard.html and hazard.png in {folder}")
