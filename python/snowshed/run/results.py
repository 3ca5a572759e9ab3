"""The results folder of a run: what is in it, and how it is opened.

================== ==========================================================================
scene.json         the complete scene that made the results
events.csv         one row per event: `EVENT_COLUMNS`
outline.csv        profile of the stack after each event: event, x, z
conversions.csv    how far reseeding moved the stack (only with between = "reseed")
ageing.csv         what time did to the stack between events (only if it aged), and how long it
                   had: ageing.json
energy.csv         energy books at the end of each event (only with output.energy)
run.json           version, machine, size and speed of the run, and its status
checkpoint.bin     the state from which the run goes on
particles/         the particles after each event (.vtp); ``particles.pvd`` opens them as a series
snapshots/         particle snapshots during the events (only with output.snapshot_interval)
stack.png          side view of the last stack
growth.png         height, length, head and tail against the event
================== ==========================================================================
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.io.arrays import Floats
from snowshed.io.atomic import write_text
from snowshed.io.csv_table import Table, read_csv
from snowshed.io.json_file import is_number, read_object
from snowshed.run.ageing import AGEING_COLUMNS
from snowshed.run.conversion import CONVERSION_COLUMNS
from snowshed.scene.scene import PathLike, ResolvedScene
from snowshed.scene.schema import with_current_names
from snowshed.snow.stack.measure import StackMeasure

if TYPE_CHECKING:
    import pandas as pd

EVENT_COLUMNS = (
    "event",
    "height_m",
    "length_m",
    "head_m",
    "tail_m",
    "width_m",
    "volume_m3",
    "density_kg_m3",
    "on_panel_kg",
    "detached_kg",
    "body_height_m",
    "body_length_m",
    "mass_kg",
    "sim_time_s",
    "steps",
    "wall_s",
    "ended",
    "crest_m",
    "body_head_m",
    "body_tail_m",
)

ADDED_UP = ("steps", "wall_s")  # over the events so far, when a run goes on


def measured_columns(stack: StackMeasure) -> dict[str, float]:
    """Return the columns of events.csv that a measured stack fills."""
    return {
        "height_m": stack.height,
        "length_m": stack.length,
        "head_m": stack.head,
        "tail_m": stack.tail,
        "width_m": stack.width,
        "volume_m3": stack.volume,
        "density_kg_m3": stack.density,
        "on_panel_kg": stack.on_panel_mass,
        "detached_kg": stack.detached_mass,
        "body_height_m": stack.body.height,
        "body_length_m": stack.body.length,
        "mass_kg": stack.mass,
        "crest_m": stack.crest,
        "body_head_m": stack.body.head,
        "body_tail_m": stack.body.tail,
    }


class Results:
    """A results folder that is being written; use `create` or `reopen`."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.scene = folder / "scene.json"
        self.checkpoint = folder / "checkpoint.bin"
        self.run = folder / "run.json"
        self.particles = folder / "particles"
        self.snapshots = folder / "snapshots"
        self.stack_picture = folder / "stack.png"
        self.growth_picture = folder / "growth.png"
        self.events = Table(folder / "events.csv", EVENT_COLUMNS)
        self.outlines = Table(folder / "outline.csv", ("event", "x", "z"))
        self.conversions = Table(folder / "conversions.csv", CONVERSION_COLUMNS)
        self.ageings = Table(folder / "ageing.csv", AGEING_COLUMNS)
        self.energies = Table(folder / "energy.csv")

    @classmethod
    def create(
        cls, folder: PathLike, scene: ResolvedScene, ageing: Optional[Mapping[str, Any]] = None
    ) -> Results:
        """Make a results folder for a scene; raises InputError if it holds anything."""
        check_empty(folder)
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        scene.save(folder / "scene.json")
        if ageing is not None:
            write_text(folder / "ageing.json", json.dumps(ageing, indent=2) + "\n")
        return cls(folder)

    @classmethod
    def reopen(
        cls, folder: PathLike, scene: ResolvedScene, ageing: Optional[Mapping[str, Any]] = None
    ) -> Results:
        """Open the folder of an earlier run of the same scene; raises InputError if it is not."""
        folder = Path(folder)
        if not (folder / "scene.json").is_file():
            raise InputError(f"{folder}: nothing to resume; it holds no scene.json")
        earlier = with_current_names(read_object(folder / "scene.json"))
        if differing := _differences(earlier, scene.data):
            raise InputError(
                f"{folder}: made by another scene, which differs in {', '.join(differing)}; "
                "resume with the scene.json in it"
            )
        file = folder / "ageing.json"
        if (read_object(file) if file.is_file() else None) != ageing:
            raise InputError(f"{file}: between its events the stack aged in another way")
        results = cls(folder)
        if results.events.rows:  # so that damage is known before the run goes on
            read_events(folder)
            for column in ADDED_UP:
                results.events.total(column)
        return results

    def keep_through(self, event: int, *, running: bool) -> None:
        """Drop what belongs to events after `event`, or to `event` itself if it still runs."""
        finished = event - 1 if running else event
        for table in (self.events, self.outlines, self.energies):
            table.keep_through(finished)
        self.conversions.keep_through(event)
        self.ageings.keep_through(event)

    def add_outline(self, event: int, outline: Floats) -> None:
        """Add the profile (k, 2) of the stack after an event."""
        self.outlines.add({"event": event, "x": x, "z": z} for x, z in outline.tolist())

    def particles_of(self, event: int) -> Path:
        """Return the file for the particles after an event; its folder exists."""
        self.particles.mkdir(exist_ok=True)
        return self.particles / f"event_{event:03d}.vtp"

    def write_series(self) -> None:
        """Write the list that makes ParaView show the particles of all events as a series."""
        events = (int(row["event"]) for row in self.events.rows)
        entries = "".join(
            f'    <DataSet timestep="{event}" file="particles/event_{event:03d}.vtp"/>\n'
            for event in events
        )
        write_text(
            self.folder / "particles.pvd",
            '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">\n  <Collection>\n'
            f"{entries}  </Collection>\n</VTKFile>\n",
        )

    def write_run(self, facts: Mapping[str, Any]) -> None:
        """Write run.json."""
        write_text(self.run, json.dumps(facts, indent=2) + "\n")

    def read_run(self) -> dict[str, Any]:
        """Read run.json; empty before its first writing."""
        return read_object(self.run) if self.run.exists() else {}

    def earlier_wall_s(self) -> float:
        """Return the computing time of the run so far, s."""
        seconds = self.read_run().get("wall_s", 0.0)
        if not is_number(seconds):
            raise InputError(f"{self.run}: damaged: /wall_s: {seconds!r} is not a number")
        return float(seconds)


