"""The results of runs, for every command that runs a scene: events, a slide, a loading test."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

from rich.table import Table

from snowshed.cli.terminal import PlainConsole, plain_table, wide_console
from snowshed.io.json_file import read_object
from snowshed.methods.registry import settings_of
from snowshed.plot.caption import contact_text, mean_damping_rate

if TYPE_CHECKING:
    import pandas as pd

    from snowshed.methods.grains.summary import GrainsSummary
    from snowshed.methods.slide.summary import SlideSummary


EVENT_TABLE = {
    "event": ("event", "{:.0f}"),
    "height\nm": ("height_m", "{:.3f}"),
    "length\nm": ("length_m", "{:.3f}"),
    "head\nm": ("head_m", "{:.3f}"),
    "tail\nm": ("tail_m", "{:.3f}"),
    "body\nheight": ("body_height_m", "{:.3f}"),
    "body\nlength": ("body_length_m", "{:.3f}"),
    "density\nkg/m3": ("density_kg_m3", "{:.0f}"),
    "loose\nkg": ("detached_kg", "{:.2g}"),
    "panel\nkg": ("on_panel_kg", "{:.2g}"),
    "ended": ("ended", "{}"),
}


def print_events(table: pd.DataFrame, folder: Path) -> None:
    """Print the measures of the stack after each event."""
    events = plain_table("Stack after each event", EVENT_TABLE, padding=0)
    for row in table.to_dict("records"):
        events.add_row(*(form.format(row[name]) for name, form in EVENT_TABLE.values()))
    wide_console(120).print(events)
    scene = read_object(folder / "scene.json")
    console = PlainConsole()
    console.print(contacts_and_damping(scene, mean_damping_rate(table)))
    residual = energy_residual(folder)
    if residual is not None:
        console.print(f"energy balance: residual {residual:.2g} of the largest energy")
    drawn = ["stack.png", "growth.png"] + ["energy.png"] * (residual is not None)
    pictures = f"{', '.join(drawn[:-1])} and {drawn[-1]}"
    console.print(f"results, {pictures} in {folder}")
    console.print(f"the snow in motion: snowshed view {folder}")


def energy_residual(folder: Path) -> Optional[float]:
    """Return the residual of the energy balance after the last event in run.json, if any."""
    events = read_object(folder / "run.json").get("finished_events") or [{}]
    residual = events[-1].get("energy_residual")
    return None if residual is None else float(residual)


def contacts_and_damping(scene: dict[str, Any], damping_rate: Optional[float]) -> str:
    """Return the conditions of panel and ground, and the damping of a run, in a line.

    Examples
    --------
    >>> from snowshed import Scene
    >>> contacts_and_damping(Scene.preset("lab-50").resolve().data, 188.0)
    'panel: separate, friction 0.3; ground: sticky; damping 188 1/s (FLIP 0.99 a step)'
    """
    parts = [f"{k}: {contact_text(scene[k])}" for k in ("panel", "ground") if k in scene]
    damping = settings_of(scene).damping_text(damping_rate)
    return "; ".join([*parts, *([damping] if damping else [])])


def print_slide(summary: SlideSummary, folder: Path) -> None:
    """Print the summary of a slide."""
    broken = f"{summary.bonds_broken:,} of {summary.bonds_made:,}"
    rows = {
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
    }
    print_rows("Snow slide", rows)
    print_notes(summary.notes)
    PlainConsole(soft_wrap=True).print(f"results, maps, slide.html and slide.png in {folder}")


def print_grains(summary: GrainsSummary, folder: Path) -> None:
    """Print the summary of a loading test."""
    broken = summary.broken_in_tension + summary.broken_in_shear
    cone_force = summary.largest_cone_force_n
    rows = {
        "ended": f"{summary.ended} after {summary.duration_s:.4g} s",
        "sample": f"{summary.grains:,} grains of {summary.spheres:,} spheres, "
        f"{summary.density_kg_m3:.0f} kg/m3" + (", synthetic" if summary.synthetic else ""),
        "bonds broken": f"{broken:,} of {summary.bonds:,}, "
        f"{summary.broken_in_tension:,} in tension and {summary.broken_in_shear:,} in shear",
        "elastic up to": _strain(summary.elastic_limit_strain),
        "tangent modulus": _stress(summary.tangent_modulus_pa),
        "strength": _stress(summary.strength_pa),
        "mean stress, 5 to 10 %": _stress(summary.mean_stress_5_10_pa),
        "mean stress, 10 to 15 %": _stress(summary.mean_stress_10_15_pa),
        "mean stress, 25 to 30 %": _stress(summary.mean_stress_25_30_pa),
        "hardening from": _strain(summary.hardening_onset_strain),
        "force on the cone": f"up to {cone_force:.3g} N" if cone_force else "",
    }
    print_rows("Loading test", {title: value for title, value in rows.items() if value})
    print_notes(summary.notes)
    files = "results, curve.csv, grains.png and forces.png"
    PlainConsole(soft_wrap=True).print(f"{files} in {folder}")


def print_rows(title: str, rows: Mapping[str, str]) -> None:
    """Print a table of titles and values."""
    table = Table(title=title, show_header=False, box=None, title_justify="left")
    table.add_column(style="bold")
    for name, value in rows.items():
        table.add_row(name, value)
    PlainConsole().print(table)


def print_notes(notes: Iterable[str]) -> None:
    """Print highlighted notes."""
    console = PlainConsole(soft_wrap=True)
    for note in notes:
        console.note(note)


def _strain(strain: Optional[float]) -> str:
    return "" if strain is None else f"{100 * strain:.3g} % strain"


def _stress(pascals: Optional[float]) -> str:
    if pascals is None:
        return ""
    unit, factor = ("MPa", 1e-6) if abs(pascals) >= 1e6 else ("kPa", 1e-3)
    return f"{pascals * factor:.3g} {unit}"
