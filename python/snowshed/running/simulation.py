"""A scene simulated in memory, without a folder: events, steps, particles, snow added by hand."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from typing import Literal, Optional, Union, cast

import numpy as np
from numpy.typing import ArrayLike

import snowshed._core as _core
from snowshed._core import InputError, SimulationError
from snowshed.base.arguments import checked
from snowshed.base.arrays import finite, number_array, points, positive, whole_number
from snowshed.base.notes import issue_note
from snowshed.base.paths import PathLike
from snowshed.methods.registry import method_of
from snowshed.results.provenance import present_origin, with_origin
from snowshed.running.callback_guard import CallsFunctions, refused_within_calls
from snowshed.running.event_end import Ended, EventEnd
from snowshed.running.law_errors import law_errors
from snowshed.running.laws import Laws, addresses_of
from snowshed.running.particle_reading import ReadsParticles
from snowshed.running.recorded_run import check_scene_alone
from snowshed.running.scene_notes import notes_before
from snowshed.running.sequence import issuing_notes
from snowshed.running.stepping_checks import (
    check_speeds,
    is_reached,
    note_on_distance,
    note_on_mass,
    note_on_time,
    refuse_coincident,
)
from snowshed.running.strict_attributes import StrictAttributes
from snowshed.scene.components import Snow
from snowshed.scene.resolved import snows_of
from snowshed.scene.scene import ResolvedScene, SceneLike, resolve_scene
from snowshed.snow.stack.measure import StackMeasure
from snowshed.snow.stack.particles import measure_particles

Until = Union[Literal["rest"], float, Callable[["Simulation"], bool]]
OnStep = Callable[["Simulation"], object]

MAX_STEPS = 64  # steps between two checks for Ctrl-C
CHECK_INTERVAL = 0.1  # s of wall time between checks while the core runs to rest


@checked
class Simulation(CallsFunctions, StrictAttributes, ReadsParticles):
    """A scene being simulated, in memory.

    It advances event by event: `run` seeds the snow of the next event and moves it until it rests;
    `begin_event` and `step` do the same in parts. Methods such as `positions` return the particles
    ordered by id, which never changes; `fields` shows their memory in the order of storage.
    ``for end in simulation`` runs the remaining events and yields an `EventEnd` for each.

    A simulation serves one thread at a time: a call during another thread's call raises
    RuntimeError and changes nothing. Different simulations may run in different threads.

    Parameters
    ----------
    scene : Scene, ResolvedScene, dict or path
        A scene, its JSON data, or a scene file.
    laws
        Laws of one's own (`snowshed.running.Laws`); None: those of the scene.

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

    def __init__(self, scene: SceneLike, *, laws: Optional[Laws] = None) -> None:
        self._scene = resolve_scene(scene)
        check_scene_alone(scene, laws)
        self._laws = laws  # keeps the functions alive
        addresses = addresses_of(laws, self._scene.data)
        self._core = _core.Simulation(self._scene.core, self._scene.base_dir, addresses)
        of_input = filter(None, [self._core.input_note()])
        for note in (*notes_before(self._scene.data), *self._core.notes, *of_input):
            issue_note(note)

    @classmethod
    def load(cls, path: PathLike, *, laws: Optional[Laws] = None) -> Simulation:
        """Return the simulation in a file of `save`, or in the ``checkpoint.bin`` of a run.

        Parameters
        ----------
        path
            The file.
        laws
            The laws of one's own with which it was made. A checkpoint holds their name and a digest
            of their code; a note says if that has changed, or is unknown.

        Raises
        ------
        InputError
            If the file is not a sound checkpoint.
        OSError
            If it cannot be read.
        """
        loaded = cls.__new__(cls)
        loaded._laws = laws
        precision = "double" if laws is not None and laws.is_double else "float"
        addresses = None if laws is None else laws.for_core(precision)
        loaded._core = _core.Simulation.load(os.fspath(path), addresses)
        loaded._scene = ResolvedScene(loaded._core.scene)
        for note in loaded._core.notes:
            issue_note(note)
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
        if not self.event:
            raise SimulationError("no event has begun, so nothing can be saved; begin_event first")
        self._core.save(os.fspath(path))

    @refused_within_calls
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
        with issuing_notes(self._core), law_errors(self._laws):
            self._core.begin_event()

    @refused_within_calls
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
            with law_errors(self._laws):
                self._core.step(min(left, MAX_STEPS))

    @refused_within_calls
    def run(
        self, until: Until = "rest", *, every: int = 16, on_step: Optional[OnStep] = None
    ) -> Ended:
        """Take steps of the present event, or of the next one, until a condition holds.

        Parameters
        ----------
        until
            "rest": until the snow rests or the event's time limit; either ends the event. A number:
            until this time in the event, s; the last step may end after it. A
            function: until it returns True; it gets the simulation and may change it, but takes no
            steps.
        every
            Number of steps between two calls of the function `until`.
        on_step
            Function that is called with the simulation after each step, and may change it, but
            takes no steps.

        Returns
        -------
        str
            "rest", "time_limit" (``events.max_time`` has passed) or "reached".

        Raises
        ------
        InputError
            If `until` or `every` is none of these, or one of the functions calls `run`, `step` or
            `begin_event`.
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
        if not (isinstance(until, str) or callable(until)):
            note_on_time(until, self.event, self.time, self._max_time)
        if on_step is not None:
            return self._run_stepwise(until, steps, on_step)
        if isinstance(until, str):
            return self._run_to_end()
        if callable(until):
            return self._run_until(until, steps)
        while self.time < until:
            # Only half of the steps that would remain, because the time step may grow.
            left = 0.5 * (until - self.time) / self._core.time_step_s if self.time else 1
            self.step(max(1, min(MAX_STEPS, int(left))))
        return "reached"

    def _run_to_end(self) -> Ended:
        with law_errors(self._laws) as check:
            return cast(Ended, self._core.run(lambda report: check() is None, CHECK_INTERVAL))

    def _run_until(
        self,
        condition: Callable[[Simulation], bool],
        every: int,
        on_step: Optional[OnStep] = None,
    ) -> Ended:
        limit = self._max_time
        while not is_reached(self._call(condition)):
            if self.time >= limit:
                return "time_limit"
            if on_step is None:
                self.step(every)
                continue
            for _ in range(every):
                self.step()
                self._call(on_step)
        return "reached"

    def _run_stepwise(self, until: Until, every: int, on_step: OnStep) -> Ended:
        if callable(until):
            return self._run_until(until, every, on_step)
        limit = self._max_time if isinstance(until, str) else until
        while self.time < limit and not (isinstance(until, str) and self.at_rest):
            self.step()
            self._call(on_step)
        return self._run_to_end() if isinstance(until, str) else "reached"

    @property
    def _max_time(self) -> float:
        return float(self.scene.data["events"]["max_time"])

    def __iter__(self) -> Iterator[EventEnd]:
        """Run the remaining events one after another, and yield the end of each."""
        if not (self.event_running or self.events_left):
            issue_note(
                f"all {self.event} events have ended, and none ran; make the simulation again to "
                "repeat them"
            )
        while self.event_running or self.events_left:
            ended = self.run()
            yield EventEnd(self.event, ended, self.time)

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
            Positions, m; two columns are x and z. A table is read by its columns x, y and z. No
            two may coincide.
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
        self._require("stack", "takes no added snow")
        snows = self.snows
        kind = whole_number("material_id", material_id, lowest=0)
        if kind >= len(snows):
            raise InputError(f"material_id: {kind}; the scene's snows are 0 to {len(snows) - 1}")
        if not self.event_running:
            issue_note("no event is running: the added snow moves with the next event")
        given = points("positions", positions, self.dimension)
        refuse_coincident(given)
        speed = points(
            "velocity", np.atleast_2d(number_array("velocity", velocity)), self.dimension, 1
        )[0]
        seeded = self._seeded_mass(snows[kind])
        heavy = seeded if mass is None else positive("mass", mass)
        note_on_mass(heavy, seeded)
        check_speeds("velocity", speed)
        note_on_distance(given, self._core.positions())
        with issuing_notes(self._core):
            self._core.add_snow(given, heavy, tuple(speed.tolist()), kind)

    def _require(self, result: str, lack: str) -> None:
        """Refuse a call that only methods with a result can serve."""
        method = method_of(self.scene.data)
        if result not in method.results:
            raise InputError(f'/method: the snow of "{method.name}" {lack}')

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
        rows = number_array("changes", changes)
        is_single = rows.ndim == 1
        count = 1 if is_single else self.particle_count
        vectors = points("changes", rows[None] if is_single else rows, self.dimension, count)
        check_speeds("changes", vectors)
        self._core.add_velocity(np.broadcast_to(vectors, (self.particle_count, 3)))

    def _seeded_mass(self, snow: Snow) -> float:
        voxel = self._core.resolution**self.dimension
        per_voxel = self.scene.data.get("seeding", {}).get("particles_per_voxel", 1.0)
        return float(cast(float, snow.density) * voxel / per_voxel)

    def measure(self) -> StackMeasure:
        """Measure the stack: the snow that neither the panel nor a structure holds.

        See `measure_stack`; `snowshed.snow.stack.particles` defines the ground.
        """
        self._require("stack", "makes no stack")
        if not self.event:
            issue_note("no event has begun: there is no snow to measure")
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
        return with_origin(value, present_origin(self.scene))

    @property
    def snows(self) -> list[Snow]:
        """The scene's different snows; `material_ids` are indices into them."""
        return [Snow.from_data(snow) for snow in snows_of(self._core)]

    @property
    def event_running(self) -> bool:
        """True until the present event has ended."""
        return self._core.event_running

    @property
    def events_left(self) -> int:
        """Number of events that have not begun."""
        return max(0, self._core.event_count - self.event)

    @property
    def at_rest(self) -> bool:
        """True once the snow of the present event rests, as the scene's ``events`` define it."""
        return self.event > 0 and self._core.at_rest()

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
