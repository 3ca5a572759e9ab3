"""A body with body forces that move it along a chosen motion."""

from __future__ import annotations

import math
from typing import Optional

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.scene.shape import Shape
from snowshed.snow.accuracy.measurements import CaseSettings
from validation.elastic.bodies import elastic_scene, from_plane, in_plane
from validation.framework.drive import TimedEventDriver
from validation.manufactured.motions import DENSITY, YOUNGS_MODULUS, ManufacturedMotion

#: Settings of the cases themselves.
CASE_SETTINGS = frozenset({"motion", "amplitude"})


class ForcedBody:
    """Unit square under the body forces of a chosen motion.

    Particle velocities are those in the middle of the last step, as in every leapfrog scheme. The
    body therefore starts with its velocity half a step before time zero, and a force between two
    steps is that of the current time and positions. The length of the step on which this force acts
    is known only afterwards. The length of the last step is used instead, and the next force
    corrects the difference.

    Parameters
    ----------
    motion
        The motion.
    settings
        Settings of the scene.

    Attributes
    ----------
    drive
        The simulation.
    time
        Time since the body was at rest at its initial position, s.

    Examples
    --------
    >>> from validation.manufactured.motions import AxialWaves
    >>> body = ForcedBody(AxialWaves(0.01), {"dx": 1 / 16, "pattern": "regular"})
    >>> for _ in range(10):
    ...     body.step()
    >>> root_mean_square(body.residual()) < 0.1 * root_mean_square(body.displacement())
    True
    """

    def __init__(self, motion: ManufacturedMotion, settings: CaseSettings) -> None:
        self.motion = motion
        self._settings = settings
        trial, _ = self._start(0.0)
        trial.step()
        self._last_step = trial.core.time_step_s
        self.drive, self._points = self._start(-self._last_step / 2)
        self._velocity_correction = np.zeros_like(self._points)

    def _start(self, time: float) -> tuple[TimedEventDriver, Floats]:
        """Return a body with the velocities of a given time, and its initial positions."""
        motion, square = self.motion, Shape.box((0.5, 0.5), (1.0, 1.0))
        material: CaseSettings = {
            "youngs_modulus": YOUNGS_MODULUS,
            "poissons_ratio": motion.poissons_ratio,
            "density": DENSITY,
        }
        drive = TimedEventDriver(
            elastic_scene(square, {**material, **self._settings}, CASE_SETTINGS)
        )
        points = in_plane(drive.core.positions())
        drive.core.add_velocity(from_plane(motion.velocity(points, time)))
        return drive, points

    @property
    def time(self) -> float:
        """Time to which the positions belong, s."""
        return self.drive.core.time_s

    def step(self) -> None:
        """Apply the body force and take a step."""
        force = self.motion.body_force(self._points, self.time)
        self.drive.core.add_velocity(
            from_plane(self._last_step * force + self._velocity_correction)
        )
        self.drive.step()
        taken = self.drive.core.time_step_s
        self._velocity_correction = (taken - self._last_step) * force
        self._last_step = taken

    def displacement(self, time: Optional[float] = None) -> Floats:
        """Return the exact displacements of the particles at a time, by default the present, m."""
        return self.motion.displacement(self._points, self.time if time is None else time)

    def residual(self) -> Floats:
        """Return the errors of the particles' displacements, m."""
        return in_plane(self.drive.core.positions()) - self._points - self.displacement()


def root_mean_square(vectors: Floats) -> float:
    """Return the root of the mean of the squared lengths of vectors.

    Examples
    --------
    >>> root_mean_square(np.array([[3.0, 4.0], [0.0, 0.0]])).__round__(6)
    3.535534
    """
    return math.sqrt(np.mean(np.sum(vectors**2, axis=1)))
