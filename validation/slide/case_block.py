"""Block of snow that slides down a plane, with Coulomb's and with Voellmy's friction."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from snowshed.snow.accuracy.measurements import CaseSettings
from validation.framework.case import Case, Outcome, Quantity
from validation.framework.drive import absolute, relative
from validation.slide.site import GRAVITY, Plane, Site, rectangle, slide_drive

PLANE = Plane(35.0)
FRICTION, TURBULENCE, THICKNESS = 0.325, 300.0, 0.5  # 1, m/s2, m
HALF = 15.0  # m, half the block's edge on the map
MIDDLE = 3.0  # m; particles within this distance of the block's middle are measured
SLIDING_TIME = 3.0  # s; the edges affect the middle only later
STOPPING = 1.1  # friction that stops a block
THROWN = 4.0  # m/s, at which this block starts down the slope
CASE_SETTINGS = frozenset({"law"})

DEFAULTS: CaseSettings = {"cell": 2.0, "layer_thickness": 0.06, "time_step": 0.01}


class BlockMotion(NamedTuple):
    """Distance (m) and speed (m/s) of a block after a time."""

    distance: float
    speed: float


def block_motion(law: str, time: float) -> BlockMotion:
    """Return the distance and the speed of a block that slides from rest.

    Coulomb: du/dt = a = g (sin - mu cos). Voellmy: du/dt = a - g u^2/(xi h), so that
    u = U tanh(a t/U) with U^2 = a xi h/g, and the distance is U^2/a ln cosh(a t/U).

    Examples
    --------
    >>> round(block_motion("coulomb", 2.0).speed / block_motion("coulomb", 1.0).speed, 6)
    2.0
    """
    a = PLANE.coulomb(FRICTION)
    if law == "coulomb":
        return BlockMotion(0.5 * a * time**2, a * time)
    terminal = math.sqrt(a * TURBULENCE * THICKNESS / GRAVITY)
    grown = a * time / terminal
    return BlockMotion(terminal**2 / a * math.log(math.cosh(grown)), terminal * math.tanh(grown))


def measure(settings: CaseSettings) -> Outcome:
    """Measure the middle of a wide block that slides from rest, or stops after a throw."""
    stops = settings["law"] == "stop"
    block = rectangle(-HALF, -HALF, HALF, HALF, THICKNESS)
    site = Site(PLANE.height, -24.0, -24.0, 60.0, 24.0, [block])
    drive = slide_drive(
        site,
        {
            "friction": STOPPING if stops else FRICTION,
            "friction_law": "voellmy" if settings["law"] == "voellmy" else "coulomb",
            "turbulence": TURBULENCE,
            **settings,
        },
        CASE_SETTINGS,
    )
    start = drive.core.positions()
    centre = start.mean(axis=0)
    middle = np.hypot(*(start - centre)[:, :2].T) < MIDDLE
    down = np.array([math.cos(PLANE.angle), 0.0, -math.sin(PLANE.angle)])
    if stops:
        drive.core.add_velocity(np.tile(THROWN * down, (len(start), 1)))
    drive.run_to(SLIDING_TIME)
    distance = float(((drive.core.positions() - start)[middle] @ down).mean())
    speed = float((drive.core.velocities()[middle] @ down).mean())
    if stops:
        exact = THROWN**2 / (-2 * PLANE.coulomb(STOPPING))
        return drive.outcome([relative("distance", distance, exact), absolute("creep", speed, 0.0)])
    motion = block_motion(str(settings["law"]), drive.core.time_s)
    return drive.outcome(
        [relative("distance", distance, motion.distance), relative("speed", speed, motion.speed)]
    )


def matrix(full: bool) -> list[CaseSettings]:
    """Return both laws of friction, with several time steps, sizes of particles and cells."""
    steps = (0.04, 0.02, 0.01, 0.005, 0.0025) if full else (0.02, 0.01)
    particles = (0.25, 0.06, 0.03) if full else (0.25,)
    settings_list: list[CaseSettings] = []
    for law in ("coulomb", "voellmy", "stop"):
        base: CaseSettings = {**DEFAULTS, "law": law}
        settings_list += [{**base, "time_step": dt} for dt in steps]
        settings_list += [
            {**base, "layer_thickness": layer} for layer in particles if layer != 0.06
        ]
        settings_list += [{**base, "cell": 1.0}] if full else []
    return settings_list


CASE = Case(
    name="slide_block",
    title="Block of snow on a plane, with Coulomb's and with Voellmy's friction",
    source=(
        "Newton's law with friction mu sigma, and mu sigma + rho g u²/xi (Voellmy 1955), in closed "
        "form"
    ),
    description="""
    Half a metre of snow, 30 m long and wide on the map, slides down a plane of 35 degrees for 3 s,
    without bonds and without mixing. The distance and the speed of its middle, where
    the thickness does not change, are compared. With μ = 1.1 a block that starts down the slope at
    4 m/s must stop after v²/(2 a), and must not move afterwards.
    """,
    quantities=(
        Quantity(
            "distance", "distance down the slope, m", limit=0.005, limit_for={"time_step": 0.01}
        ),
        Quantity("speed", "speed, m/s", limit=0.005, limit_for={"time_step": 0.01}),
        Quantity("creep", "speed after stopping, m/s", limit=1e-9, relative=False),
    ),
    matrix=matrix,
    measure=measure,
    remarks="""
    Coulomb's friction is exact except for the step in which snow stops. Voellmy's is implicit, of
    first order in the time step.
    """,
)
