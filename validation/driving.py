"""A solver that a verification case drives step by step, and times."""

from __future__ import annotations

import math
import time
from collections.abc import Collection, Mapping, Sequence

from snowshed import _core
from snowshed.analysis.verification.case import Measured, Outcome, Settings
from snowshed.io.arrays import Floats
from snowshed.io.record import Record
from snowshed.scene.components import Numerics, Seeding, Snow
from snowshed.scene.scene import Scene

#: The sections in which a setting's name is looked for; other names stand at the scene's top.
SECTIONS: Mapping[str, type[Record]] = {"numerics": Numerics, "seeding": Seeding, "snow": Snow}
#: The most steps between two looks at the clock.
LONGEST_STRETCH = 200


def apply_settings(
    scene: Scene, settings: Settings, own: Collection[str] = (), *, sleeping: bool = False
) -> Scene:
    """Set a scene's parameters from a case's settings, and one thread.

    Small motions are what most cases measure, so snow never sleeps unless the settings say so.

    Parameters
    ----------
    scene
        Changed, and returned.
    settings
        Names without their section, and values.
    own
        Names that are the case's own business and left out.
    sleeping
        Whether snow at rest sleeps as it does by default.

    Raises
    ------
    InputError
        If a scene has no parameter of that name.

    Examples
    --------
    >>> scene = apply_settings(Scene(), {"dx": 0.02, "seed": 3, "friction": 0.1}, {"friction"})
    >>> scene.numerics.dx, scene.seeding.seed, scene.numerics.threads, scene.numerics.sleep_speed
    (0.02, 3, 1, 0.0)
    """
    scene.set("numerics.threads", 1)
    if not sleeping:
        scene.set("numerics.sleep_speed", 0.0)
    for name, value in settings.items():
        if name not in own:
            scene.set(_path(name), value)
    return scene


def _path(name: str) -> str:
    for section, record in SECTIONS.items():
        if name in record.keys():  # noqa: SIM118 (a class method, not a mapping's)
            return f"{section}.{name}"
    return name


class Drive:
    """The first event of a scene, run as far as asked; only its steps count as run time.

    Parameters
    ----------
    scene
        What to simulate.

    Attributes
    ----------
    core
        The simulation.
    wall_s
        Time spent in steps so far, s.

    Examples
    --------
    >>> from snowshed import Body, Shape
    >>> scene = Scene(dimension=2, bodies=[Body(shape=Shape.sphere((0, 1), 0.05))])
    >>> drive = Drive(apply_settings(scene, {"dx": 0.02, "precision": "double"}))
    >>> drive.run_to(0.1)
    >>> print(f"{drive.mean(drive.core.velocities())[2] / drive.core.time_s:.6f}")
    -9.810000
    """

    def __init__(self, scene: Scene) -> None:
        self.core = _core.Simulation(scene.resolve().json)
        self.core.begin_event()
        self.masses = self.core.masses()
        self.wall_s = 0.0

    def step(self, count: int = 1) -> None:
        """Take steps."""
        started = time.perf_counter()
        self.core.step(count)
        self.wall_s += time.perf_counter() - started

    def damp(self, exponent: float) -> None:
        """Let the velocities of all particles fall by the factor ``exp(-exponent)``."""
        started = time.perf_counter()
        self.core.add_velocity(math.expm1(-exponent) * self.core.velocities())
        self.wall_s += time.perf_counter() - started

    def run_to(self, time_s: float) -> None:
        """Take steps until a time of the event, s, and no further than the step that reaches it."""
        while self.core.time_s < time_s:
            left = (time_s - self.core.time_s) / self.core.time_step_s if self.core.time_s else 1
            self.step(max(1, min(LONGEST_STRETCH, int(left))))

    def mean(self, values: Floats) -> Floats:
        """Return the mean over all particles, weighted by mass, of rows of values."""
        mean: Floats = self.masses @ values / self.masses.sum()
        return mean

    def outcome(self, measured: Sequence[Measured]) -> Outcome:
        """Return what was measured together with what it cost."""
        return Outcome(
            measured=measured,
            wall_s=self.wall_s,
            updates=self.core.particle_updates,
            steps=self.core.total_steps,
            particles=self.core.particle_count,
        )


def relative(quantity: str, value: float, exact: float) -> Measured:
    """Return a measured value with its error relative to the exact one.

    Examples
    --------
    >>> relative("height", 0.99, 1.0).error.__round__(6)
    -0.01
    """
    return Measured(quantity, value, exact, value / exact - 1)


def absolute(quantity: str, value: float, exact: float) -> Measured:
    """Return a measured value with its error in the quantity's unit."""
    return Measured(quantity, value, exact, value - exact)
