"""Runs whose snow makes a stack (thesis 3.1.1): slab after slab slides off onto what lies there.

Each event runs until the snow rests, or until ``events.max_time``; the table has the reason. Snow
rests once its speed (root mean square, as the core defines it) has been below
``events.rest_speed`` for ``events.rest_time``.
Between events the particles carry over with their state (``carry``), or the stack is converted to a
solid and reseeded at rest (``reseed``, as in the thesis). Reseeding also restores the bonds in the
stack, and gives it n times the slab's volume; conversions.csv has the changes of mass, height,
length and outline. A stack that is carried over ages (``snowshed.running.ageing``) only on request.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import Any, ClassVar, Optional

import snowshed._core as _core
from snowshed.base.arrays import Booleans, Floats
from snowshed.base.notes import ResultNote
from snowshed.io.vtk.vtp import read_particles
from snowshed.results.energies import write_energy_history
from snowshed.results.event_particles import read_event_particles
from snowshed.results.folder import (
    EVENT_COLUMNS,
    WORDS,
    RunFolder,
    measured_columns,
    parse_events,
)
from snowshed.results.reader import HISTORY
from snowshed.results.solids_file import write_solids
from snowshed.running.conversion import conversion_row
from snowshed.running.method_run import Cell, MethodRun
from snowshed.running.scene_notes import notes_of_end
from snowshed.running.sequence import record_note, seal_files
from snowshed.snow.stack.measure import StackMeasure
from snowshed.snow.stack.particles import measure_particles

MAX_RESIDUAL = 0.01  # of the largest energy
#: Columns of events.csv for the number of the event and the time of its computation.
ROW_KEYS = ("event", "wall_s")
KINDS: Mapping[str, type] = {**dict.fromkeys(WORDS, str), "event": int, "steps": int}


class StackRun(MethodRun):
    """Measures the stack after each event, and fills the tables of the results folder."""

    COLUMNS: ClassVar[Mapping[str, type]] = {
        name: KINDS.get(name, float) for name in EVENT_COLUMNS if name not in ROW_KEYS
    }

    def begin(self) -> None:
        """Record the ageing of the stack, or cut the tables to the checkpoint and check them."""
        self.results = RunFolder(self.folder)
        self.stack: Optional[StackMeasure] = None
        ageing = self.options.ageing
        ageing_data = None if ageing is None else ageing.data
        if ageing is not None and ageing_data is not None:
            self.sequence.set_ageing(json.dumps(ageing_data))
            for note in ageing.notes(self.scene.data["events"]["count"]):
                record_note(self.sequence, note)
        if self.options.resume:
            self._continue_tables(ageing_data)
        elif ageing_data is not None:
            self.results.write_ageing(ageing_data)
        self._fill_in(self.sequence.finished_events)

    def _continue_tables(self, ageing: Optional[dict[str, Any]]) -> None:
        event, results = self.simulation.event, self.results
        if ageing is not None and event == 0 and not results.ageing.exists():
            results.write_ageing(ageing)  # the run was killed before this
        results.check(ageing)
        results.keep_through(event, running=self.simulation.event_running)
        results.check_rows(self.sequence.tables, event)
        events = results.events
        if events.rows and not self.sequence.finished_events:  # of the version before
            work = int(events.total("steps")), events.total("wall_s")
            self.sequence.set_finished_work(*work)

    def _fill_in(self, finished: list[dict[str, Any]]) -> None:
        """Measure the events that the tables lack from their stored particles."""
        facts_of = {facts["event"]: facts for facts in finished}
        for event in self.results.missing_events(
            self.simulation.event - self.simulation.event_running
        ):
            if event not in facts_of:
                raise _core.InputError(
                    f"{self.results.run}: has no record of event {event} (written by an older "
                    "version); resume it with snowshed-run"
                )
            facts = facts_of[event]
            particles = read_particles(self.results.particles_of(event))
            positions = particles["position"].astype(float)
            on_panel = self.simulation.on_panel_at(positions, facts["laid_height_m"])
            masses, density = (particles[name].astype(float) for name in ("mass", "density"))
            self._record(facts, self._measure_particles(positions, masses, density, on_panel))
            if event == self.simulation.event_count:
                self._note_end()
        self._note_tables()

    def between_events(self) -> None:
        """Age the stack by the time since the last event."""
        if self.options.ageing is None:
            return
        gravity = float(self.scene.data["gravity"])
        row = self.options.ageing.apply(self.simulation, self.simulation.event + 1, gravity)
        if row is not None:
            self.results.ageings.add([row])

    def event_begun(self, reseeding: Optional[dict[str, Any]]) -> None:
        """Record the changes of the stack by reseeding."""
        if reseeding is not None:
            row = conversion_row(self.simulation.event, reseeding, self._measure_particles)
            self.results.conversions.add([row])

    def event_ended(self, facts: Mapping[str, Any]) -> None:
        """Measure the stack in memory."""
        self.stack = self._measure()
        self._record(facts, self.stack)
        self._note_residual(facts)
        if facts["event"] == self.simulation.event_count:
            self._note_end()

    def _note_end(self) -> None:
        for note in notes_of_end(parse_events(self.results.events.path), self.scene):
            record_note(self.sequence, note, ResultNote)

    def _note_residual(self, facts: Mapping[str, Any]) -> None:
        """Note that the time integration gained or lost too much energy."""
        share = facts["energy_residual"]
        if share is not None and share > MAX_RESIDUAL:
            note = (
                f"event {facts['event']}: the energy balance has a residual of {share:.2g} of the "
                f"largest energy, above {MAX_RESIDUAL:g}; a smaller courant_factor or dx may help"
            )
            record_note(self.sequence, note, ResultNote)

    def before_checkpoint(self) -> None:
        """Store the checksums of the tables, which are cut to the checkpoint when a run resumes.

        The energies over time are in the checkpoint, and written again when the run resumes.
        """
        if self.keeps_energy:
            self._write_history()
        self._note_tables()

    def finish(self) -> None:
        """Write the energies over time again, because `snowshed-run` does not."""
        if self.keeps_energy:
            self._write_history()
            self.sequence.rewrite_record()

    def draw(self) -> None:
        """Draw the present stack, its growth and the energies, and write the solids."""
        from snowshed.plot.figure_style import save_figure
        from snowshed.plot.stack_figures import growth_figure, stack_figure

        write_solids(self.scene, self.simulation.positions(), self.folder)
        stack, data = self.stack or self._measure(), self.scene.data
        save_figure(stack_figure(self.simulation, stack, data), self.results.stack_picture)
        events = parse_events(self.results.events.path)
        save_figure(growth_figure(events, data), self.results.growth_picture)
        self.draw_energies()
        self._draw_forces()

    def _draw_forces(self) -> None:
        """Draw the forces over time, if they are recorded and xarray is installed."""
        if not self.scene.data["output"]["forces"] or find_spec("xarray") is None:
            return
        from snowshed.plot.figure_style import save_figure
        from snowshed.plot.forces_figure import forces_figure
        from snowshed.results.obstacle_forces import on_obstacles, read_forces

        figure = forces_figure(on_obstacles(read_forces(self.folder)), self.scene.data)
        save_figure(figure, self.folder / "forces.png")

    @classmethod
    def rows(cls, folder: Path) -> list[dict[str, Cell]]:
        """Return the rows of events.csv, exactly."""
        table = RunFolder(folder).events.rows
        return [{name: _value(name, cell) for name, cell in row.items()} for row in table]

    @classmethod
    def stored_data(cls, folder: Path) -> Iterable[tuple[int, bytes]]:
        """Yield each event with the particles after it."""
        return ((event, particles.packed()) for event, particles in read_event_particles(folder))

    def _note_tables(self) -> None:
        event, running = self.simulation.event, self.simulation.event_running
        self.sequence.tables = self.results.checksums(self.sequence.tables, event, running=running)

    def _write_history(self) -> None:
        write_energy_history(self.simulation, self.folder)
        seal_files(self.sequence, self.folder, HISTORY)

    def _record(self, facts: Mapping[str, Any], stack: StackMeasure) -> None:
        event = facts["event"]
        self.results.add_outline(event, stack.outline)
        if facts["energy"]:
            self.results.energies.add([{"event": event, **facts["energy"]}])
        self.results.events.add([{**facts, **measured_columns(stack)}])

    def _measure(self) -> StackMeasure:
        core = self.simulation
        return self._measure_particles(
            core.positions(), core.masses(), core.densities(), core.on_panel()
        )

    def _measure_particles(
        self, positions: Floats, masses: Floats, density: Floats, on_panel: Booleans
    ) -> StackMeasure:
        return measure_particles(
            self.simulation, self.scene.data, positions, masses, density, on_panel
        )


def _value(name: str, cell: str) -> Cell:
    """Return the value of a cell of events.csv, exactly."""
    kind = KINDS.get(name, float)
    return None if kind is float and not cell else kind(cell)
