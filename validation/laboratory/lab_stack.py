"""The laboratory's stack, run and measured, and what was recorded of it as a reference.

Stacks have no exact answer. They are compared with the mean over seedings on the finest grid that
was affordable. Those runs take hours, so they were made once, by `record`, and lie beside this
module in ``lab_stack.json``, each with its settings, version and date.
"""

from __future__ import annotations

import datetime
import json
import time
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, Optional

import numpy as np

from snowshed import _core
from snowshed.analysis.accuracy.measurements import Measured, Settings, Value
from snowshed.base.arrays import Booleans, Floats
from snowshed.io.atomic import write_text
from snowshed.results.folder import measured_columns
from snowshed.running.conversion import outline_difference
from snowshed.scene.scene import Scene
from snowshed.snow.stack.measure import StackMeasure, measure_stack
from snowshed.snow.stack.quantities import MEASURES
from validation.framework.case import Outcome
from validation.framework.drive import absolute, apply_settings

#: The reading of A.4.2 by which the recorded stacks were measured; others are compared with them.
TRIMMING = "equal_pace"
#: Columns of events.csv that are compared, by the names they have here.
COMPARED: Mapping[str, str] = {
    f"{measure.prefix}{quantity}": measure.column(quantity)
    for measure in (MEASURES["stack"], MEASURES["body"])
    for quantity in ("height", "length")
}

#: Settings of the events, and where they lie in a scene.
EVENTS: Mapping[str, str] = {"events": "events.count", "between": "events.between"}

#: What the reference is made with besides the defaults: no snow sleeps.
AWAKE: Settings = {"sleep_speed": 0.0}

#: The runs of the reference: dimension, dx in m, seedings.
RECORDED: Sequence[tuple[int, float, int]] = (
    (2, 0.02, 12),
    (2, 0.01, 12),
    (2, 0.005, 6),
    (2, 0.0025, 4),
    (3, 0.02, 8),
    (3, 0.01, 4),
    (3, 0.005, 1),
)

FILE = Path(__file__).with_name("lab_stack.json")


@dataclass(frozen=True)
class Conversion:
    """A stack before and after reseeding.

    Attributes
    ----------
    before, after
        The stack.
    mass_before, mass_after
        Of all snow, that on the panel included, kg.
    particles_after
        How many it is made of then.
    """

    before: StackMeasure
    after: StackMeasure
    mass_before: float
    mass_after: float
    particles_after: int

    def change(self, name: str) -> float:
        """Return by how much one of `COMPARED` grew, m."""
        return measure_of(self.after, name) - measure_of(self.before, name)

    @property
    def loose_change(self) -> float:
        """By how much the part of the snow that lies outside the largest body grew."""
        shares = [stack.detached_mass / stack.mass for stack in (self.before, self.after)]
        return shares[1] - shares[0]

    @property
    def outline_moved(self) -> float:
        """Root mean square of the change in height of the outline, m."""
        return outline_difference(self.before.outline, self.after.outline)


@dataclass
class LabRun:
    """The results of a run of the laboratory scene.

    Attributes
    ----------
    stacks
        The stack after each event.
    conversions
        What reseeding did before each event but the first.
    ended
        How each event ended.
    mass
        Of all snow at the end, kg (per metre of width in 2D).
    brought_mass
        Of all slabs, from their volume and density, kg.
    particle_mass
        Of a particle of snow at its initial density, as the slabs are seeded, kg.
    wall_s
        Time of the solution alone, s.
    """

    stacks: list[StackMeasure] = field(default_factory=list)
    conversions: list[Conversion] = field(default_factory=list)
    ended: list[str] = field(default_factory=list)
    mass: float = 0.0
    brought_mass: float = 0.0
    particle_mass: float = 0.0
    wall_s: float = 0.0
    updates: int = 0
    steps: int = 0
    particles: int = 0

    def series(self, name: str) -> list[float]:
        """Return one of `COMPARED` after each event, m."""
        return [measure_of(stack, name) for stack in self.stacks]


def measure_of(stack: StackMeasure, name: str) -> float:
    """Return one of `COMPARED` of a stack, m."""
    return float(measured_columns(stack)[COMPARED[name]])


