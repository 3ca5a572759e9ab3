"""Scenes of the MPS cases: blocks of snow or water between walls, in 2D."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Optional

from snowshed.base.json_values import JsonValue
from snowshed.methods.mps.settings import MpsSettings
from snowshed.scene.components import Body, Events, Obstacle
from snowshed.scene.scene import Scene
from snowshed.scene.shape import Shape
from snowshed.snow.accuracy.measurements import CaseSettings
from validation.framework.drive import TimedEventDriver

GRAVITY = 9.81  # m/s2
WATER = MpsSettings(density=1000.0, viscosity=1e-3, rheology="newtonian")
#: Variants of the cases: walls of particles, and the forms of Koshizuka and Oka.
VARIANTS: Sequence[CaseSettings] = (
    {"walls": "particles"},
    {"gradient": "conservative", "walls": "particles"},
    {"gradient": "published", "spacing_law": "collision"},
    {"gradient": "published", "spacing_law": "collision", "walls": "particles"},
)


def floor_and_sides(*sides: float) -> list[Obstacle]:
    """Return sticky walls: a floor at z = 0, a wall at x = 0, and the walls opposite to it."""
    planes = [((0.0, 0.0), (0.0, 1.0)), ((0.0, 0.0), (1.0, 0.0))]
    planes += [((x, 0.0), (-1.0, 0.0)) for x in sides]
    return [
        Obstacle(name=f"wall {k}", shape=Shape.plane(point, normal), condition="sticky")
        for k, (point, normal) in enumerate(planes, start=1)
    ]


def block(width: float, height: float) -> Body:
    """Return a body in the corner of the walls; lengths in m."""
    return Body(shape=Shape.box((width / 2, height / 2), (width, height)))


def mps_driver(
    fluid: MpsSettings,
    obstacles: Sequence[Obstacle],
    bodies: Sequence[Body],
    settings: CaseSettings,
    case_settings: Collection[str] = (),
    scene_settings: Optional[Mapping[str, JsonValue]] = None,
) -> TimedEventDriver:
    """Return a driver for a fluid with a case's settings, on one thread."""
    scene = Scene(
        dimension=2, method="mps", numerics=MpsSettings(**vars(fluid)), obstacles=list(obstacles),
        bodies=list(bodies), events=Events(count=1, max_time=1000.0, between="carry"),
    )  # fmt: skip
    scene.set("numerics.threads", 1)
    for name, value in settings.items():
        if name not in case_settings:
            scene.set(f"numerics.{name}", value)
    scene.update(dict(scene_settings or {}))
    return TimedEventDriver(scene)
