"""A scene simulated in memory, without a folder: events, steps, particles, snow added by hand."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Literal, Union, cast

import numpy as np
from numpy.typing import ArrayLike

import snowshed._core as _core
from snowshed._core import InputError, SimulationError
from snowshed.base.arrays import (
    Booleans,
    Floats,
    Integers,
    Numbers,
    finite,
    points,
    positive,
    whole_number,
)
from snowshed.base.paths import PathLike
from snowshed.methods.registry import method_of
from snowshed.results.fields import Fields, Order, checked_order
from snowshed.results.grid import grid_dataset, scene_grid
from snowshed.results.method_results import MethodResults
from snowshed.results.particle_dataset import DATASET, particle_dataset
from snowshed.running.sequence import issuing_notes
from snowshed.scene.components import Snow
from snowshed.scene.resolved import snows_of
from snowshed.scene.scene import ResolvedScene, SceneLike, resolve_scene
from snowshed.snow.stack.measure import StackMeasure
from snowshed.snow.stack.particles import measure_particles

if TYPE_CHECKING:
    import xarray

Ended = Literal["rest", "time_limit", "reached"]
Until = Union[Literal["rest"], float, Callable[["Simulation"], bool]]

MAX_STEPS = 64  # steps between two checks for Ctrl-C
CHECK_INTERVAL = 0.1  # s of wall time between checks while the core runs to rest


class Simulation(MethodResults):
    """A scene being simulated, in memory.

    It advances event by event: `run` seeds the snow of the next event and moves it until it rests;
    `begin_event` and `step` do the same in parts. Methods such as `positions` return the particles
    ordered by id, which never changes; `fields` shows their memory in the order of storage.

    A simulation serves one thread at a time: a call during another thread's call raises
    RuntimeError and changes nothing. Different simulations may run in different threads.

    Parameters
    ----------
    scene : Scene, ResolvedScene, dict or path
        A scene, its JSON data, or a scene file.

    Raises
    ------
    InputError
        If the scene is wrong or does not fit into memory.
    OSError
        If the file, or one that the scene names, cannot be read.

    Examples
    --------
    >>> from snowshed import Scene
    >>> scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    >>> simulation = Simulation(scene)
    >>> simulation.run(until=0.05)
    'reached'
    >>> simulation.positions().shape == (simulation.particle_count, 3)
    True
    >>> simulation.fields["velocity_z"].unit
    'm/s'
    """

    def __init__(self, scene: SceneLike) -> None:
        self._scene = resolve_scene(scene)
        self._core = _core.Simulation(self._scene.core, self._scene.base_dir)

    @classmethod
    def load(cls, path: PathLike) -> Simulation:
        """Return the simulation in a file of `save`, or in the ``checkpoint.bin`` of a run.

        Raises
        ------
        InputError
            If the file is not a sound checkpoint.
        OSError
            If it cannot be read.
        """
        loaded = cls.__new__(cls)
        loaded._core = _core.Simulation.load(os.fspath(path))
        loaded._scene = ResolvedScene(loaded._core.scene)
        return loaded

    def save(self, path: PathLike) -> None:
        """Store the simulation in a file, atomically.

        A simulation saved between events, or before the first step of an event, continues to the
        same bits after `load`. In the middle of an event it agrees with the original to rounding.

        Raises
        ------
        OSError
            If it cannot be written.
        """
        self._core.save(os.fspath(path))

    def begin_event(self) -> None:
        """Lay the snow of the next event; notes on it are warnings, `SnowshedNote`.

        Raises
        ------
        InputError
            If it cannot be seeded, or more than 1 % of a body lies where snow must not be (unless
            the scene's ``misplaced_snow`` is "allow").
        SimulationError
            If the present event has not ended, or the stack cannot be reseeded.
        """
        with issuing_notes(self._core):
            self._core.begin_event()

    def step(self, count: int = 1) -> None:
        """Take steps of the present event, whether the snow rests or not.

        Raises
        ------
        InputError
            If `count` is not a whole number from 0.
        SimulationError
            If no event runs, or the simulation cannot continue.
        """
        for left in range(whole_number("count", count, lowest=0), 0, -MAX_STEPS):
            self._core.step(min(left, MAX_STEPS))

    def run(self, until: Until = "rest", *, every: int = 16) -> Ended:
        """Take steps of the present event, or of the next one, until a condition holds.

        Parameters
        ----------
        until
            "rest": until the snow rests or the event's time limit; either ends the event. A number:
            until this time in the event, s; the last step may end after it. A
            function: until it returns True; it gets the simulation and may change it.
        every
            Number of steps between two calls of the function.

        Returns
        -------
        str
            "rest", "time_limit" (``events.max_time`` has passed) or "reached".

        Raises
        ------
        InputError
            If `until` or `every` is none of these.
        SimulationError
            If all events have ended, or the simulation cannot continue.
        """
        steps = whole_number("every", every, lowest=1)
        if isinstance(until, str) and until != "rest":
            raise InputError(f'until: {until!r}; allowed: "rest", a time in s, a function')
        if not (isinstance(until, str) or callable(until)):
            until = finite("until", until)
        if not self.event_running and self.event >= self._core.event_count:
            raise SimulationError(f"all {self.event} events have ended; begin_event adds another")
        if not self.event_running:
            self.begin_event()
        if isinstance(until, str):
            return cast(Ended, self._core.run(lambda report: True, CHECK_INTERVAL))
        if callable(until):
            return self._run_until(until, steps)
        while self.time < until:
            # Only half of the steps that would remain, because the time step may grow.
            left = 0.5 * (until - self.time) / self._core.time_step_s if self.time else 1
            self._core.step(max(1, min(MAX_STEPS, int(left))))
        return "reached"

    def _run_until(self, condition: Callable[[Simulation], bool], every: int) -> Ended:
        longest = float(self.scene.data["events"]["max_time"])
        while not condition(self):
            if self.time >= longest:
                return "time_limit"
            self.step(every)
        return "reached"

    def add_snow(
        self,
        positions: ArrayLike,
        *,
        mass: Union[float, None] = None,
        velocity: ArrayLike = (0.0, 0.0, 0.0),
        material_id: int = 0,
    ) -> None:
        """Add particles, which belong to the present event.

        They get the next ids, in their order. Particles inside an obstacle or within other snow are
        pushed out at high speed; more than 1 % of such particles are refused, unless the scene's
        ``misplaced_snow`` is "allow".

        Parameters
        ----------
        positions : (n, 3), or (n, 2) in 2D
            Positions, m; two columns are x and z.
        mass
            Mass of each particle, kg (per metre of width in 2D). None: as the scene seeds this
            snow, its density times the volume of a cell over ``seeding.particles_per_voxel``.
        velocity : (3,), or (2,) in 2D
            Velocity of all of them, m/s.
        material_id
            Index into `snows`; the density of that snow, not `mass`, decides the spacing of the
            particles.

        Raises
        ------
        InputError
            If an argument is wrong, or the particles lie where snow must not be.
        SimulationError
            If a position lies beyond the addressable grid (10^6 cells to each side, about).

        Examples
        --------
        >>> from snowshed import Scene
        >>> simulation = Simulation(Scene.preset("lab-50").update({"dimension": 2}))
        >>> simulation.begin_event()
        >>> before = simulation.particle_count
        >>> simulation.add_snow([[0.3, 0.5], [0.3, 0.51]], velocity=(0, -1))
        >>> simulation.particle_count - before
        2
        """
        snows = self.snows
        kind = whole_number("material_id", material_id, lowest=0)
        if kind >= len(snows):
            raise InputError(f"material_id: {kind}; the scene's snows are 0 to {len(snows) - 1}")
        given = points("positions", positions, self.dimension)
        speed = points("velocity", np.atleast_2d(np.asarray(velocity)), self.dimension, 1)[0]
        heavy = self._seeded_mass(snows[kind]) if mass is None else positive("mass", mass)
        with issuing_notes(self._core):
            self._core.add_snow(given, heavy, tuple(speed.tolist()), kind)

    def add_velocity(self, changes: ArrayLike) -> None:
        """Add to the velocities of the particles.

        Parameters
        ----------
        changes : (n, 3) or (3,); in 2D also (n, 2) or (2,)
            Changes for each particle, ordered by id, or a single one for all, m/s; two columns are
            x and z.

        Raises
        ------
        InputError
            If the shape is wrong, or a value is not finite.
        """
        rows = np.asarray(changes)
        is_single = rows.ndim == 1
        count = 1 if is_single else self.particle_count
        vectors = points("changes", rows[None] if is_single else rows, self.dimension, count)
        self._core.add_velocity(np.broadcast_to(vectors, (self.particle_count, 3)))

    def _seeded_mass(self, snow: Snow) -> float:
        voxel = self._core.resolution**self.dimension
        per_voxel = self.scene.data.get("seeding", {}).get("particles_per_voxel", 1.0)
        return float(cast(float, snow.density) * voxel / per_voxel)

    @property
    def fields(self) -> Fields:
        """The quantities of the particles by name, in the order of storage, without copies."""
        return Fields(self._core)

    def positions(self, order: Order = "id") -> Floats:
        """Return the positions (n, 3), m; always a copy, since they are stored cell by cell.

        Parameters
        ----------
        order
            "id": a copy ordered by the particles' ids, in double precision and 64-bit integers.
            "storage": as `Field.values` of `fields`. All methods that read particles have this
            parameter.
        """
        return cast(Floats, self._read("position", order))

    def velocities(self, order: Order = "id") -> Floats:
        """Return the velocities (n, 3), m/s; a copy. The fields velocity_x, ... are views."""
        return cast(Floats, self._read("velocity", order))

    def masses(self, order: Order = "id") -> Floats:
        """Return the masses (n,), kg (per metre of width in 2D)."""
        return cast(Floats, self._read("mass", order))

    def densities(self, order: Order = "id") -> Floats:
        """Return the current densities (n,), kg/m3; computed."""
        return cast(Floats, self._read("density", order))

    def pressures(self, order: Order = "id") -> Floats:
        """Return the Kirchhoff pressures (n,), Pa, positive in compression; computed."""
        return cast(Floats, self._read("pressure", order))

    def plastic_strains(self, order: Order = "id") -> Floats:
        """Return the volumetric plastic strains (n,), negative in compaction."""
        return cast(Floats, self._read("volumetric_plastic_strain", order))

    def ids(self, order: Order = "id") -> Integers:
        """Return the ids (n,) of the particles."""
        return cast(Integers, self._read("id", order))

    def events(self, order: Order = "id") -> Integers:
        """Return the events (n,) that released the particles, from 1."""
        return cast(Integers, self._read("event", order))

    def material_ids(self, order: Order = "id") -> Integers:
        """Return the index into `snows` of each particle (n,)."""
        return cast(Integers, self._read("material_id", order))

    def on_panel(self, order: Order = "id") -> Booleans:
        """Return whether each particle (n,) lies on the panel."""
        on_panel = self._core.on_panel()
        if checked_order(order) == "storage":
            by_id, on_panel = on_panel, np.empty_like(on_panel)
            on_panel[self._core.order_by_id()] = by_id
        return on_panel

    def _read(self, name: str, order: Order) -> Numbers:
        read = self._core.field_by_id if checked_order(order) == "id" else self._core.field
        return read(name)

    def to_xarray(self) -> xarray.Dataset:
        """Return the particles as a Dataset, ordered by id; copies.

        Returns
        -------
        xarray.Dataset
            Dimensions ``particle``, with the ids, and ``component``; units in `attrs`.

        Raises
        ------
        InputError
            If xarray (extra ``study``) is not installed.
        """
        fields = self.fields
        values = {name: self._core.field_by_id(name) for name in DATASET if name in fields}
        return particle_dataset(values, self.event, self.time)

    def grid(self) -> xarray.Dataset:
        """Return mass, velocity and density at the nodes of the grid, computed from the particles.

        The next step of the material point method would begin with them.

        Returns
        -------
        xarray.Dataset
            Dimensions x, (y,) z, the nodes, m, and component.

        Raises
        ------
        InputError
            If the method has no grid, there are no particles, or xarray (extra ``study``) is not
            installed.
        """
        affine = cast(Floats, self._read("affine", "id")) if "affine" in self.fields else None
        arrays = self.positions(), self.velocities(), self.masses(), affine
        fields = scene_grid(self.scene.data, *arrays)
        return grid_dataset(fields, self.event, self.time)

    def measure(self) -> StackMeasure:
        """Measure the stack: the snow that neither the panel nor a structure holds.

        See `measure_stack`; `snowshed.snow.stack.particles` defines the ground.
        """
        core = self._core
        arrays = core.positions(), core.masses(), core.densities(), core.on_panel()
        return measure_particles(core, self.scene.data, *arrays)

    def energy(self) -> dict[str, float]:
        """Return the energy balance, J (per metre of width in 2D): energy stored, lost and added.

        Raises
        ------
        InputError
            If the scene does not keep it (``output.energy``).
        """
        if not self.scene.data["output"]["energy"]:
            raise InputError(
                "/output/energy: false; the energy balance is computed only if it is true"
            )
        return {name[: -len("_j")]: value for name, value in self._core.energy().items()}

    def result(self, name: str) -> object:
        """Return a result of the scene's method up to now by its name, such as "maps"."""
        data = self.scene.data
        value: object = method_of(data).compute(name, self._core, data)
        return value

    @property
    def scene(self) -> ResolvedScene:
        """The complete scene."""
        return self._scene

    @property
    def snows(self) -> list[Snow]:
        """The scene's different snows; `material_ids` are indices into them."""
        return [Snow.from_data(snow) for snow in snows_of(self._core)]

    @property
    def event(self) -> int:
        """The number of the present event, from 1; 0 before the first."""
        return self._core.event

    @property
    def event_running(self) -> bool:
        """True until the present event has ended."""
        return self._core.event_running

    @property
    def time(self) -> float:
        """Time in the present event, s."""
        return self._core.time_s

    @property
    def time_step(self) -> float:
        """Length of the last step, s."""
        return self._core.time_step_s

    @property
    def steps(self) -> int:
        """Steps taken so far, in all events."""
        return self._core.total_steps

    @property
    def particle_count(self) -> int:
        """Number of particles."""
        return self._core.particle_count

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self._core.dimension

    def __repr__(self) -> str:
        state = "running" if self.event_running else "ended" if self.event else "not begun"
        return (
            f"<Simulation in {self.dimension}D: event {self.event} {state}, t = {self.time:g} s, "
            f"{self.particle_count} particles>"
        )
