"""The multi-event loop (thesis 3.1.1): slab after slab slides off onto the growing stack.

Each event runs until the snow rests: slower than ``events.rest_speed`` (root mean square, as the
core defines it) for ``events.rest_time``, or until ``events.max_time``, and the table says which.
Between events the particles carry over with their state (``carry``), or the stack is turned into a
solid and seeded afresh at rest (``reseed``, as in the thesis). Reseeding also makes the bonds in
the stack whole again, and gives it n times the slab's volume; conversions.csv says how far that
moved mass, height, length and outline. What time does to a stack that is carried over
(``snowshed.run.ageing``) is left out unless asked for.
"""

from __future__ import annotations

import json
import platform
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional, Union

from snowshed import _core
from snowshed.io.arrays import Booleans, Floats
from snowshed.io.atomic import replacing
from snowshed.run.ageing import Ageing
from snowshed.run.conversion import conversion_row
from snowshed.run.interrupt import Interrupted, InterruptRequest, deferred_interrupts
from snowshed.run.machine import cpu_name, peak_memory_mb
from snowshed.run.results import Results, check_empty, measured_columns, read_events
from snowshed.scene.scene import PathLike, ResolvedScene, Scene
from snowshed.snow.stack.measure import StackMeasure, measure_stack

if TYPE_CHECKING:
    import pandas as pd

REPORT_INTERVAL = 0.5  # s of wall time between progress reports


@dataclass(frozen=True)
class Progress:
    """How far a run has come.

    Attributes
    ----------
    event, count
        The event that runs, from 1, and how many there will be.
    time
        Simulated time in this event, s.
    fraction
        Estimated part of this event that is done, 0 to 1.
    updates_per_s
        Particle updates per second.
    """

    event: int
    count: int
    time: float = 0.0
    fraction: float = 0.0
    updates_per_s: float = 0.0


Reporter = Callable[[Progress], None]


