"""Snow that enters a slide, that forest takes, and that meets a dam."""

from __future__ import annotations

import math

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.scene.terrain_components import Dam, DamCorner, Inflow, Pulse, ResistanceArea
from snowshed.snow.accuracy.measurements import CaseSettings
from validation.framework.case import Case, Outcome, Quantity
from validation.framework.drive import TimedEventDriver, relative
from validation.slide.site import GRAVITY, Plane, Site, rectangle, slide_drive

DENSITY, THICKNESS, SPEED = 300.0, 0.5, 5.0  # kg/m3, m, m/s
TILT = 30.0  # degrees, of the ground under the inflow
PULSES = ((0.5, 0.3), (1.0, 0.2), (1.5, 0.4))  # s and m of the hydrograph
DETRAINMENT = 60.0  # Pa
RESTITUTION, FAST = 0.5, 12.0  # 1, m/s
DAM_AT, HIGH, LOW = 42.0, 30.0, 3.0  # m
ORIGIN = np.array([-6.0, -30.0, 0.0])  # m, of the solver's coordinates
CASE_SETTINGS = frozenset({"part"})

DEFAULTS: CaseSettings = {
    "cell": 2.0,
    "layer_thickness": 0.06,
    "time_step": 0.01,
    "density": DENSITY,
    "friction": 0.0,
}


def level(x: Floats, y: Floats) -> Floats:
    """Return level ground."""
    return np.asarray(0.0 * x + 0.0 * y)


def speed_behind(speed: float, height: float) -> float:
    """Return the speed of snow behind a dam whose crown is so high above the snow's surface.

    Examples
    --------
    >>> speed_behind(10.0, 0.0), speed_behind(5.0, 3.0)
    (10.0, 0.0)
    """
    return math.sqrt(max(0.0, speed**2 - 2.0 * GRAVITY * height))


def measure(settings: CaseSettings) -> Outcome:
    """Measure the part of the case that the settings name."""
    return {"inflow": _inflow, "forest": _forest, "held": _dam, "passed": _dam}[
        str(settings["part"])
    ](settings)


def _inflow(settings: CaseSettings) -> Outcome:
    release = [rectangle(4.0, -6.0, 12.0, 6.0, THICKNESS)]
    area = rectangle(20.3, -6.3, 31.1, 7.7, THICKNESS)
    hydrograph = [Pulse(time=time, thickness=height, speed=4.0) for time, height in PULSES]
    inflow = Inflow(outline=area.outline, hydrograph=hydrograph)
    site = Site(Plane(TILT).height, -10.0, -24.0, 90.0, 24.0, release)
    drive = slide_drive(site, settings, CASE_SETTINGS, inflows=[inflow])
    before = drive.masses.sum()
    drive.run_to(2.0)
    sloping = 10.8 * 14.0 / math.cos(math.radians(TILT))
    exact = DENSITY * sloping * math.fsum(height for _, height in PULSES)
    entered = float(np.sum(drive.core.masses()) - before)
    return drive.outcome([relative("inflow", entered, exact)])


def _gliding(settings: CaseSettings, speed: float, **parts: object) -> TimedEventDriver:
    release = [rectangle(4.0, -20.0, 40.0, 20.0, THICKNESS)]
    drive = slide_drive(
        Site(level, float(ORIGIN[0]), float(ORIGIN[1]), 110.0, 30.0, release),
        settings,
        CASE_SETTINGS,
        **parts,
    )
    drive.core.add_velocity(np.tile([speed, 0.0, 0.0], (len(drive.core.positions()), 1)))
    return drive


def _forest(settings: CaseSettings) -> Outcome:
    forest = ResistanceArea(outline=[(-5.0, -29.0), (109.0, -29.0), (109.0, 29.0), (-5.0, 29.0)])
    own = {**settings, "detrainment": DETRAINMENT, "resistance": 0.0}
    drive = _gliding(own, SPEED, resistance=[forest])
    start, masses = drive.core.positions() + ORIGIN, np.asarray(drive.core.masses())
    middle = (np.abs(start[:, 0] - 22.0) < 8.0) & (np.abs(start[:, 1]) < 10.0)
    drive.run_to(1.0)
    lost = float((masses - np.asarray(drive.core.masses()))[middle].sum())
    area = float(masses[middle].sum()) / (DENSITY * THICKNESS)
    return drive.outcome([relative("detrained", lost, DETRAINMENT / SPEED * area * 1.0)])


def _dam(settings: CaseSettings) -> Outcome:
    held = settings["part"] == "held"
    height = HIGH if held else LOW
    line = [DamCorner(x=DAM_AT, y=y, height=height) for y in (-29.0, 29.0)]
    drive = _gliding(settings, FAST, dams=[Dam(corners=line, restitution=RESTITUTION)])
    start = drive.core.positions() + ORIGIN
    edge = (np.abs(start[:, 1]) < 8.0) & (start[:, 0] > 36.0)
    before = start[:, 0]
    velocity = drive.core.velocities()[:, 0]
    speeds: list[tuple[float, float]] = []
    while drive.core.time_s < 0.45:
        drive.step(1)
        x, now = drive.core.positions()[:, 0] + ORIGIN[0], drive.core.velocities()[:, 0]
        meets = edge & (np.abs(now - velocity) > 1.0) & (before < DAM_AT)
        for index in np.flatnonzero(meets & (velocity > 6.0)):
            crown = LOW - float(drive.core.field("thickness")[index])
            exact = -RESTITUTION * velocity[index] if held else speed_behind(velocity[index], crown)
            speeds.append((float(now[index]), exact))
        before, velocity = x, now
    measured, exact = np.mean(speeds, axis=0).tolist()
    return drive.outcome([relative("reflected" if held else "behind", measured, exact)])


def matrix(full: bool) -> list[CaseSettings]:
    """Return all parts with three cells and three time steps, which take seconds."""
    del full
    return [
        {**DEFAULTS, "cell": cell, "time_step": step, "part": part}
        for part in ("inflow", "forest", "held", "passed")
        for cell in (1.0, 2.0, 4.0)
        for step in (0.02, 0.01, 0.005)
    ]


CASE = Case(
    name="slide_events",
    title="Inflow with a hydrograph, detrainment in forest, and dams",
    source=(
        "conservation of mass; dm/dt = -K A/u (Feistl et al. 2014) at constant speed; the energy "
        "that it takes to climb a dam"
    ),
    description="""
    Snow of three times enters an area on a plane of 30 degrees; its mass is compared with density
    times sloping area times the sum of the thicknesses. On level ground without friction a slab
    glides at 5 m/s through forest; the mass lost by its middle in 1 s is compared with K A t/u. At
    12 m/s a slab meets a dam: its speed after a high one is compared with the restitution times the
    speed before, and after a low one with the square root of u² - 2 g H.
    """,
    quantities=(
        Quantity("inflow", "mass that entered, kg", limit=1e-8),
        Quantity("detrained", "mass that forest took from the middle, kg", limit=0.02),
        Quantity("reflected", "speed away from a high dam, m/s", limit=0.03),
        Quantity("behind", "speed behind a low dam, m/s", limit=0.03),
    ),
    matrix=matrix,
    measure=measure,
    remarks="""
    The pressure of the step in which snow meets the dam adds to the speed that the dam leaves; the
    difference falls with the time step. The thickness in the forest is interpolated from the nodes.
    """,
)
