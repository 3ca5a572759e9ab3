"""The first event of a scene, driven step by step."""

from __future__ import annotations

import math

import snowshed._core as _core
from snowshed.base.arrays import Floats
from snowshed.running.simulation import MAX_STEPS
from snowshed.scene.scene import Scene


class EventDriver:
    """The first event of a scene, run to given times.

    Parameters
    ----------
    scene
        The scene to simulate.

    Attributes
    ----------
    core
        The simulation.
    masses
        Masses of the particles, kg.

    Examples
    --------
    >>> from snowshed import Body, Shape
    >>> scene = Scene(dimension=2, bodies=[Body(shape=Shape.sphere((0, 1), 0.05))])
    >>> drive = EventDriver(scene.update({"numerics.dx": 0.02, "numerics.precision": "double"}))
    >>> drive.run_to(0.1)
    >>> print(f"{drive.mean(drive.core.velocities())[2] / drive.core.time_s:.6f}")
    -9.810000
    """

    def __init__(self, scene: Scene) -> None:
        self.core = _core.Simulation(scene.resolve().json)
        self.core.begin_event()
        self.masses = self.core.masses()

    def step(self, count: int = 1) -> None:
        """Take steps."""
        self.core.step(count)

    def damp(self, exponent: float) -> None:
        """Multiply the velocities of all particles by ``exp(-exponent)``."""
        self.core.add_velocity(math.expm1(-exponent) * self.core.velocities())

    def run_to(self, time_s: float) -> None:
        """Take steps until the first one that reaches a time of the event, s."""
        while self.core.time_s < time_s:
            left = (time_s - self.core.time_s) / self.core.time_step_s if self.core.time_s else 1
            self.step(max(1, min(MAX_STEPS, int(left))))

    def mean(self, values: Floats) -> Floats:
        """Return the mean over all particles, weighted by mass, of rows of values."""
        mean: Floats = self.masses @ values / self.masses.sum()
        return mean
