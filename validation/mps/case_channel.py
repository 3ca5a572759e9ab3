"""A Bingham fluid of particles that falls between two plates."""

from __future__ import annotations

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.methods.mps.settings import MpsSettings
from snowshed.scene.components import Body, Obstacle
from snowshed.scene.shape import Shape
from snowshed.snow.accuracy.measurements import CaseSettings
from validation.framework.case import Case, Outcome, Quantity
from validation.framework.drive import relative
from validation.mps.bodies import GRAVITY, mps_driver

HALF_GAP, LENGTH = 0.1, 2.4  # m
STEADY_FROM_S = 0.2
AVERAGED_S = 0.2
DENSITY, VISCOSITY = 100.0, 20.0  # kg/m3, Pa s
FORCE = DENSITY * GRAVITY  # Pa/m, the weight that drives the flow
PLUG_HALF_WIDTH = 0.5 * HALF_GAP  # m; the plug does not yield
FLUID = MpsSettings(
    density=DENSITY,
    viscosity=VISCOSITY,
    cohesion=FORCE * PLUG_HALF_WIDTH,
    friction_angle=0.0,
    rheology="bingham",
)
PARTICLES_ACROSS = (10, 20, 40)  # particles


def exact_speed(positions: Floats) -> Floats:
    """Return the speed (m/s) at distances (m) from the middle.

    Examples
    --------
    >>> exact_speed(np.array([0.0, 0.05, 0.1])).round(4).tolist()
    [0.0613, 0.0613, 0.0]
    """
    sheared = np.maximum(np.abs(positions) - PLUG_HALF_WIDTH, 0.0)
    return np.asarray(FORCE / (2 * VISCOSITY) * ((HALF_GAP - PLUG_HALF_WIDTH) ** 2 - sheared**2))


def plug_half_width(positions: Floats, speeds: Floats) -> float:
    """Return half the width of the plug (m), where the parabola of the sheared fluid has its top.

    Examples
    --------
    >>> positions = np.linspace(-0.1, 0.1, 81)
    >>> round(plug_half_width(positions, exact_speed(positions)), 4)
    0.05
    """
    top = float(speeds[np.abs(positions) < 0.5 * PLUG_HALF_WIDTH].mean())
    sheared = np.abs(positions) > 0.5 * (HALF_GAP + PLUG_HALF_WIDTH)
    below = np.maximum(top - speeds[sheared], 0.0)
    return float((np.abs(positions[sheared]) - np.sqrt(below * 2 * VISCOSITY / FORCE)).mean())


def middle_flow(positions: Floats, fall: Floats) -> tuple[float, float, float]:
    """Return the plug's speed, the mean speed and half the plug's width in the middle of a slug."""
    middle = np.abs(positions[:, 2] - positions[:, 2].mean()) < LENGTH / 6
    positions_x, speeds = positions[middle, 0], fall[middle]
    plug = float(speeds[np.abs(positions_x) < 0.5 * PLUG_HALF_WIDTH].mean())
    return plug, float(speeds.mean()), plug_half_width(positions_x, speeds)


def measure(settings: CaseSettings) -> Outcome:
    """Let a long slug fall until its flow is steady, and compare the flow in its middle."""
    spacing = 2 * HALF_GAP / int(settings["across"])
    plates = [
        Obstacle(name=name, shape=Shape.plane((x, 0), normal), condition="sticky")
        for name, x, normal in (("left", -HALF_GAP, (1, 0)), ("right", HALF_GAP, (-1, 0)))
    ]
    slug = Body(shape=Shape.box((0, 0), (2 * HALF_GAP, LENGTH)))
    drive = mps_driver(FLUID, plates, [slug], {**settings, "spacing": spacing}, {"across"})
    drive.run_to(STEADY_FROM_S)
    flows = []
    while drive.core.time_s < STEADY_FROM_S + AVERAGED_S:
        drive.step()
        flows.append(middle_flow(drive.core.positions(), -drive.core.velocities()[:, 2]))
    speed, discharge, width = np.mean(flows, axis=0)
    ratio = PLUG_HALF_WIDTH / HALF_GAP
    mean = FORCE * HALF_GAP**2 / (3 * VISCOSITY) * (1 - 1.5 * ratio + 0.5 * ratio**3)
    return drive.outcome(
        [
            relative("speed", float(speed), float(exact_speed(np.zeros(1))[0])),
            relative("discharge", float(discharge), mean),
            relative("width", float(width), PLUG_HALF_WIDTH),
        ]
    )


def matrix(full: bool) -> list[CaseSettings]:
    """Return numbers of particles across the channel, with both kinds of walls."""
    across, beside = (
        (PARTICLES_ACROSS, PARTICLES_ACROSS[:2])
        if full
        else (PARTICLES_ACROSS[:2], PARTICLES_ACROSS[:1])
    )
    settings_list: list[CaseSettings] = [{"across": count} for count in across]
    return settings_list + [{"across": count, "walls": "particles"} for count in beside]


CASE = Case(
    name="mps_channel",
    title="Bingham fluid between two plates, as a fluid of particles",
    source="Bird, Dai & Yarusso (1983), Reviews in Chemical Engineering 1, 1-70",
    description="""
    A slug of a Bingham fluid, twelve times as long as wide, falls between two upright plates, to
    which it sticks. Its middle moves like a fluid between plates under its own weight: a plug, half
    as wide as the gap, between two sheared layers. The plug's speed and width and the mean speed
    (the discharge over the gap) are compared, as means over 0.2 s of the steady flow.
    """,
    remarks="""
    The ends of the slug make its middle faster, in inverse proportion to its length, and the more
    the longer it has fallen: at the lower end the plug moves out of the fluid that the plates hold
    back. With 20 particles across, the plugs of slugs 1.2, 2.4 and 4.8 m long are too fast by 6.1,
    2.8 and 1.3 %. The flow of a channel without ends, which is a unit test, is exact to 1.2 % with
    20 particles across.
    """,
    quantities=(
        Quantity("speed", "speed of the plug, m/s", limit=0.05, limit_for={"across": 40}),
        Quantity("discharge", "mean speed, m/s", limit=0.05, limit_for={"across": 40}),
        Quantity("width", "half the width of the plug, m", limit=0.05, limit_for={"across": 40}),
    ),
    matrix=matrix,
    measure=measure,
)
