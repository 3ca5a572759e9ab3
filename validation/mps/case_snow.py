"""Snow as a fluid of particles: a slab that slides, and a heap that comes to rest."""

from __future__ import annotations

import math

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.methods.mps.settings import MpsSettings
from snowshed.scene.components import Body, Obstacle
from snowshed.scene.shape import Shape
from snowshed.snow.accuracy.measurements import CaseSettings
from validation.framework.case import Case, Outcome, Quantity
from validation.framework.drive import absolute, relative
from validation.mps.bodies import GRAVITY, block, floor_and_sides, mps_driver

#: Without viscosity Coulomb's friction is exact. With the usual 0.012 Pa s a viscous layer of
#: sqrt(nu t) = 3.5 mm makes the slab 2.6 % slower than that, 1 - 8 sqrt(nu t)/(6 sqrt(pi) H).
SNOW = MpsSettings(density=200.0, viscosity=1e-6, friction_angle=24.0, rheology="bingham")
SLAB_THICKNESS, LENGTH, SLIDING_TIME = 0.1, 2.4, 0.2  # m, m, s
TILTS = (30.0, 35.0, 45.0)  # degrees
FLUID = MpsSettings(
    density=1000.0, viscosity=5.0, cohesion=100.0, friction_angle=0.0, rheology="bingham"
)
HEAP_SIZE = (0.3, 0.2)  # m, width and height before it slumps


def coulomb(tilt: float) -> float:
    """Return the acceleration of a sliding slab, g (sin a - cos a tan phi), m/s2.

    Examples
    --------
    >>> round(coulomb(30.0), 3)
    1.122
    """
    angle = math.radians(tilt)
    return GRAVITY * (math.sin(angle) - math.cos(angle) * math.tan(math.radians(24.0)))


def measure_slab(settings: CaseSettings) -> Outcome:
    """Let a long slab slide, and compare the mean speed of its middle."""
    tilt = float(settings["tilt"])
    angle = math.radians(tilt)
    down, normal = (math.cos(angle), -math.sin(angle)), (math.sin(angle), math.cos(angle))
    plane = Obstacle(name="plane", shape=Shape.plane((0, 0), normal), condition="sticky")
    slab = Shape.transform(
        Shape.box((0, SLAB_THICKNESS / 2), (LENGTH, SLAB_THICKNESS)),
        angle=tilt,
        translate=(0.0, 0.0),
    )
    drive = mps_driver(SNOW, [plane], [Body(shape=slab)], settings, {"tilt"})
    along = np.array([down[0], 0.0, down[1]])
    middle = np.abs(drive.core.positions() @ along) < LENGTH / 12
    drive.run_to(SLIDING_TIME)
    speed = float((drive.core.velocities()[middle] @ along).mean())
    return drive.outcome([relative("speed", speed, coulomb(tilt) * drive.core.time_s)])


def slab_matrix(full: bool) -> list[CaseSettings]:
    """Return tilts, distances between particles, and walls of particles."""
    spacings = (0.02, 0.01, 0.005) if full else (0.02, 0.01)
    settings_list: list[CaseSettings] = [{"tilt": t, "spacing": s} for t in TILTS for s in spacings]
    return settings_list + [{"tilt": t, "spacing": 0.01, "walls": "particles"} for t in TILTS]


#: 2 tau0/(rho g), m.
SCALE = 2 * 100.0 / (1000.0 * GRAVITY)


def resting_front() -> float:
    """Return the position of the front of the heap at rest, m."""
    return float((1.5 * HEAP_SIZE[0] * HEAP_SIZE[1] / math.sqrt(SCALE)) ** (2 / 3))


def resting_heap(positions: Floats) -> Floats:
    """Return the height of a Bingham fluid at rest, sqrt(2 tau0 (xf - x)/(rho g)), m.

    Examples
    --------
    >>> float(resting_heap(np.array([0.0]))[0].__round__(3))
    0.122
    """
    return np.asarray(np.sqrt(SCALE * np.maximum(resting_front() - positions, 0.0)))


def column_heights(x: Floats, spacing: float, width: float) -> Floats:
    """Return the heights of a heap beside x = 0 in columns of this width, m.

    A particle covers the cell around it, because it represents one. Counts of centres jump where a
    row of particles crosses the end of a column.

    Examples
    --------
    >>> column_heights(np.array([0.5, 1.5, 2.0]), 1.0, 2.0)
    array([1.25, 0.25])
    """
    begin = np.maximum(x - spacing / 2, 0.0)
    left = np.arange(int((begin.max() + spacing) / width) + 1)[:, None] * width
    overlap = np.minimum(begin + spacing, left + width) - np.maximum(begin, left)
    heights = np.maximum(overlap, 0.0).sum(axis=1) * spacing / width
    return np.asarray(heights, dtype=np.float64)


def measure_heap(settings: CaseSettings) -> Outcome:
    """Let a heap slump until it rests, and compare its height in columns of two particles."""
    drive = mps_driver(FLUID, floor_and_sides(), [block(*HEAP_SIZE)], settings)
    drive.run_to(2.0)
    spacing = float(settings["spacing"])
    width = 2 * spacing
    x = np.asarray(drive.core.positions()[:, 0], dtype=np.float64)
    middles = (np.arange(int(2.0 / width), dtype=np.float64) + 0.5) * width
    exact = resting_heap(middles)
    heights = column_heights(x, spacing, width)
    difference = exact.copy()
    difference[: len(heights)] -= heights
    error = float(np.sqrt((difference**2).sum() / (exact**2).sum()))
    density = float(drive.core.field_by_id("number_density").max())
    return drive.outcome(
        [
            absolute("profile", error, 0.0),
            relative("front", float(x.max()) + spacing / 2, resting_front()),
            absolute("density", density - 1, 0.0),
        ]
    )


def heap_matrix(full: bool) -> list[CaseSettings]:
    """Return the settings to measure: particle spacings, then walls of particles."""
    spacings = (0.03, 0.02, 0.015) if full else (0.03, 0.02)
    settings_list: list[CaseSettings] = [{"spacing": spacing} for spacing in spacings]
    return [*settings_list, {"spacing": 0.02, "walls": "particles"}]


CASES = (
    Case(
        name="mps_slab",
        title="Slab of snow that slides down a plane, as a fluid of particles",
        source="Newton's law with Coulomb's friction, g (sin a - cos a tan phi)",
        description="""
        Snow without cohesion and viscosity, 0.1 m thick and 2.4 m long, with a friction angle of 24
        degrees, slides down a plane for 0.2 s. The mean speed of its middle sixth is compared.
        """,
        quantities=(
            Quantity("speed", "speed, m/s", limit=0.02, limit_for={"spacing": 0.01}),
        ),
        matrix=slab_matrix,
        measure=measure_slab,
    ),
    Case(
        name="mps_heap",
        title="Heap of a Bingham fluid at rest",
        source="Liu & Mei (1989), Journal of Fluid Mechanics 207, 505-529",
        description="""
        A Bingham fluid with a yield stress of 100 Pa slumps and comes to rest. After 2 s its
        height, in columns two particles wide, is compared with that of a shallow heap that is just
        about to yield. The density is the largest relative excess over that of a lattice.
        """,
        quantities=(
            Quantity(
                "profile", "relative L2 error of the height", limit=0.1,
                limit_for={"spacing": 0.02}, relative=False,
            ),
            Quantity("front", "front, m"),
            Quantity("density", "largest error of the density", relative=False),
        ),
        matrix=heap_matrix,
        measure=measure_heap,
    ),
)  # fmt: skip