def lab_scene(settings: Settings) -> Scene:
    """Return the scene: preset lab-50 in 2D, panel friction 0.3, one thread, and the settings.

    Snow at rest sleeps as it does by default, since stacks are what users run.

    Examples
    --------
    >>> lab_scene({"dx": 0.02, "events": 2}).events.count
    2
    """
    scene = Scene.preset("lab-50").update({"dimension": 2, "panel.friction": 0.3})
    scene.update({path: settings[name] for name, path in EVENTS.items() if name in settings})
    return apply_settings(scene, settings, own=EVENTS, sleeping=True)


def run_lab(settings: Settings) -> LabRun:
    """Let the slabs slide off one after the other and measure the stack after each.

    Parameters
    ----------
    settings
        For `lab_scene`.

    Examples
    --------
    >>> run_lab({"dx": 0.02, "events": 1}).ended
    ['rest']
    """
    ready = lab_scene(settings).resolve()
    simulation = _core.Simulation(ready.json)
    data: dict[str, Any] = ready.data
    tape = _Tape(simulation, data)
    run = LabRun(brought_mass=_brought_mass(data), particle_mass=_particle_mass(data))
    for _ in range(data["events"]["count"]):
        reseeded = simulation.begin_event()
        if reseeded is not None:
            run.conversions.append(tape.measure_conversion(reseeded))
        started = time.perf_counter()
        run.ended.append(simulation.run(lambda info: True))
        run.wall_s += time.perf_counter() - started
        run.stacks.append(tape.measure_present())
    run.mass = float(simulation.masses().sum())
    run.updates, run.steps = simulation.particle_updates, simulation.total_steps
    run.particles = simulation.particle_count
    return run


def run_seedings(settings: Settings) -> list[LabRun]:
    """Run the scene with each of ``seedings`` seeds from ``seed`` on (one, from 1)."""
    rest = {name: value for name, value in settings.items() if name not in ("seedings", "seed")}
    first, count = int(settings.get("seed", 1)), int(settings.get("seedings", 1))
    return [run_lab({**rest, "seed": seed}) for seed in range(first, first + count)]


def outcome_of(runs: Sequence[LabRun], measured: Sequence[Measured]) -> Outcome:
    """Return the outcome of several seedings; the cost is the mean of one run."""
    return Outcome(
        measured,
        wall_s=float(np.mean([run.wall_s for run in runs])),
        updates=round(np.mean([run.updates for run in runs])),
        steps=round(np.mean([run.steps for run in runs])),
        particles=round(np.mean([run.particles for run in runs])),
    )


class _Tape:
    """Measures the stack of a simulation."""

    def __init__(self, simulation: _core.Simulation, scene: Mapping[str, Any]) -> None:
        self._simulation = simulation
        self._dx = float(scene["numerics"]["dx"])

    def measure_present(self) -> StackMeasure:
        """Measure the stack as it is."""
        now = self._simulation
        return self._measure(now.positions(), now.masses(), now.on_panel(), now.densities())

    def measure_conversion(self, reseeded: Mapping[str, Any]) -> Conversion:
        """Measure what the core says of a conversion: the snow before and after."""
        masses = {when: reseeded[f"masses_{when}"] for when in ("before", "after")}
        stacks = {
            when: self._measure(
                reseeded[f"positions_{when}"],
                masses[when],
                reseeded[f"on_panel_{when}"],
                reseeded[f"densities_{when}"],
            )
            for when in masses
        }
        return Conversion(
            **stacks,
            mass_before=float(masses["before"].sum()),
            mass_after=float(masses["after"].sum()),
            particles_after=len(masses["after"]),
        )

    def _measure(
        self, positions: Floats, masses: Floats, on_panel: Booleans, density: Floats
    ) -> StackMeasure:
        dimension = self._simulation.dimension
        return measure_stack(
            positions,
            masses,
            density,
            dimension=dimension,
            dx=self._dx,
            exclude=on_panel,
            trimming=TRIMMING,
        )


def _brought_mass(scene: Mapping[str, Any]) -> float:
    slab = scene["slab"]
    width = slab["width"] if scene["dimension"] == 3 else 1.0
    volume = slab["thickness"] * slab["length"] * width
    return float(scene["events"]["count"] * volume * scene["snow"]["density"])


def _particle_mass(scene: Mapping[str, Any]) -> float:
    voxel = scene["numerics"]["dx"] ** scene["dimension"]
    return float(scene["snow"]["density"] * voxel / scene["seeding"]["particles_per_voxel"])