def check_empty(folder: PathLike) -> None:
    """Raise InputError unless results may be written to `folder`: it is new, or empty."""
    folder = Path(folder)
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder}: not a folder")
    if folder.is_dir() and any(folder.iterdir()):
        raise InputError(f"{folder}: not empty; choose a new folder, or go on with --resume")


def read_events(folder: PathLike) -> pd.DataFrame:
    """Read the table of events from a results folder.

    Raises
    ------
    InputError
        If the folder holds no events.csv, or it is no table of events.
    """
    path = Path(folder) / "events.csv"
    if not path.is_file():
        raise InputError(f"{folder}: no results; it holds no events.csv")
    table = read_csv(path)
    for name in ("event", "height_m"):
        if name not in table:
            raise InputError(f"{path}: not a table of events; no column {name}")
    for name in table.columns.intersection(list(EVENT_COLUMNS)).drop("ended", errors="ignore"):
        if table[name].dtype.kind not in "if" or np.isinf(table[name]).any():
            raise InputError(f"{path}: not a table of events; no finite numbers in a column {name}")
    return table


def _differences(one: Any, other: Any, path: str = "") -> list[str]:
    """Return the JSON paths at which two documents differ."""
    if isinstance(one, dict) and isinstance(other, dict):
        keys = sorted(one.keys() | other.keys())
        return [
            found for k in keys for found in _differences(one.get(k), other.get(k), f"{path}/{k}")
        ]
    return [] if one == other else [path]
