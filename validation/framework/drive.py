"""Solver that a case runs step by step and times."""

from __future__ import annotations

import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager

from snowshed.base.record import Record
from snowshed.methods.mpm.settings import MpmSettings
from snowshed.running.event_driver import EventDriver
from snowshed.scene.components import Seeding, Snow
from snowshed.scene.scene import Scene
from snowshed.snow.accuracy.measurements import CaseSettings, Measured
from validation.framework.case import Outcome

#: Sections of a scene that hold settings; all other settings are at the top of the scene.
SECTIONS: Mapping[str, type[Record]] = {"numerics": MpmSettings, "seeding": Seeding, "snow": Snow}


def apply_settings(
    scene: Scene,
    settings: CaseSettings,
    case_settings: Collection[str] = (),
    *,
    sleeping: bool = False,
) -> Scene:
    """Set a scene's parameters from a case's settings, and one thread; return the scene.

    Most cases measure small motions, so snow never sleeps unless the settings say so.

    Parameters
    ----------
    scene
        Scene to change.
    settings
        Values by names without their section.
    case_settings
        Names of settings that belong to the case and not to the scene; they are left out.
    sleeping
        Whether snow at rest may sleep, as by default.

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
        if name not in case_settings:
            scene.set(_path(name), value)
    return scene


def _path(name: str) -> str:
    for section, record in SECTIONS.items():
        if name in record.keys():  # noqa: SIM118 (a class method, not that of a mapping)
            return f"{section}.{name}"
    return name


class TimedEventDriver(EventDriver):
    """First event of a scene, which is run to given times; only its steps count as run time.

    Parameters
    ----------
    scene
        The scene to simulate.

    Attributes
    ----------
    wall_s
        Time spent in steps so far, s.
    """

    def __init__(self, scene: Scene) -> None:
        super().__init__(scene)
        self.wall_s = 0.0

    def step(self, count: int = 1) -> None:
        """Take steps."""
        with self._timed():
            super().step(count)

    def damp(self, exponent: float) -> None:
        """Multiply the velocities of all particles by ``exp(-exponent)``."""
        with self._timed():
            super().damp(exponent)

    @contextmanager
    def _timed(self) -> Iterator[None]:
        started = time.perf_counter()
        yield
        self.wall_s += time.perf_counter() - started

    def outcome(self, measured: Sequence[Measured]) -> Outcome:
        """Return the measurements with their cost."""
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