def run_events(
    scene: Union[Scene, ResolvedScene],
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
        What to simulate.
    out_dir
        The results folder (see ``snowshed.run.results``); new or empty, unless resuming.
    resume
        Go on from the checkpoint in `out_dir`; the results are those of an uninterrupted run.
    ageing
        What time does to the stack between the events; None: nothing. The same when resuming.
    progress
        Called with a `Progress` about twice a second.
    pictures
        Whether to draw ``stack.png`` and ``growth.png`` at the end.

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
    >>> tiny = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    >>> tiny = tiny.update({"events": {"count": 1, "max_time": 0.1}})
    >>> with TemporaryDirectory() as folder:
    ...     table = run_events(tiny, folder, pictures=False)
    >>> table.event.tolist()
    [1]
    """
    ready = scene.resolve() if isinstance(scene, Scene) else scene
    data: dict[str, Any] = ready.data
    if ageing is not None and data["events"]["between"] != "carry":
        raise _core.InputError('/events/between: "reseed" makes new snow of one that ages')
    open_run = _reopen if resume else _create
    simulation, results = open_run(ready, out_dir, None if ageing is None else ageing.data)
    with deferred_interrupts() as interrupt:
        loop = _EventLoop(simulation, results, ready, ageing, interrupt, progress)
        loop.run()
    if pictures:
        loop.draw()
    return read_events(results.folder)


def _create(
    scene: ResolvedScene, folder: PathLike, ageing: Optional[dict[str, Any]]
) -> tuple[_core.Simulation, Results]:
    check_empty(folder)
    simulation = _core.Simulation(scene.json, scene.base_dir)
    simulation.begin_event()  # seeding may fail too, and then nothing must be left behind
    return simulation, Results.create(folder, scene, ageing)


def _reopen(
    scene: ResolvedScene, folder: PathLike, ageing: Optional[dict[str, Any]]
) -> tuple[_core.Simulation, Results]:
    results = Results.reopen(folder, scene, ageing)
    if results.checkpoint.exists():
        simulation = _core.Simulation.load(str(results.checkpoint))
    else:
        simulation = _core.Simulation(scene.json, scene.base_dir)
    results.keep_through(simulation.event, running=simulation.event_running)
    done, listed = simulation.event - simulation.event_running, len(results.events.rows)
    if done and not results.events.path.exists():
        raise _core.InputError(f"{folder}: made by snowshed-run, which must resume it")
    if listed < done:
        raise _core.InputError(
            f"{results.events.path}: damaged: holds {listed} events, but {done} are done"
        )
    return simulation, results


class _EventLoop:
    """One run of the loop: a simulation, the results it fills, and the clock."""

    def __init__(
        self,
        simulation: _core.Simulation,
        results: Results,
        scene: ResolvedScene,
        ageing: Optional[Ageing],
        interrupt: InterruptRequest,
        report: Optional[Reporter],
    ) -> None:
        self.simulation = simulation
        self.results = results
        self.scene: dict[str, Any] = json.loads(scene.json)
        self.count = int(self.scene["events"]["count"])
        self.ageing = ageing
        self.interrupt = interrupt
        self.report = report
        self.stack: Optional[StackMeasure] = None
        self.checkpoint_at = time.monotonic()
        self.started = time.monotonic() - results.earlier_wall_s()
        if interval := self.scene["output"]["snapshot_interval"]:
            simulation.set_snapshots(str(results.snapshots), interval)

    def run(self) -> None:
        """Run the events that are left."""
        try:
            while self.simulation.event_running or self.simulation.event < self.count:
                if self.interrupt.requested:
                    self._stop()
                self._begin()
                self._record(self._advance())
                self._checkpoint("running")
        except (_core.SimulationError, _core.InputError) as error:
            self._checkpoint("failed", error=str(error))
            raise
        self._checkpoint("finished")

    def draw(self) -> None:
        """Draw the pictures of the stack as it is now."""
        from snowshed.plot.figure_style import save
        from snowshed.plot.stack_figures import growth_figure, stack_figure

        stack = self.stack or self._measure()
        save(stack_figure(self.simulation, stack), self.results.stack_picture)
        table = read_events(self.results.folder)
        save(growth_figure(table, self.simulation.scene), self.results.growth_picture)

    def _begin(self) -> None:
        if not self.simulation.event_running:
            self._age()
            conversion = self.simulation.begin_event()
            if conversion is not None:
                row = conversion_row(self.simulation.event, conversion, self._measure_of)
                self.results.conversions.add([row])
        self._tell(Progress(self.simulation.event, self.count, self.simulation.time_s))

    def _age(self) -> None:
        """Let the time since the last event pass."""
        if self.ageing is None or not self.simulation.event:
            return
        row = self.ageing.apply(self.simulation, self.simulation.event + 1)
        if row is not None:
            self.results.ageings.add([row])

    def _advance(self) -> str:
        """Run the event to its end; return how it ended."""
        while True:
            ended = self.simulation.run(self._on_report, REPORT_INTERVAL)
            if ended == "interrupted":
                self._stop()
            if ended != "checkpoint":
                return ended
            self._checkpoint("running")

    def _on_report(self, info: dict[str, Any]) -> Union[bool, str]:
        self._tell(
            Progress(
                self.simulation.event,
                self.count,
                info["time_s"],
                info["progress"],
                info["updates_per_s"],
            )
        )
        if self.interrupt.requested:
            return False
        interval = self.scene["output"]["checkpoint_interval"]
        due = interval > 0 and time.monotonic() - self.checkpoint_at > interval
        return "checkpoint" if due else True

    def _record(self, ended: str) -> None:
        """Measure the stack and write everything about the event that has just ended."""
        event = self.simulation.event
        self.stack = self._measure()
        with replacing(self.results.particles_of(event)) as beside:
            self.simulation.write_vtk(str(beside))
        self.results.add_outline(event, self.stack.outline)
        if self.scene["output"]["energy"]:
            self.results.energies.add([{"event": event, **self.simulation.energy()}])
        events = self.results.events
        row = {
            **measured_columns(self.stack),
            "event": event,
            "sim_time_s": self.simulation.time_s,
            "steps": self.simulation.total_steps - int(events.total("steps")),
            "wall_s": max(self._wall() - events.total("wall_s"), 0.0),
            "ended": ended,
        }
        events.add([row])
        self.results.write_series()
        self._tell(Progress(event, self.count, self.simulation.time_s, 1.0))

    def _measure(self) -> StackMeasure:
        return self._measure_of(
            self.simulation.positions(),
            self.simulation.masses(),
            self.simulation.density(),
            self.simulation.on_panel(),
        )

    def _measure_of(
        self, positions: Floats, masses: Floats, density: Floats, on_panel: Booleans
    ) -> StackMeasure:
        return measure_stack(
            positions,
            masses,
            density,
            dimension=self.simulation.dimension,
            dx=self.scene["numerics"]["dx"],
            ground_tilt_deg=self.simulation.ground_tilt_deg,
            exclude=on_panel,
        )

    def _stop(self) -> None:
        self._checkpoint("interrupted")
        raise Interrupted(self.results.folder)

    def _checkpoint(self, status: str, **more: str) -> None:
        with replacing(self.results.checkpoint) as beside:
            self.simulation.save(str(beside))
        self.results.write_run({**self._facts(), "status": status, **more})
        self.checkpoint_at = time.monotonic()

    def _facts(self) -> dict[str, Any]:
        """Return what run.json says about the run so far."""
        wall = self._wall()
        updates = self.simulation.particle_updates
        return {
            "version": _core.version,
            "machine": platform.platform(),
            "cpu": cpu_name(),
            "threads": self.simulation.threads,
            "scalar": self.scene["numerics"]["precision"],
            "dimension": self.simulation.dimension,
            "events": len(self.results.events.rows),
            "particles": self.simulation.particle_count,
            "steps": self.simulation.total_steps,
            "particle_updates": updates,
            "slept_updates": self.simulation.slept_updates,
            "updates_per_s": updates / wall if wall else 0.0,
            "peak_memory_mb": round(peak_memory_mb(), 1),
            "wall_s": wall,
        }

    def _wall(self) -> float:
        """Return the wall time of the run, with that before it was resumed, s."""
        return time.monotonic() - self.started

    def _tell(self, progress: Progress) -> None:
        if self.report is not None:
            self.report(progress)
