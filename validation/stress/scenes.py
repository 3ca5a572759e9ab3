"""Scene of a point: a few cells of snow that slide, fall, are thrown, or collide."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from snowshed.methods.mpm.settings import MpmSettings
from snowshed.scene.components import (
    Body,
    Events,
    Ground,
    Obstacle,
    Panel,
    Seeding,
    Slab,
)
from snowshed.scene.components import Snow as SnowPart
from snowshed.scene.output import Output
from snowshed.scene.scene import Scene
from snowshed.scene.shape import Shape
from validation.stress.space import Point

#: Distance of snow from the target of its throw, in cells. Bodies act on each other within about a
#: cell, so contact comes soon, but no body starts inside another.
GAP = 2.0

#: Time limit of an event, s; within this time, snow of these sizes falls and settles.
MAX_DURATION = 2.0

#: Largest flight of snow without ground, in its thicknesses. Every grain that is scattered far
#: needs grid blocks of its own.
FLIGHT = 50.0

Plane = NDArray[np.float64]


def build(point: Point, max_time: float = MAX_DURATION) -> Scene:
    """Return the scene of a point with events of at most `max_time` seconds."""
    scene = _SceneOf(point)
    return scene.complete(max_time)


def max_event_duration(point: Point) -> float:
    """Return the longest time that an event of a point's scene may take, s."""
    if point["kind"] not in ("collide", "plate"):
        return MAX_DURATION
    return min(MAX_DURATION, FLIGHT * float(point["thickness"]) / float(point["speed"]))


