"""The output of commands that run a scene of any method."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Optional

from rich.table import Table

from snowshed.base.paths import shell_words
from snowshed.cli.output.terminal import PlainConsole, plain_table, wide_console
from snowshed.io.json_file import read_object
from snowshed.methods.registry import method_of, settings_of
from snowshed.methods.summary import Summary
from snowshed.plot.caption import contact_text, mean_damping_rate
from snowshed.results.reader import Results

EVENT_TABLE = {
    "event": ("event", "{:.0f}"),
    "height\nm": ("height_m", "{:.3f}"),
    "length\nm": ("length_m", "{:.3f}"),
    "head\nm": ("head_m", "{:.3f}"),
    "tail\nm": ("tail_m", "{:.3f}"),
    "centre\nheight": ("centre_height_m", "{:.3f}"),
    "spread\nalong x": ("spread_m", "{:.3f}"),
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
    events = plain_table("Stack after each event", EVENT_TABLE, padding=0)
    for row in table.to_dict("records"):
        events.add_row(*(form.format(row[name]) for name, form in EVENT_TABLE.values()))
    wide_console(120).print(events)
    console = PlainConsole()
    console.print(contacts_and_damping(results.scene.data, mean_damping_rate(table)))
    residual = energy_residual(folder)
    if residual is not None:
        console.print(f"energy balance: residual {residual:.2g} of the largest energy")
    forces = (folder / "forces.png").is_file()
    drawn = ["stack.png", "growth.png", *["energy.png"] * (residual is not None)]
    drawn += ["forces.png"] * forces
    pictures = f"{', '.join(drawn[:-1])} and {drawn[-1]}"
    console.print(f"results, {pictures} in {folder}")
    console.print(f"the snow in motion: {shell_words('snowshed', 'view', folder)}")
    if (folder / "loads.csv").is_file():
        console.print(f"loads on what the snow meets: {shell_words('snowshed', 'loads', folder)}")


def energy_residual(folder: Path) -> Optional[float]:
    """Return the residual of the energy balance after the last event in run.json, if any."""
    events = read_object(folder / "run.json").get("finished_events") or [{}]
    residual = events[-1].get("energy_residual")
    return None if residual is None else float(residual)


def contacts_and_damping(scene: Mapping[str, Any], damping_rate: Optional[float]) -> str:
    """Return the conditions of panel and ground, and the damping of a run, in a line.

    Examples
    --------
    >>> from snowshed import Scene
    >>> contacts_and_damping(Scene.preset("lab-50").resolve().data, 188.0)
    'panel: separate, friction 0.3; ground: sticky; damping 188 1/s (FLIP 0.99 per step)'
    """
    parts = [f"{k}: {contact_text(scene[k])}" for k in ("panel", "ground") if k in scene]
    damping = settings_of(scene).damping_text(damping_rate)
    return "; ".join([*parts, *([damping] if damping else [])])


def print_results(results: Results) -> None:
    """Print the stack after each event, the summary of a run with one event, or the folder."""
    kinds = method_of(results.scene.data).results
    if "summary" in kinds:
        print_summary(results.summary, results.folder)
    elif "stack" in kinds:
        print_events(results)
    else:
        PlainConsole().print(f"results in {results.folder}")


def print_summary(summary: Summary, folder: Path) -> None:
    """Print the rows of a summary, and the names of the main files; the run issued its notes."""
    print_rows(summary.TITLE, summary.lines())
    PlainConsole(soft_wrap=True).print(f"results, {summary.OPENED} in {folder}")


def print_rows(title: str, rows: Mapping[str, str]) -> None:
    """Print named values below a title."""
    table = Table(title=title, show_header=False, box=None, title_justify="left")
    table.add_column(style="bold")
    for name, value in rows.items():
        table.add_row(name, value)
    PlainConsole().print(table)
