"""The results folder of a run: its files, and their checks.

================== ==========================================================================
scene.json         the complete scene that made the results
events.csv         one row per event: `EVENT_COLUMNS`
outline.csv        profile of the stack after each event: event, x, z
conversions.csv    changes of the stack by reseeding (only with between = "reseed")
ageing.csv         changes of the stack by ageing between events (only if it aged); its settings
                   and times are in ageing.json
energy.csv         energy balance at the end of each event (only with output.energy)
energy_history.csv the same over time, with energy.png, a picture of it
run.json           version, machine, size, speed and status of the run, and a record of each event
checkpoint.bin     the state from which the run resumes
particles/         the particles after each event (.vtp); ``particles.pvd`` opens them as a series
forces.csv         forces on each obstacle over time, as means since the row before (only with
                   output.forces), with forces.png, a picture of them
loads.csv          loads on each obstacle in each event: at rest, peaks and impulse
pressures/         pressures on the faces of obstacles after each event (.vtp)
film.bin           the particles over time, for `snowshed view` (unless output.film = false)
solids.vtp         panel, ground and obstacles as triangles
snapshots/         particle snapshots during the events (only with output.snapshot_interval)
stack.png          side view of the last stack
growth.png         height, length, head and tail against the event
================== ==========================================================================

``snowshed-run`` writes the same folder without tables and pictures; ``snowshed run --resume`` adds
them. Measures in added tables come from the stored particles, in single precision: their last
digits may differ from measures during a run. conversions.csv has no rows of events that
``snowshed-run`` began.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats
from snowshed.base.paths import PathLike
from snowshed.base.units import with_units
from snowshed.io.atomic import write_text
from snowshed.io.csv_table import Table, read_csv
from snowshed.io.input_file import read_input
from snowshed.io.json_file import read_object
from snowshed.io.run_files import (
    check_run_file,
    issue_unfinished_note,
    origin_of_record,
    read_run_record,
)
from snowshed.scene.resolved import ResolvedScene
from snowshed.snow.stack.measure import StackMeasure
from snowshed.snow.stack.quantities import MEASURES, QUANTITIES
from snowshed.snow.stack.trimming import TRIMMINGS

if TYPE_CHECKING:
    import pandas as pd

CONVERSION_COLUMNS = (
    "event",
    "mass_before_kg",
    "mass_after_kg",
    "particles_before",
    "particles_after",
    "height_before_m",
    "height_after_m",
    "length_before_m",
    "length_after_m",
    "outline_rms_m",
)
AGEING_COLUMNS = (
    "event",
    "hours",
    "temperature_c",
    "crest_sank_m",
    "density_before_kg_m3",
    "density_kg_m3",
    "intact_before",
    "intact",
)
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
    "damping_rate_per_s",
    "trimming",
    *(MEASURES[name].column(quantity) for name in TRIMMINGS for quantity in QUANTITIES),
    "on_structures_kg",
    "joined",
    "centre_height_m",
    "spread_m",
)
#: Checksums by table; each covers the rows up to an event, whose number is its key.
Checksums = Mapping[str, Mapping[str, str]]
SCENE, EVENTS, ENERGY = "scene.json", "events.csv", "energy.csv"
#: Columns that hold texts.
WORDS = ("ended", "trimming")


def measured_columns(stack: StackMeasure) -> dict[str, Union[float, str]]:
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
        "trimming": stack.trimming,
        **{
            MEASURES[name].column(quantity): getattr(extent, quantity)
            for name, extent in stack.trimmed.items()
            for quantity in QUANTITIES
        },
        "on_structures_kg": stack.on_structures_mass,
        "joined": int(stack.joined),
        "centre_height_m": stack.centre_height,
        "spread_m": stack.spread,
    }


class RunFolder:
    """The results folder of a run and the tables in it.

    The core writes the scene, the particles, the checkpoint and run.json
    (``_core.EventSequence``); the tables are written here.
    """

    def __init__(self, folder: PathLike) -> None:
        self.folder = Path(folder)
        self.scene = self.folder / SCENE
        self.checkpoint = self.folder / "checkpoint.bin"
        self.run = self.folder / "run.json"
        self.ageing = self.folder / "ageing.json"
        self.stack_picture = self.folder / "stack.png"
        self.growth_picture = self.folder / "growth.png"
        self.events = Table(self.folder / EVENTS, EVENT_COLUMNS)
        self.outlines = Table(self.folder / "outline.csv", ("event", "x", "z"))
        self.conversions = Table(self.folder / "conversions.csv", CONVERSION_COLUMNS)
        self.ageings = Table(self.folder / "ageing.csv", AGEING_COLUMNS)
        self.energies = Table(self.folder / ENERGY)

    @property
    def names(self) -> frozenset[str]:
        """The names of these files."""
        held = (part for part in vars(self).values() if part is not self.folder)
        return frozenset((part.path if isinstance(part, Table) else part).name for part in held)

    def write_ageing(self, ageing: Mapping[str, Any]) -> None:
        """Record the ageing of the stack between the events."""
        write_text(self.ageing, json.dumps(ageing, indent=2) + "\n")

    def check(self, ageing: Optional[Mapping[str, Any]]) -> None:
        """Raise InputError if the tables are damaged, or the ageing settings differ."""
        if (read_object(self.ageing) if self.ageing.is_file() else None) != ageing:
            raise InputError(
                f"{self.ageing}: ageing settings differ from those of the run being resumed"
            )
        if self.events.rows:
            parse_events(self.events.path)

    def missing_events(self, done: int) -> range:
        """Return the events that are done but not yet in the table."""
        listed = len(self.events.rows)
        if [int(row["event"]) for row in self.events.rows] != list(range(1, listed + 1)):
            raise InputError(f"{self.events.path}: damaged: its events are not 1, 2, ...")
        return range(listed + 1, done + 1)

    def keep_through(self, event: int, *, running: bool) -> None:
        """Drop the rows of events after `event`, and of `event` itself if it still runs."""
        self.events.keep_through(event - 1 if running else event)
        for table in (self.outlines, self.energies):  # an event's own row is written last
            table.keep_through(len(self.events.rows))
        self.conversions.keep_through(event)
        self.ageings.keep_through(event)

    def checksums(
        self, known: Checksums, event: int, *, running: bool
    ) -> dict[str, dict[str, str]]:
        """Return the `known` checksums and those of rows that a checkpoint of `event` includes."""
        done = event - 1 if running else event
        sums_by_table = {name: dict(sums) for name, sums in known.items()}
        for table in self._tables():
            through = done if table in self._ended_tables() else event
            of_table = sums_by_table.get(table.path.name, {})
            for later in [at for at in of_table if at.isdecimal() and int(at) > through]:
                del of_table[later]  # of events that are run again
            table.fill_columns()
            if through > 0:
                sums_by_table.setdefault(table.path.name, {})[str(through)] = table.checksum(
                    through
                )
        return sums_by_table

    def check_rows(self, known: Checksums, event: int) -> None:
        """Raise InputError if a table lacks rows of the run, or has other rows.

        Rows of ended events that no checksum covers are dropped and measured again. A run of the
        previous version has no checksums.
        """
        if not known:
            return
        self.missing_events(event)  # raises unless the events are numbered one after another
        ended = _last_known(known.get(self.events.path.name, {}), len(self.events.rows))
        for table in self._tables():
            sums = known.get(table.path.name, {})
            has_ended_events = table in self._ended_tables()
            through = ended if has_ended_events else _last_known(sums, event)
            if has_ended_events:
                table.keep_through(ended)
            if str(through) in sums and table.checksum(through) != sums[str(through)]:
                raise InputError(
                    f"{table.path}: damaged: its rows through event {through} are not those that "
                    "the run wrote"
                )

    def _ended_tables(self) -> tuple[Table, ...]:
        """Return the tables of events that have ended, which are written together."""
        return (self.events, self.outlines, self.energies)

    def _tables(self) -> tuple[Table, ...]:
        return (*self._ended_tables(), self.conversions, self.ageings)

    def add_outline(self, event: int, outline: Floats) -> None:
        """Add the profile (k, 2) of the stack after an event."""
        self.outlines.add({"event": event, "x": x, "z": z} for x, z in outline.tolist())

    def particles_of(self, event: int) -> Path:
        """Return the file of the particles after an event."""
        return self.folder / "particles" / f"event_{event:03d}.vtp"

    def read_run(self) -> dict[str, Any]:
        """Return the content of run.json; empty before the run has written it."""
        return read_object(self.run) if self.run.exists() else {}


def _last_known(sums: Mapping[str, str], event: int) -> int:
    """Return the last event up to `event` that has a checksum; 0 if none has."""
    return max((int(at) for at in sums if at.isdecimal() and int(at) <= event), default=0)


@checked
def read_events(folder: PathLike) -> pd.DataFrame:
    """Read the table of events from a results folder.

    Its `attrs` have the scene, the version and the build of snowshed that made it, if known, and
    the units of its columns. A note says if the run is not finished.

    Raises
    ------
    InputError
        If the folder holds no events.csv, or the file is not the table of events that the run
        wrote, or scene.json is not the scene of the run.
    """
    table = event_table(Path(folder))
    issue_unfinished_note(Path(folder))
    record = read_run_record(Path(folder))
    if (Path(folder) / SCENE).is_file():
        table.attrs["scene"] = read_scene(folder).json
    table.attrs.update(origin_of_record(record) if record else {})
    return table


def event_table(folder: Path) -> pd.DataFrame:
    """Return the table of `read_events` with the units of its columns, but without the scene."""
    path = folder / EVENTS
    if not path.is_file():
        raise InputError(f"{folder}: no results; it holds no events.csv")
    check_run_file(path)
    return with_units(parse_events(path))


def read_scene(folder: PathLike) -> ResolvedScene:
    """Read the complete scene of the run in a results folder.

    Raises
    ------
    InputError
        If scene.json is missing or damaged, or not the scene of the run.
    """
    path = Path(folder) / SCENE
    scene = ResolvedScene.load(path)
    known = read_run_record(Path(folder)).get("scene_checksum")
    if known and _core.scene_checksum(read_input(path).decode()) != known:
        raise InputError(f"{path}: damaged: it is not the scene of the run")
    return scene


def parse_events(path: Path) -> pd.DataFrame:
    """Read a table of events during its run, before it has a checksum.

    Raises
    ------
    InputError
        If it is not a table of events.
    """
    table = read_csv(path)
    for name in ("event", "height_m"):
        if name not in table:
            raise InputError(f"{path}: not a table of events; no column {name}")
    for name in table.columns.intersection(list(EVENT_COLUMNS)).drop(list(WORDS), errors="ignore"):
        if table[name].dtype.kind not in "if" or np.isinf(table[name]).any():
            raise InputError(f"{path}: not a table of events; no finite numbers in a column {name}")
    return table
