"""The output of ``snowshed slide``."""

from __future__ import annotations

from pathlib import Path

from rich.table import Table

from snowshed.analysis.hazard.maps import LEVELS, HazardMaps, uncertainty
from snowshed.cli.terminal import PlainConsole
from snowshed.methods.slide.summary import SlideSummary


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
    PlainConsole().print(shown)
    console = PlainConsole(soft_wrap=True)
    for note in summary.notes:
        console.note(note)
    console.print(f"results, maps, slide.html and slide.png in {folder}")


def print_hazard(maps: HazardMaps, folder: Path) -> None:
    """Print the areas that are reached with some probabilities, and where the maps are."""
    shown = Table(title=f"{maps.runs} slides", box=None, title_justify="left")
    shown.add_column("area, m2, with a probability of", style="bold")
    for level in LEVELS:
        shown.add_column(f"at least {100 * level:.0f} %", justify="right")
    for one in maps.exceedances:
        shown.add_row(one.label, *(f"{maps.area(one, level):,.0f}" for level in LEVELS))
    console = PlainConsole(soft_wrap=True)
    console.print(shown)
    console.print(uncertainty(maps.runs))
    if maps.failed:
        console.print(f"note: {maps.failed} further runs failed and are left out")
    console.print(f"maps, hazard.html and hazard.png in {folder}")
