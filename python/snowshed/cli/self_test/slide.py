"""A slab of the method "slide" on a plane, against Coulomb's and Voellmy's friction."""

from __future__ import annotations

import math
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Literal

import numpy as np

from snowshed.analysis.accuracy.incline import GRAVITY
from snowshed.io.raster.raster import Raster, write_ascii_grid
from snowshed.methods.slide.settings import SlideSettings
from snowshed.running.event_driver import EventDriver
from snowshed.scene.scene import Scene
from snowshed.scene.terrain_components import Area, Terrain

TILT = 35.0  # degrees
FRICTION = 0.325
TURBULENCE = 300.0  # m/s2
CELL, THICKNESS = 2.0, 0.5  # m
EAST, NORTH = 84.0, 48.0  # m, the terrain
SLAB = ((9.0, 9.0), (39.0, 9.0), (39.0, 39.0), (9.0, 39.0))  # m
MIDDLE = 3.0  # m, half width of the slab's middle, which the edges affect only later
SLIDING = 2.0  # s

Law = Literal["coulomb", "voellmy"]


def coulomb_error() -> float:
    """Return the relative error of a slab's speed with Coulomb's friction: a t."""
    drive, speed = _slid("coulomb")
    return speed / (_acceleration() * drive.core.time_s) - 1


def voellmy_error() -> float:
    """Return the relative error of a slab's speed with Voellmy's friction: U tanh(a t/U).

    U^2 = a xi h/g solves du/dt = a - g u^2/(xi h) from rest.
    """
    drive, speed = _slid("voellmy")
    a = _acceleration()
    fastest = math.sqrt(a * TURBULENCE * THICKNESS / GRAVITY)
    return speed / (fastest * math.tanh(a * drive.core.time_s / fastest)) - 1


def _acceleration() -> float:
    tilt = math.radians(TILT)
    return GRAVITY * (math.sin(tilt) - FRICTION * math.cos(tilt))


def _slid(law: Law) -> tuple[EventDriver, float]:
    """Return a slab that has slid from rest, and the speed of its middle, m/s."""
    with TemporaryDirectory() as folder:
        drive = EventDriver(_scene(law, Path(folder) / "plane.asc"))
    start = drive.core.positions()
    middle = np.hypot(*(start - start.mean(axis=0))[:, :2].T) < MIDDLE
    drive.run_to(SLIDING)
    speeds = np.linalg.norm(drive.core.velocities()[middle], axis=1)
    return drive, float(speeds.mean())


def _scene(law: Law, file: Path) -> Scene:
    fall = math.tan(math.radians(TILT)) * np.arange(0.0, EAST + CELL, CELL)
    rows = round(NORTH / CELL) + 1
    write_ascii_grid(file, Raster(np.tile(1000.0 - fall, (rows, 1)), 0.0, 0.0, CELL))
    numerics = SlideSettings(
        bonds=False,
        mixing_rate=0.0,
        friction_law=law,
        friction=FRICTION,
        turbulence=TURBULENCE,
        stop_ratio=0.0,
        threads=1,
    )
    slab = Area(outline=list(SLAB), thickness=THICKNESS)
    terrain = Terrain(file=file, release=[slab])
    return Scene(method="slide", dimension=3, gravity=GRAVITY, terrain=terrain, numerics=numerics)
