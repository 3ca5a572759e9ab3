"""Snow that falls, slides and rests, against the laws of mechanics."""

from __future__ import annotations

import math

from snowshed.analysis.accuracy.incline import GRAVITY, Incline
from snowshed.running.event_driver import EventDriver
from snowshed.scene.components import Body, Obstacle
from snowshed.scene.scene import Scene
from snowshed.scene.shape import Shape

FALL_S = 0.1
FRICTION = 0.3
TILT = 40.0  # degrees
SLAB = (0.5, 0.05)  # m, length and thickness
#: Beginning and end of the averaging of the acceleration, s; before, contact sets in.
WINDOW = (0.1, 0.2)

HEIGHT, WIDTH = 0.2, 0.08  # m, of the column
DENSITY, YOUNGS_MODULUS, POISSONS_RATIO = 210.0, 1e5, 0.3  # kg/m3, Pa
SETTLING = 20.0  # radians of the column's slowest oscillation, for which it is damped
STEPS = 4  # steps between dampings


def fall_error() -> float:
    """Return the relative error of the speed of a ball in free fall: g t."""
    ball = Body(shape=Shape.sphere((0, 1), 0.05))
    scene = Scene(dimension=2, gravity=GRAVITY, bodies=[ball])
    drive = EventDriver(scene.update({"numerics.dx": 0.02, "numerics.precision": "double"}))
    drive.run_to(FALL_S)
    speed = -drive.mean(drive.core.velocities())[2]
    return float(speed / (GRAVITY * drive.core.time_s) - 1)


def friction_error() -> float:
    """Return the relative error of a slab's acceleration on an incline: Coulomb's law."""
    incline = Incline(TILT, dimension=2)
    drive = EventDriver(incline.scene(SLAB, FRICTION).update({"numerics.dx": 0.01}))
    begin, end = WINDOW
    drive.run_to(begin)
    speed, time_s = drive.mean(drive.core.velocities()) @ incline.along, drive.core.time_s
    drive.run_to(end)
    gained = drive.mean(drive.core.velocities()) @ incline.along - speed
    return float(gained / (drive.core.time_s - time_s) / incline.coulomb(FRICTION) - 1)


def column_error() -> float:
    """Return the relative error of the mean pressure of a column that rests between walls.

    Laterally confined snow carries the weight above it, rho g h, with the vertical stress (lambda +
    2 mu) e, of which K e is pressure. Strains are below a thousandth.
    """
    stretched = (1 + POISSONS_RATIO) * (1 - 2 * POISSONS_RATIO)
    vertical = YOUNGS_MODULUS * (1 - POISSONS_RATIO) / stretched  # lambda + 2 mu
    bulk = YOUNGS_MODULUS / (2 * stretched)  # K in the plane, lambda + mu
    slowest = math.pi / (2 * HEIGHT) * math.sqrt(vertical / DENSITY)  # rad/s
    drive = EventDriver(column_scene())
    while slowest * drive.core.time_s < SETTLING:
        before = drive.core.time_s
        drive.step(STEPS)
        drive.damp(2 * slowest * (drive.core.time_s - before))  # critical damping
    pressure = drive.masses @ drive.core.pressures() / drive.masses.sum()
    return float(pressure / (bulk / vertical * DENSITY * GRAVITY * HEIGHT / 2) - 1)


def column_scene() -> Scene:
    """Return an elastic column between frictionless walls on a sticky floor."""
    floor = Obstacle(shape=Shape.plane((0.0, 0.0), (0.0, 1.0)), condition="sticky")
    walls = [
        Obstacle(shape=Shape.plane((x, 0.0), (side, 0.0)), condition="separate", friction=0.0)
        for x, side in ((0.0, 1.0), (WIDTH, -1.0))
    ]
    column = Body(shape=Shape.box((WIDTH / 2, HEIGHT / 2), (WIDTH, HEIGHT)))
    scene = Scene(dimension=2, gravity=GRAVITY, obstacles=[floor, *walls], bodies=[column])
    return scene.update(
        {
            "snow.density": DENSITY,
            "snow.youngs_modulus": YOUNGS_MODULUS,
            "snow.poissons_ratio": POISSONS_RATIO,
            "snow.model": "elastic",
            "numerics.dx": 0.01,
            "numerics.sleep_speed": 0.0,
            "seeding.pattern": "regular",
            "seeding.particles_per_voxel": 4,
        }
    )
