"""The output of ``--dry-run``: the features and the cost of a scene, without a step."""

from __future__ import annotations

from typing import Any

from rich.table import Table

import snowshed._core as _core
from snowshed.base.formatting import duration
from snowshed.base.notes import issue_note
from snowshed.cli.output.terminal import PlainConsole
from snowshed.running.scene_notes import notes_of_beginning
from snowshed.scene.scene import ResolvedScene


def print_cost(scene: ResolvedScene) -> None:
    """Print the features, memory and run time of a scene, and the notes of its run."""
    table = Table(show_header=False, box=None)
    table.add_column(style="bold")
    for name, value in cost_rows(_core.plan(scene.core, scene.base_dir)).items():
        table.add_row(name, value)
    PlainConsole().print(table)
    issue_notes(scene)


def issue_notes(scene: ResolvedScene) -> None:
    """Print the notes that a run of a scene prints before its first step."""
    for note in notes_of_beginning(scene):
        issue_note(note)


def cost_rows(plan: dict[str, Any]) -> dict[str, str]:
    """Return the lines of a plan, with units, by their titles."""
    card = plan["card_memory_bytes"]
    return {
        "used": ", ".join(plan["used"]),
        "left out": ", ".join(plan["left_out"]) or "nothing",
        "particles": f"{plan['particles_per_event']:,} per event",
        "particles in all": f"{plan['particles_total']:,}",
        **{name: f"{count:,}" for name, count in plan["parts"].items()},
        "memory": f"{plan['memory_bytes'] / 1e6:,.1f} MB for particles and grid",
        **({"memory of the card": f"{card / 1e6:,.1f} MB"} if card else {}),
        "time step": f"{plan['time_step_s']:.3g} s",
        "steps": f"{plan['steps_per_event']:,} per event",
        "run time": f"about {duration(plan['expected_wall_s'])}",
        "speed": f"{plan['updates_per_s'] / 1e6:.1f} M particle updates/s, measured now",
        "device": plan["device"],
        "threads": f"{plan['threads']} at most",
        "scalar": f"{plan['scalar']}, {plan['kernels']}",
    }
