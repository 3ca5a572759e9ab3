"""Forces of water on walls, as a fluid of particles: at rest, a jet, and a broken dam."""

from __future__ import annotations

import math

import numpy as np

from snowshed.scene.components import Body, Obstacle
from snowshed.scene.shape import Shape
from snowshed.snow.accuracy.measurements import CaseSettings, Measured
from validation.forces.impulses import impulse_on, mean_force
from validation.framework.case import Case, Outcome, Quantity
from validation.framework.drive import TimedEventDriver, relative
from validation.mps.bodies import GRAVITY, WATER, block, floor_and_sides, mps_driver

DEPTH = 0.2  # m, of the water at rest, which is as wide
DENSITY = WATER.density or 1000.0  # kg/m3
SPACINGS = (0.02, 0.01, 0.005)  # m
#: The jet: length, width (m) and speed (m/s). It flies without gravity.
JET = (1.2, 0.1, 5.0)
#: The dam: height of the water, its length, and the length of the tank (m).
DAM = (0.3, 0.6, 1.61)
SENSOR = 0.03  # m, height of the lowest part of the wall over which the pressure is averaged


def measure_tank(settings: CaseSettings) -> Outcome:
    """Let water stand in a tank, and measure the forces on its floor and on a side."""
    drive = _recording(floor_and_sides(DEPTH), [block(DEPTH, DEPTH)], settings)
    drive.run_to(0.5)
    before = impulse_on(drive, "wall 2")
    floor = mean_force(drive, "wall 1", 1.0)
    side = (impulse_on(drive, "wall 2") - before) / 0.5
    weight = DENSITY * GRAVITY * DEPTH**2
    return drive.outcome(
        [
            relative("floor", -float(floor[2]), weight),
            relative("side", -float(side[0]), 0.5 * weight),
        ]
    )


def measure_jet(settings: CaseSettings) -> Outcome:
    """Shoot a jet against a plate, and measure the force while it is steady."""
    length, width, speed = JET
    plate = Obstacle(
        name="plate", shape=Shape.plane((0.0, 0.0), (-1.0, 0.0)), condition="slip", friction=0.0
    )
    jet = Body(shape=Shape.box((-0.5 * length - 0.02, 0.0), (length, width)), velocity=(speed, 0.0))
    drive = _recording([plate], [jet], settings, gravity=0.0)
    drive.run_to(0.3 * length / speed)
    force = mean_force(drive, "plate", 0.8 * length / speed)
    return drive.outcome([relative("force", float(force[0]), DENSITY * width * speed**2)])


def measure_dam(settings: CaseSettings) -> Outcome:
    """Let water flow from a broken dam against a wall, and measure the pressure at its foot."""
    height, length, tank = DAM
    foot = Obstacle(
        name="foot",
        shape=Shape.box((tank + 0.5, 0.5 * SENSOR), (1.0, SENSOR)),
        condition="sticky",
    )
    above = Obstacle(
        name="above", shape=Shape.box((tank + 0.5, SENSOR + 1.0), (1.0, 2.0)), condition="sticky"
    )
    drive = _recording([*floor_and_sides(), foot, above], [block(length, height)], settings)
    unit = math.sqrt(height / GRAVITY)
    pressures, arrival = [], 0.0
    while drive.core.time_s < 5.0 * unit:
        force = mean_force(drive, "foot", drive.core.time_s + 0.01)
        pressure = float(force[0]) / (SENSOR * DENSITY * GRAVITY * height)
        if pressure > 0.05 and not arrival:
            arrival = drive.core.time_s / unit
        pressures.append(pressure)
    return drive.outcome(
        [
            Measured("peak", max(pressures), 3.0, abs(max(pressures) / 3.0 - 1.0)),
            Measured("later", float(np.median(pressures[-20:])), 1.0, 0.0),
            Measured("arrival", arrival, 2.4, 0.0),
        ]
    )


def _recording(
    obstacles: list[Obstacle], bodies: list[Body], settings: CaseSettings, gravity: float = GRAVITY
) -> TimedEventDriver:
    return mps_driver(
        WATER, obstacles, bodies, settings, scene_settings={"output.forces": True,
                                                            "gravity": gravity}
    )  # fmt: skip


def spacing_matrix(full: bool) -> list[CaseSettings]:
    """Return the spacings of the particles."""
    return [{"spacing": spacing} for spacing in (SPACINGS if full else SPACINGS[:2])]


TANK = Case(
    name="forces_tank",
    title="Forces of water at rest on the walls of a tank",
    source="hydrostatics: rho g h on the floor, rho g h²/2 on a side",
    description="""
    Water stands in a tank, 0.2 m wide and deep, as a fluid of particles between mirrors. The mean
    forces from 0.5 to 1 s are compared.
    """,
    quantities=(
        Quantity("floor", "force on the floor", limit=0.005, limit_for={"spacing": 0.01}),
        Quantity("side", "force on a side", limit=0.01),
    ),
    matrix=spacing_matrix,
    measure=measure_tank,
    remarks="""
    The pressure at a wall is continued from the particles beside it, and is too high by up to a
    per cent on a coarse spacing. Resting loads are scaled to the weight.
    """,
)
JET_ON_PLATE = Case(
    name="forces_jet",
    title="Force of a jet of water on a plate",
    source="momentum: rho b v² per metre of width",
    description="""
    A jet of water, 0.1 m wide and 1.2 m long, hits a plate at right angles with 5 m/s, without
    gravity. The mean force is measured while the jet is steady.
    """,
    quantities=(Quantity("force", "force on the plate", limit=0.05, limit_for={"spacing": 0.01}),),
    matrix=spacing_matrix,
    measure=measure_jet,
)
DAM_ON_WALL = Case(
    name="forces_dam",
    title="Pressure of a broken dam at the foot of a wall",
    source=(
        "Fluids 7 (2022), 258, doi:10.3390/fluids7080258: the pressure at the impact is about "
        "three times the static pressure of the reservoir"
    ),
    description="""
    Water, 0.3 m high and 0.6 m long, flows through a tank of 1.61 m against a wall. The pressure on
    the lowest 3 cm of the wall, a mean over 10 ms, is compared in units of rho g H. Peaks of
    repeated experiments scatter by tens of per cent.
    """,
    quantities=(
        Quantity("peak", "largest pressure over rho g H", limit=0.4, limit_for={"spacing": 0.01}),
        Quantity("later", "pressure after the impact over rho g H", relative=False),
        Quantity("arrival", "arrival in sqrt(H/g)", relative=False),
    ),
    matrix=spacing_matrix,
    measure=measure_dam,
)
CASES = (TANK, JET_ON_PLATE, DAM_ON_WALL)
