"""The laboratory's stack, run and measured."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from snowshed import _core
from snowshed.base.arrays import Booleans, Floats
from snowshed.results.folder import measured_columns
from snowshed.running.conversion import outline_difference
from snowshed.scene.scene import Scene
from snowshed.snow.accuracy.measurements import CaseSettings, Measured
from snowshed.snow.stack.measure import StackMeasure, measure_stack
from snowshed.snow.stack.quantities import MEASURES
from validation.framework.case import Outcome
from validation.framework.drive import apply_settings

#: Trimming rule of the recorded stacks and of all stacks that are compared with them.
TRIMMING = "equal_pace"
#: Columns of events.csv that are compared, by their names in this package.
COMPARED: Mapping[str, str] = {
    f"{measure.prefix}{quantity}": measure.column(quantity)
    for measure in (MEASURES["stack"], MEASURES["body"])
    for quantity in ("height", "length")
}

#: Paths in a scene of the settings for events.
EVENTS: Mapping[str, str] = {"events": "events.count", "between": "events.between"}


@dataclass(frozen=True)
class Cost:
    """Cost of a run up to the end of an event.

    Attributes
    ----------
    wall_s
        Time of the solution alone, s.
    updates
        Number of particles times steps; 0 if it is unknown.
    """

    wall_s: float
    updates: int
    steps: int
    particles: int


class StackRun(Protocol):
    """A run with known stacks after each event, either computed or recorded."""

    def series(self, name: str) -> Sequence[float]:
        """Return one of `COMPARED` after each event, m."""

    @property
    def cost(self) -> Cost:
        """Cost of all events."""


@dataclass(frozen=True)
class Conversion:
    """Stack before and after reseeding.

    Attributes
    ----------
    before, after
        The stack.
    mass_before, mass_after
        Mass of all snow, including snow on the panel, kg.
    particles_after
        Number of particles after reseeding.
    """

    before: StackMeasure
    after: StackMeasure
    mass_before: float
    mass_after: float
    particles_after: int

    def change(self, name: str) -> float:
        """Return the growth of one of `COMPARED`, m."""
        return measure_of(self.after, name) - measure_of(self.before, name)

    @property
    def loose_change(self) -> float:
        """Increase of the share of snow outside the largest body."""
        shares = [stack.detached_mass / stack.mass for stack in (self.before, self.after)]
        return shares[1] - shares[0]

    @property
    def outline_moved(self) -> float:
        """Root mean square of the change in height of the outline, m."""
        return outline_difference(self.before.outline, self.after.outline)


@dataclass
class LabRun:
    """Results of a run of the laboratory scene.

    Attributes
    ----------
    stacks
        The stack after each event.
    conversions
        The reseeding before each event except the first.
    ended
        The end of each event.
    mass
        Mass of all snow at the end, kg (per metre of width in 2D).
    brought_mass
        Mass of all slabs, from their volume and density, kg.
    particle_mass
        Mass of a particle of a seeded slab, at the initial density, kg.
    costs
        Cost up to the end of each event.
    """

    stacks: list[StackMeasure] = field(default_factory=list)
    conversions: list[Conversion] = field(default_factory=list)
    ended: list[str] = field(default_factory=list)
    mass: float = 0.0
    brought_mass: float = 0.0
    particle_mass: float = 0.0
    costs: list[Cost] = field(default_factory=list)

    @property
    def cost(self) -> Cost:
        """Cost of all events."""
        return self.costs[-1]

    def series(self, name: str) -> list[float]:
        """Return one of `COMPARED` after each event, m."""
        return [measure_of(stack, name) for stack in self.stacks]


def measure_of(stack: StackMeasure, name: str) -> float:
    """Return one of `COMPARED` of a stack, m."""
    return float(measured_columns(stack)[COMPARED[name]])


def lab_scene(settings: CaseSettings) -> Scene:
    """Return a scene of preset lab-50 with panel friction 0.3, one thread, and some settings.

    The scene is 2D unless the settings say otherwise. Snow at rest sleeps as by default, because
    users run stacks with this default.

    Examples
    --------
    >>> lab_scene({"dx": 0.02, "events": 2}).events.count
    2
    """
    scene = Scene.preset("lab-50").update({"dimension": 2, "panel.friction": 0.3})
    scene.update({path: settings[name] for name, path in EVENTS.items() if name in settings})
    return apply_settings(scene, settings, case_settings=EVENTS, sleeping=True)


def run_lab(settings: CaseSettings) -> LabRun:
    """Let the slabs slide off one after another, and return the stack after each event.

    Parameters
    ----------
    settings
        For `lab_scene`.

    Examples
    --------
    >>> run_lab({"dx": 0.02, "events": 1}).ended
    ['rest']
    """
    resolved = lab_scene(settings).resolve()
    simulation = _core.Simulation(resolved.json)
    data = resolved.data
    tape = _Tape(simulation, data)
    run = LabRun(brought_mass=_brought_mass(data), particle_mass=_particle_mass(data))
    wall_s = 0.0
    for _ in range(data["events"]["count"]):
        reseeded = simulation.begin_event()
        if reseeded is not None:
            run.conversions.append(tape.measure_conversion(reseeded))
        started = time.perf_counter()
        run.ended.append(simulation.run(lambda info: True))
        wall_s += time.perf_counter() - started
        run.costs.append(
            Cost(
                wall_s,
                simulation.particle_updates,
                simulation.total_steps,
                simulation.particle_count,
            )
        )
        run.stacks.append(tape.measure_present())
    run.mass = float(simulation.masses().sum())
    return run


def run_seedings(settings: CaseSettings) -> list[LabRun]:
    """Run the scene with ``seedings`` seeds from ``seed`` on; the default of both is 1."""
    rest = {name: value for name, value in settings.items() if name not in ("seedings", "seed")}
    first, count = int(settings.get("seed", 1)), int(settings.get("seedings", 1))
    return [run_lab({**rest, "seed": seed}) for seed in range(first, first + count)]


def outcome_of(runs: Sequence[StackRun], measured: Sequence[Measured]) -> Outcome:
    """Return the outcome of several seedings; its cost is the mean cost of a run."""
    costs = [run.cost for run in runs]
    counted = all(cost.updates for cost in costs)
    return Outcome(
        measured,
        wall_s=float(np.mean([cost.wall_s for cost in costs])),
        updates=round(np.mean([cost.updates for cost in costs])) if counted else 0,
        steps=round(np.mean([cost.steps for cost in costs])),
        particles=round(np.mean([cost.particles for cost in costs])),
    )


class _Tape:
    """Measures the stack of a simulation."""

    def __init__(self, simulation: _core.Simulation, scene: Mapping[str, Any]) -> None:
        self._simulation = simulation
        self._dx = float(scene["numerics"]["dx"])

    def measure_present(self) -> StackMeasure:
        """Measure the present stack."""
        now = self._simulation
        return self._measure(now.positions(), now.masses(), now.on_panel(), now.densities())

    def measure_conversion(self, reseeded: Mapping[str, Any]) -> Conversion:
        """Measure the snow before and after a conversion that the core reports."""
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
        return measure_lab(
            positions, masses, density, on_panel, self._simulation.dimension, self._dx
        )


def measure_lab(
    positions: ArrayLike,
    masses: ArrayLike,
    densities: ArrayLike,
    on_panel: ArrayLike,
    dimension: int,
    dx: float,
) -> StackMeasure:
    """Measure a stack of the laboratory by the common trimming rule."""
    return measure_stack(
        positions,
        masses,
        densities,
        dimension=dimension,
        dx=dx,
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
