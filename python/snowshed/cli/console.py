"""The output of the commands that run and describe scenes."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

from rich.table import Table

from snowshed.base.formatting import duration
from snowshed.cli.terminal import PlainConsole, plain_table, wide_console
from snowshed.io.json_file import read_object
from snowshed.methods.registry import settings_of
from snowshed.plot.caption import contact_text, mean_damping_rate
from snowshed.results.dimension_ratio import RULE_OF_THUMB
from snowshed.results.reader import Results

if TYPE_CHECKING:
    import pandas as pd


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


def print_events(results: Results) -> None:
    """Print the measures of the stack after each event."""
    table, folder = results.events, results.folder
    shown = plain_table("Stack after each event", EVENT_TABLE, padding=0)
    for row in table.to_dict("records"):
        shown.add_row(*(form.format(row[name]) for name, form in EVENT_TABLE.values()))
    wide_console(120).print(shown)
    console = PlainConsole()
    console.print(contacts_and_damping(results.scene.data, mean_damping_rate(table)))
    residual = energy_residual(folder)
    if residual is not None:
        console.print(f"energy balance: residual {residual:.2g} of the largest energy")
    drawn = ["stack.png", "growth.png"] + ["energy.png"] * (residual is not None)
    pictures = f"{', '.join(drawn[:-1])} and {drawn[-1]}"
    console.print(f"results, {pictures} in {folder}")
    console.print(f"the snow in motion: snowshed view {folder}")


def energy_residual(folder: Path) -> Optional[float]:
    """Return what run.json says of the energy balance after the last event; None without one."""
    events = read_object(folder / "run.json").get("finished_events") or [{}]
    residual = events[-1].get("energy_residual")
    return None if residual is None else float(residual)


def contacts_and_damping(scene: Mapping[str, Any], damping_rate: Optional[float]) -> str:
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


def print_plan(plan: dict[str, Any]) -> None:
    """Print the features that a scene uses and leaves out, and its cost."""
    shown = Table(show_header=False, box=None)
    shown.add_column(style="bold")
    for name, value in plan_rows(plan).items():
        shown.add_row(name, value)
    PlainConsole().print(shown)


def plan_rows(plan: dict[str, Any]) -> dict[str, str]:
    """Return the lines of a plan, with units."""
    return {
        "used": ", ".join(plan["used"]),
        "left out": ", ".join(plan["left_out"]) or "nothing",
        "particles": f"{plan['particles_per_event']:,} per event",
        "particles in all": f"{plan['particles_total']:,}",
        **{name: f"{count:,}" for name, count in plan["parts"].items()},
        "memory": f"{plan['memory_bytes'] / 1e6:,.1f} MB for particles and grid",
        "time step": f"{plan['time_step_s']:.3g} s",
        "steps": f"{plan['steps_per_event']:,} per event",
        "run time": f"about {duration(plan['expected_wall_s'])}",
        "speed": f"{plan['updates_per_s'] / 1e6:.1f} M particle updates/s, measured now",
        "threads": f"{plan['threads']} at most",
        "scalar": f"{plan['scalar']}, {plan['kernels']}",
    }


def print_ratios(ratios: pd.DataFrame) -> None:
    """Print 3D over 2D heights beside the thesis's rule of thumb."""
    headings = ("event", "3D, m", "2D, m", "3D/2D", "rule of thumb")
    shown = plain_table("Stack height in 3D and in 2D", headings, padding=0)
    for event, three, two, ratio in ratios.itertuples(index=False):
        cells = (f"{three:.3f}", f"{two:.3f}", f"{ratio:.2f}", f"{RULE_OF_THUMB:.2f}")
        shown.add_row(str(event), *cells)
    wide_console(120).print(shown)


def print_heights(ratios: pd.DataFrame, one: str, other: str) -> None:
    """Print the heights of two runs, event by event, and their ratio."""
    shown = plain_table("Stack heights", ("event", f"{one}, m", f"{other}, m", "ratio"), padding=0)
    for event, first, second, ratio in ratios.itertuples(index=False):
        shown.add_row(str(event), f"{first:.3f}", f"{second:.3f}", f"{ratio:.2f}")
    wide_console(120).print(shown)
