"""The output of ``snowshed slide --range``."""

from __future__ import annotations

from pathlib import Path

from rich.table import Table

from snowshed.analysis.hazard.maps import LEVELS, HazardMaps, uncertainty
from snowshed.cli.terminal import PlainConsole


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
