"""A plane on which a block slides with Coulomb friction."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.scene.components import Body, Condition, Obstacle
from snowshed.scene.scene import Scene
from snowshed.scene.shape import Shape

GRAVITY = 9.81  # m/s2, the scenes' default


class Incline(NamedTuple):
    """Directions on a plane that falls in the direction of +x; (x, z) in 2D, (x, y, z) in 3D."""

    tilt: float  # degrees
    dimension: int

    @property
    def slope(self) -> list[float]:
        """Unit vector down the slope."""
        tilt = math.radians(self.tilt)
        return self._in_plane(math.cos(tilt), -math.sin(tilt))

    @property
    def normal(self) -> list[float]:
        """Unit vector off the plane."""
        tilt = math.radians(self.tilt)
        return self._in_plane(math.sin(tilt), math.cos(tilt))

    @property
    def along(self) -> Floats:
        """The slope as a vector (x, y, z) in 2D and 3D, like positions and velocities."""
        slope = self.slope
        return np.array([slope[0], 0.0, slope[-1]])

    def _in_plane(self, x: float, z: float) -> list[float]:
        return [x, z] if self.dimension == 2 else [x, 0.0, z]

    def coulomb(self, friction: float) -> float:
        """Return the acceleration of a sliding block, g (sin tilt - mu cos tilt), m/s2.

        Examples
        --------
        >>> round(Incline(tilt=90.0, dimension=2).coulomb(0.5), 6)
        9.81
        """
        tilt = math.radians(self.tilt)
        return GRAVITY * (math.sin(tilt) - friction * math.cos(tilt))

    def scene(
        self,
        size: tuple[float, ...],
        friction: float,
        *,
        condition: Condition = "separate",
        speed: float = 0.0,
    ) -> Scene:
        """Return a scene with a block of snow that lies on the plane.

        Parameters
        ----------
        size
            Length, width (in 3D) and thickness of the block, m.
        friction, condition
            Friction and condition of the plane.
        speed
            Initial speed of the block, down the slope, m/s.
        """
        box = Shape.transform(
            Shape.box([0.0] * self.dimension, size),
            axis=None if self.dimension == 2 else (0, 1, 0),
            angle=self.tilt,
            translate=[size[-1] / 2 * part for part in self.normal],
        )
        plane = Obstacle(
            shape=Shape.plane([0.0] * self.dimension, self.normal),
            condition=condition,
            friction=friction,
        )
        block = Body(shape=box, velocity=[speed * part for part in self.slope])
        return Scene(dimension=self.dimension, obstacles=[plane], bodies=[block])