@dataclass(frozen=True)
class Recorded:
    """Recorded stacks of one dimension and dx; every series has one value for each event.

    Attributes
    ----------
    dx
        Size of the grid cells, m.
    runs
        For each of `COMPARED`, (seedings, events) in m.
    """

    dx: float
    runs: Mapping[str, Floats]

    def mean(self, name: str, event: int) -> float:
        """Return the mean over seedings of a measure after an event, m."""
        return float(self.runs[name][:, event - 1].mean())

    def spread(self, name: str, event: int) -> float:
        """Return the standard deviation between seedings of a measure after an event, m."""
        return float(self.runs[name][:, event - 1].std(ddof=1))


def noise(name: str, runs: Sequence[LabRun], settings: Settings) -> Measured:
    """Compare the mean of the last stacks with the recorded ones on the same grid.

    Parameters
    ----------
    name
        One of `COMPARED`.
    runs
        With the settings, each with a seed of its own.
    settings
        For `lab_scene`.

    Returns
    -------
    Measured
        Of the quantity ``<name>_noise``: the departure in standard deviations between the recorded
        seedings.
    """
    there, event = recorded(int(settings["dimension"]), float(settings["dx"])), len(runs[0].stacks)
    value = float(np.mean([run.series(name)[-1] for run in runs]))
    departure = (value - there.mean(name, event)) / there.spread(name, event)
    return absolute(f"{name}_noise", departure, 0.0)


def recorded(dimension: int, dx: Optional[float] = None) -> Recorded:
    """Return the recorded stacks on a grid, or on the finest one of that dimension.

    Raises
    ------
    LookupError
        If nothing was recorded on that grid.

    Examples
    --------
    >>> recorded(2).dx
    0.0025
    """
    runs = [run for run in _read() if run["dimension"] == dimension]
    wanted = min(run["dx"] for run in runs) if dx is None else dx
    chosen = [run for run in runs if np.isclose(run["dx"], wanted)]
    if not chosen:
        known = sorted({run["dx"] for run in runs})
        raise LookupError(f"no stacks recorded in {dimension}D at dx {dx}; there are {known}")
    series = {name: np.array([run[name] for run in chosen]) for name in COMPARED}
    return Recorded(float(wanted), series)


@lru_cache(maxsize=1)
def _read() -> list[dict[str, Any]]:
    runs: list[dict[str, Any]] = json.loads(FILE.read_text(encoding="utf-8"))["runs"]
    return runs


def record(
    path: Path = FILE, grids: Iterable[tuple[int, float, int]] = RECORDED, **settings: Value
) -> None:
    """Make the reference anew: five events on each grid with each seeding, hours in all.

    The file is written after each run. Runs that it holds already, of the same version, are kept.

    Parameters
    ----------
    path
        The file.
    grids
        Dimension, dx in m and number of seedings of the runs.
    settings
        Further settings for `lab_scene`, such as ``events=1``.
    """
    runs = json.loads(path.read_text(encoding="utf-8"))["runs"] if path.exists() else []
    for dimension, dx, seedings in grids:
        for seed in range(1, seedings + 1):
            key = {"dimension": dimension, "dx": dx, "seed": seed, **AWAKE, **settings}
            held = [run for run in runs if key.items() <= run.items()]
            if any(run["version"] == _core.version for run in held):
                continue
            runs = [run for run in runs if run not in held] + [_recording(key)]
            write_text(path, _document(runs))


def _recording(settings: Settings) -> dict[str, Any]:
    run = run_lab(settings)
    return {
        **settings,
        "version": _core.version,
        "date": datetime.date.today().isoformat(),
        "particles": run.particles,
        "steps": run.steps,
        "ended": sorted(set(run.ended)),
        **{name: [round(value, 5) for value in run.series(name)] for name in COMPARED},
    }


def _document(runs: list[dict[str, Any]]) -> str:
    """Return the file's text, one run a line."""
    about = (
        "Stacks of preset lab-50 after each event, in m, with panel friction 0.3 and the core's "
        "default numerics but for what each run names. Made by "
        "validation.laboratory.lab_stack.record()."
    )
    lines = ",\n".join(f"    {json.dumps(run)}" for run in runs)
    return f'{{\n  "about": {json.dumps(about)},\n  "runs": [\n{lines}\n  ]\n}}\n'
