"""One run: build a point's scene, run it to its end, and measure it."""

from __future__ import annotations

import math
import tempfile
import time
from pathlib import Path
from typing import Any, Optional

import numpy as np

from snowshed import _core
from validation.stress.conservation import Conservation
from validation.stress.scenes import build, max_event_duration
from validation.stress.space import Point

#: Steps between two samples of the balances.
STEPS_PER_SAMPLE = 16

#: Largest number of steps of an event over the planned number, because steps may become shorter.
PATIENCE = 4

Record = dict[str, Any]


def solve(point: Point, steps: int) -> Record:
    """Make one run and return its record.

    Parameters
    ----------
    point:
        A value for every parameter.
    steps:
        Planned number of steps of each event, in steps of the initial length.

    Returns
    -------
    dict
        ``ended``: the end of the last event (``rest``, ``time_limit``, ``step_limit``), or
        ``refused`` after an `InputError`, or ``stopped`` after a `SimulationError`; ``message``:
        the text of the error; and the measures of `tables.COLUMNS`.

    Examples
    --------
    >>> from validation.stress.space import reference
    >>> solve(reference(), steps=50)["ended"]
    'time_limit'
    """
    record: Record = {"ended": "", "message": ""}
    started = time.perf_counter()
    run: Optional[_Run] = None
    try:
        run = _Run(point, steps)
        record["ended"] = run.all_events()
    except _core.InputError as error:
        record.update(ended="refused", message=str(error))
    except _core.SimulationError as error:
        record.update(ended="stopped", message=str(error))
    record["wall_s"] = time.perf_counter() - started
    if run is not None:
        record.update(run.measures())
    return record


class _Run:
    """A simulation with its balances of momentum and energy."""

    def __init__(self, point: Point, steps: int) -> None:
        self.free = point["kind"] == "collide"
        self.max_steps = PATIENCE * steps
        self.first_step = _first_step(point)
        limit = min(max_event_duration(point), steps * self.first_step)
        scene = build(point, limit).resolve()
        data = scene.data
        self.gravity = float(data["gravity"])
        self.count = int(data["events"]["count"])
        self.simulation = _core.Simulation(scene.json)
        dx = float(data["numerics"]["dx"])
        self.conservation = Conservation(self.simulation, self.gravity, dx)
        self.smallest_dt = math.inf
        self.fastest = 0.0
        self.duration = 0.0
        self.mass_error = 0.0
        self.momentum_error = 0.0
        self.begun = b""  # checkpoint at the start of the present event

    def all_events(self) -> str:
        """Run the events, and return the end of the last one."""
        ended = ""
        for _ in range(self.count):
            ended = self._event()
            if ended == "step_limit":
                break
        return ended

    def _event(self) -> str:
        before = self.simulation.energy()
        old_mass = self.simulation.masses().sum()
        conversion = self.simulation.begin_event()
        if conversion is not None:
            after = float(np.sum(conversion["masses_after"]))
            self.mass_error = max(self.mass_error, abs(after / old_mass - 1.0))
        self.begun = _saved(self.simulation)
        self.conservation.begin(before)
        laid = self.simulation.masses()
        start, first = self.duration, self.simulation.total_steps

        def watch(report: dict[str, Any]) -> bool:
            self.smallest_dt = min(self.smallest_dt, report["dt_s"])
            self.duration = start + report["time_s"]
            taken = report["steps"] - first
            if taken % STEPS_PER_SAMPLE == 1:
                self.conservation.sample()
            return bool(taken < self.max_steps)

        ended = self.simulation.run(watch, 0.0)
        self.conservation.sample()
        self.duration = start + self.simulation.time_s
        if not np.array_equal(laid, self.simulation.masses()):
            self.mass_error = math.inf
        if self.free:
            error = self.conservation.momentum_error(self.simulation.time_s)
            self.momentum_error = max(self.momentum_error, error)
        return "step_limit" if ended == "interrupted" else ended

    def measures(self) -> Record:
        """Return the measures of the run up to its end, and whether it can be saved."""
        simulation = self.simulation
        speeds = np.linalg.norm(simulation.velocities(), axis=1)
        return {
            "particles": simulation.particle_count,
            "steps": simulation.total_steps,
            "rejected": simulation.rejected_steps,
            "updates": simulation.particle_updates,
            "time_s": self.duration,
            "first_dt_s": self.first_step,
            "smallest_dt_s": self.smallest_dt if math.isfinite(self.smallest_dt) else math.nan,
            "fastest_m_s": float(speeds.max()) if speeds.size else 0.0,
            "mass_error": self.mass_error,
            "momentum_error": self.momentum_error if self.free else math.nan,
            **self.conservation.energy_errors(),
            "finite": _is_finite(simulation),
            "checkpoint": self._leaves_a_checkpoint(),
        }

    def _leaves_a_checkpoint(self) -> bool:
        """Return whether a sound checkpoint remains: the present one, or else the previous one.

        A simulation with unsound particles cannot be saved. The previous checkpoint then remains.
        """
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "checkpoint.bin"
            path.write_bytes(self.begun)
            try:
                self.simulation.save(str(path))
            except _core.SimulationError:
                return path.read_bytes() == self.begun and _is_sound(path)
            return _is_sound(path, self.simulation)


def _first_step(point: Point) -> float:
    """Return the length of the first step, s."""
    simulation = _core.Simulation(build(point).resolve().json)
    simulation.begin_event()
    simulation.step(1)
    return simulation.time_step_s


def _is_finite(simulation: _core.Simulation) -> bool:
    density = simulation.densities()
    values = (
        simulation.positions(),
        simulation.velocities(),
        simulation.pressures(),
        density,
        np.array(list(simulation.energy().values())),
    )
    return all(bool(np.isfinite(v).all()) for v in values) and bool((density > 0).all())


def _is_sound(checkpoint: Path, simulation: Optional[_core.Simulation] = None) -> bool:
    """Return whether a checkpoint loads with finite snow, and equals the simulation if given."""
    try:
        again = _core.Simulation.load(str(checkpoint))
    except (OSError, _core.InputError):
        return False
    if simulation is not None and not np.array_equal(again.positions(), simulation.positions()):
        return False
    return _is_finite(again)


def _saved(simulation: _core.Simulation) -> bytes:
    """Return a checkpoint of the present state."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "checkpoint.bin"
        simulation.save(str(path))
        return path.read_bytes()
