"""Several events (thesis 3.1.1): slab after slab slides off onto the growing stack.

The core runs the events and keeps the results folder; what is measured, drawn and aged is done
here, while it runs.

Each event runs until the snow rests: slower than ``events.rest_speed`` (root mean square, as the
core defines it) for ``events.rest_time``, or until ``events.max_time``, and the table says which.
Between events the particles carry over with their state (``carry``), or the stack is turned into a
solid and seeded afresh at rest (``reseed``, as in the thesis). Reseeding also makes the bonds in
the stack whole again, and gives it n times the slab's volume; conversions.csv says how far that
moved mass, height, length and outline. What time does to a stack that is carried over
(``snowshed.running.ageing``) is left out unless asked for.
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Optional

import snowshed._core as _core
from snowshed.base.arrays import Booleans, Floats
from snowshed.base.interrupt import InterruptRequest, deferred_interrupts
from snowshed.base.machine import machine_facts
from snowshed.base.progress import Progress, Reporter
from snowshed.io.vtk.vtp import read_particles
from snowshed.results.energies import draw_energies, write_energy_history
from snowshed.results.folder import RunFolder, measured_columns, parse_events, read_events
from snowshed.results.reader import HISTORY
from snowshed.results.solids_file import write_solids
from snowshed.running.ageing import Ageing
from snowshed.running.conversion import conversion_row
from snowshed.running.scene_notes import notes_after
from snowshed.running.sequence import (
    USER,
    NotePasser,
    open_sequence,
    run_sequence,
    say_note,
    seal_files,
)
from snowshed.scene.scene import PathLike, ResolvedScene, SceneLike, resolve_scene
from snowshed.snow.stack.measure import StackMeasure
from snowshed.snow.stack.particles import measure_particles

if TYPE_CHECKING:
    import pandas as pd


def run_events(
    scene: SceneLike,
    out_dir: PathLike,
    *,
    resume: bool = False,
    ageing: Optional[Ageing] = None,
    progress: Optional[Reporter] = None,
    pictures: bool = True,
) -> pd.DataFrame:
    """Let slab after slab slide off, measure the stack after each, and write a results folder.

    Parameters
    ----------
    scene
        What to simulate: a scene, its JSON data, or the path of a scene file.
    out_dir
        The results folder (see ``snowshed.results.folder``); new or empty, unless resuming.
    resume
        Go on from the checkpoint in `out_dir`, which ``snowshed-run`` may have written too; the
        particles are those of an uninterrupted run. Events that are missing in the tables are
        measured from their stored particles, in single precision.
    ageing
        What time does to the stack between the events; None: nothing. The same when resuming.
    progress
        Called with a `Progress` about twice a second.
    pictures
        Whether to draw ``stack.png``, ``growth.png`` and, with the energy balance, ``energy.png``
        at the end, and write ``solids.vtp``.

    Returns
    -------
    pandas.DataFrame
        One row per event, as in ``events.csv``.

    Raises
    ------
    InputError
        If the scene is wrong, the folder is not empty, or there is nothing to resume; nothing
        has been written then.
    SimulationError
        If the simulation cannot go on; a checkpoint holds its last good state.
    Interrupted
        After Ctrl-C; a checkpoint holds the state to resume from.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed import Scene
    >>> tiny = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    >>> tiny = tiny.update({"events": {"count": 1, "max_time": 0.1}})
    >>> with TemporaryDirectory() as folder:
    ...     table = run_events(tiny, folder, pictures=False)
    >>> table.event.tolist()
    [1]
    """
    ready = resolve_scene(scene)
    data: dict[str, Any] = ready.data
    if ageing is not None and data["events"]["between"] != "carry":
        raise _core.InputError('/events/between: "reseed" makes new snow of one that ages')
    results = RunFolder(out_dir)
    sequence = open_sequence(ready, out_dir, resume=resume)
    with sequence, deferred_interrupts() as interrupt:
        prepare = _continue_tables if resume else _begin_tables
        prepare(sequence, results, None if ageing is None else ageing.data)
        sequence.describe_machine(machine_facts())
        recorder = _Recorder(sequence, results, ageing, interrupt, progress)
        recorder.fill_in(sequence.finished_events)
        run_sequence(sequence, recorder, results.folder)
    if pictures:
        recorder.draw()
    return read_events(results.folder)


LARGEST_RESIDUAL = 0.01  # of the largest energy


def warn_of_residual(facts: Mapping[str, Any]) -> None:
    """Warn where the time integration gained or lost more energy than it should."""
    share = facts["energy_residual"]
    if share is not None and share > LARGEST_RESIDUAL:
        warnings.warn(
            f"event {facts['event']}: the energy balance has a residual of {share:.2g} of the "
            f"largest energy, above {LARGEST_RESIDUAL:g}; a smaller courant_factor or dx may help",
            FutureWarning,
            stacklevel=2,
        )


def _begin_tables(
    sequence: _core.EventSequence, results: RunFolder, ageing: Optional[dict[str, Any]]
) -> None:
    if ageing is not None:
        results.write_ageing(ageing)


def _continue_tables(
    sequence: _core.EventSequence, results: RunFolder, ageing: Optional[dict[str, Any]]
) -> None:
    simulation = sequence.simulation
    if simulation.event == 0 and not results.ageing.exists():  # killed before it was written
        _begin_tables(sequence, results, ageing)
    results.check(ageing)
    results.keep_through(simulation.event, running=simulation.event_running)
    results.check_rows(sequence.tables, simulation.event)
    events = results.events
    if events.rows and not sequence.finished_events:  # of the version before
        sequence.count_from(int(events.total("steps")), events.total("wall_s"))


class _Recorder(NotePasser):
    """Measures the stack after each event and fills the tables, as the core's loop tells it."""

    def __init__(
        self,
        sequence: _core.EventSequence,
        results: RunFolder,
        ageing: Optional[Ageing],
        interrupt: InterruptRequest,
        report: Optional[Reporter],
    ) -> None:
        self.sequence = sequence
        self.simulation = sequence.simulation
        self.results = results
        self.count = self.simulation.event_count
        self.ageing = ageing
        self.interrupt = interrupt
        self.report = report
        self.stack: Optional[StackMeasure] = None
        self.keeps_energy: bool = json.loads(self.simulation.scene)["output"]["energy"]

    def between_events(self) -> None:
        """Let the time since the last event pass."""
        if self.ageing is None:
            return
        row = self.ageing.apply(self.simulation, self.simulation.event + 1)
        if row is not None:
            self.results.ageings.add([row])

    def event_begun(self, reseeding: Optional[dict[str, Any]]) -> None:
        """Write down how far reseeding moved the stack."""
        if reseeding is not None:
            row = conversion_row(self.simulation.event, reseeding, self._measure_of)
            self.results.conversions.add([row])
        self._tell(self.simulation.time_s, 0.0)

    def progress(self, report: dict[str, Any]) -> None:
        """Pass on how far the event has come."""
        self._tell(report["time_s"], report["progress"], report["updates_per_s"])

    def before_checkpoint(self) -> None:
        """Note the checksums of the tables, which are cut to the checkpoint when a run goes on.

        The energies over time are in the checkpoint, and written again when it goes on.
        """
        if self.keeps_energy:
            write_energy_history(self.simulation, self.results.folder)
            seal_files(self.sequence, self.results.folder, HISTORY)
        self._note_tables()

    def _note_tables(self) -> None:
        event, running = self.simulation.event, self.simulation.event_running
        self.sequence.tables = self.results.checksums(self.sequence.tables, event, running=running)

    def stop_requested(self) -> bool:
        """Return whether to stop at the next safe point."""
        return self.interrupt.requested

    def event_ended(self, facts: dict[str, Any]) -> None:
        """Measure the stack as it is in memory."""
        self.stack = self._measure()
        self._record(facts, self.stack)
        warn_of_residual(facts)
        if facts["event"] == self.count:
            scene = json.loads(self.simulation.scene)
            for note in notes_after(parse_events(self.results.events.path), scene):
                say_note(self.sequence, note, USER + 1)
        self._tell(self.simulation.time_s, 1.0)

    def fill_in(self, finished: list[dict[str, Any]]) -> None:
        """Measure the events that the tables lack from their stored particles."""
        done = self.simulation.event - self.simulation.event_running
        facts_of = {facts["event"]: facts for facts in finished}
        for event in self.results.missing_events(done):
            if event not in facts_of:
                raise _core.InputError(
                    f"{self.results.run}: does not tell how event {event} went, for the version "
                    "before did not write it; go on with: snowshed-run"
                )
            facts = facts_of[event]
            particles = read_particles(self.results.particles_of(event))
            positions = particles["position"].astype(float)
            on_panel = self.simulation.on_panel_at(positions, facts["laid_height_m"])
            masses, density = (particles[name].astype(float) for name in ("mass", "density"))
            self._record(facts, self._measure_of(positions, masses, density, on_panel))
        self._note_tables()

    def draw(self) -> None:
        """Draw the pictures of the stack as it is now."""
        from snowshed.plot.figure_style import save
        from snowshed.plot.stack_figures import growth_figure, stack_figure

        scene = ResolvedScene.load(self.results.scene)
        write_solids(scene, self.simulation.positions(), self.results.folder)
        stack = self.stack or self._measure()
        save(stack_figure(self.simulation, stack), self.results.stack_picture)
        table = read_events(self.results.folder)
        save(growth_figure(table, self.simulation.scene), self.results.growth_picture)
        if self.keeps_energy:
            self._write_history()
            draw_energies(self.results.folder)

    def _write_history(self) -> None:
        """Write the energies over time again: `snowshed-run` does not."""
        write_energy_history(self.simulation, self.results.folder)
        seal_files(self.sequence, self.results.folder, HISTORY)
        self.sequence.rewrite_record()

    def _record(self, facts: Mapping[str, Any], stack: StackMeasure) -> None:
        event = facts["event"]
        self.results.add_outline(event, stack.outline)
        if facts["energy"]:
            self.results.energies.add([{"event": event, **facts["energy"]}])
        self.results.events.add([{**facts, **measured_columns(stack)}])

    def _measure(self) -> StackMeasure:
        return self._measure_of(
            self.simulation.positions(),
            self.simulation.masses(),
            self.simulation.densities(),
            self.simulation.on_panel(),
        )

    def _measure_of(
        self, positions: Floats, masses: Floats, density: Floats, on_panel: Booleans
    ) -> StackMeasure:
        return measure_particles(self.simulation, positions, masses, density, on_panel)

    def _tell(self, time_s: float, fraction: float, updates_per_s: float = 0.0) -> None:
        """Report where the run is; `fraction` is the part of the event that is done."""
        if self.report is None:
            return
        event = self.simulation.event
        ended = event - 1 + int(fraction == 1.0)
        self.report(
            Progress(
                (event - 1 + fraction) / self.count,
                ended,
                self.count,
                "events",
                f"{time_s:.2f} s of event {event}",
                event=event,
                time=time_s,
                updates_per_s=updates_per_s,
            )
        )