class _SceneOf:
    """Builder of a point's scene; lengths in metres."""

    def __init__(self, point: Point) -> None:
        self.point = point
        self.dimension = int(point["dimension"])
        self.thickness = float(point["thickness"])
        self.dx = self.thickness / int(point["cells"])
        across = 2 if self.dimension == 3 else 1
        self.length = max(6 // across, int(point["cells"])) * self.dx
        self.width = across * self.dx
        self.tilt = math.radians(float(point["tilt"]))
        self.ground_slope = math.tan(math.radians(float(point["ground_tilt"])))
        self.speed = float(point["speed"])

    def complete(self, max_time: float) -> Scene:
        """Return the scene with all its parts."""
        scene = Scene(
            dimension=self.dimension,
            misplaced_snow="allow",  # snow of the second event may meet that of the first
            snow=self._snow(),
            seeding=self._seeding(),
            numerics=self._numerics(),
            events=Events(
                count=2,
                between=self._text("between"),
                max_time=max_time,
                rest_time=min(0.05, max_time),
            ),
            output=Output(energy=True),
        )
        add: Any = getattr(self, "_" + self._text("kind"))
        add(scene)
        return scene

    # --- kinds -------------------------------------------------------------------------------

    def _slide(self, scene: Scene) -> None:
        height = 2 * self.thickness
        scene.ground = self._ground()
        scene.panel = Panel(
            height=height,
            length=self.length,
            tilt=float(self.point["tilt"]),
            thickness=float(self.point["plate_cells"]) * self.dx,
            condition=self._text("condition"),
            friction=float(self.point["friction"]),
        )
        scene.slab = Slab(thickness=self.thickness)
        if self.dimension == 3:
            scene.panel.width = 1.5 * self.width
        half = 0.5 * self.length * self._down_slope()
        lower_edge = -half[0] * self.ground_slope + height
        centre = np.array([0.0, lower_edge - half[1]])
        side = 2 * self.dx
        above = self.thickness + (GAP + 1) * self.dx
        chunk = Shape.sphere(self._vector(centre + above * self._upward()), 0.5 * side)
        scene.bodies = [self._thrown_body(chunk, -self._upward())]

    def _throw(self, scene: Scene) -> None:
        scene.ground = self._ground()
        scene.bodies = [self._thrown_body(self._block(self._above_ground()), self._aslant())]

    def _coincident(self, scene: Scene) -> None:
        """Throw two equal bodies with a regular pattern, so that their particles coincide."""
        self._throw(scene)
        assert scene.seeding is not None and scene.bodies is not None
        scene.seeding.pattern = "regular"
        scene.bodies = [*scene.bodies, *scene.bodies]

    def _plate(self, scene: Scene) -> None:
        plate = Shape.plate(
            self._vector(np.zeros(2)),
            self._vector(self._upward()),
            self.length,
            width=2 * self.width,
            thickness=float(self.point["plate_cells"]) * self.dx,
        )
        scene.obstacles = [
            Obstacle(
                name="plate",
                shape=plate,
                condition=self._text("condition"),
                friction=float(self.point["friction"]),
            )
        ]
        away = 0.5 * math.hypot(self.thickness, self.length) + GAP * self.dx
        scene.bodies = [self._thrown_body(self._block(away * self._upward()), -self._upward())]

    def _collide(self, scene: Scene) -> None:
        apart = np.array([0.5 * (self.length + GAP * self.dx), 0.25 * self.thickness])
        scene.bodies = [
            self._thrown_body(self._block(-apart), np.array([0.5, 0.0])),
            self._thrown_body(self._block(apart), np.array([-0.5, 0.0])),
        ]

    def _single(self, scene: Scene) -> None:
        """Throw a block that is just large enough for one particle."""
        scene.ground = self._ground()
        per_voxel = int(self.point["particles_per_voxel"])
        edge = 0.999 * self.dx * per_voxel ** (-1.0 / self.dimension)
        cube = Shape.box(self._vector(self._above_ground()), self._vector(np.full(2, edge), edge))
        scene.bodies = [self._thrown_body(cube, self._aslant())]

    # --- parts -------------------------------------------------------------------------------

    def _snow(self) -> SnowPart:
        return SnowPart(
            model=self._text("model"),
            density=float(self.point["density"]),
            youngs_modulus=float(self.point["youngs_modulus"]),
            poissons_ratio=float(self.point["poissons_ratio"]),
            critical_state_slope=float(self.point["critical_state_slope"]),
            preconsolidation_pressure=float(self.point["preconsolidation_pressure"]),
            cohesion=float(self.point["cohesion"]),
            hardening_factor=float(self.point["hardening_factor"]),
        )

    def _seeding(self) -> Seeding:
        return Seeding(
            particles_per_voxel=float(self.point["particles_per_voxel"]),
            pattern=self._text("pattern"),
            allow_sparse=True,
        )

    def _numerics(self) -> MpmSettings:
        return MpmSettings(
            dx=self.dx,
            precision=self._text("precision"),
            transfer=self._text("transfer"),
            flip_ratio=float(self.point["flip_ratio"]),
            basis=self._text("basis"),
            courant_factor=float(self.point["courant_factor"]),
            strain_limit=float(self.point["strain_limit"]),
            sleep_speed=float(self.point["sleep_speed"]),
            threads=1,
        )

    def _ground(self) -> Ground:
        return Ground(
            tilt=float(self.point["ground_tilt"]),
            condition=self._text("ground_condition"),
            friction=float(self.point["friction"]),
        )

    def _thrown_body(self, shape: Shape, direction: Plane) -> Body:
        """Return a body that appears in every event, with the point's speed."""
        return Body(shape=shape, velocity=self._vector(self.speed * direction), event=0)

    def _block(self, centre: Plane) -> Shape:
        size = np.array([self.length, self.thickness])
        return Shape.box(self._vector(centre), self._vector(size, self.width))

    def _above_ground(self) -> Plane:
        """Return the centre of a block that is clear of the ground."""
        corner = 0.5 * (self.thickness + abs(self.ground_slope) * self.length)
        return np.array([0.0, corner + GAP * self.dx * math.hypot(1.0, self.ground_slope)])

    # --- directions in the plane (x, z) ------------------------------------------------------

    def _down_slope(self) -> Plane:
        return np.array([math.cos(self.tilt), -math.sin(self.tilt)])

    def _upward(self) -> Plane:
        return np.array([math.sin(self.tilt), math.cos(self.tilt)])

    @staticmethod
    def _aslant() -> Plane:
        return np.array([0.6, -0.8])

    def _vector(self, plane: Plane, y: float = 0.0) -> tuple[float, ...]:
        x, z = float(plane[0]), float(plane[1])
        return (x, z) if self.dimension == 2 else (x, y, z)

    def _text(self, name: str) -> Any:
        """Return the value of a parameter whose values are texts."""
        return self.point[name]
