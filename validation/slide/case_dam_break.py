"""Dry dam break on a slope with Coulomb friction."""

from __future__ import annotations

import math

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.snow.accuracy.measurements import CaseSettings, Measured
from validation.framework.case import Case, Outcome, Quantity
from validation.framework.drive import absolute
from validation.slide.site import Plane, Site, maps_of, rectangle, slide_drive, strip_mean

PLANE = Plane(30.0)
FRICTION = math.tan(math.radians(20.0))
THICKNESS, DURATION = 1.0, 3.0  # m, s
LENGTH = 40.0  # m, along the slope
HALF_WIDTH = 14.0  # m, on the map
STRIP_HALF_WIDTH = 3.0  # m, half the width of the compared strip, which the sides do not affect
FRONT_THICKNESS = 0.05  # share of the dam's height; the front is the end of snow thicker than this

DEFAULTS: CaseSettings = {"cell": 2.0, "time_step": 0.02, "columns": "across_flow"}
#: Thickness of a cell's snow in one particle, m: about 4, 9, 16 and 36 particles per cell.
LAYERS = (0.28, 0.126, 0.071, 0.0317)


def wave_speed(columns: str) -> float:
    """Return the speed of small waves behind the dam, m/s; sqrt(g h cos) with normal columns."""
    return math.sqrt(PLANE.pressing_gravity(columns) * THICKNESS)


def exact_thickness(s: Floats, time: float, columns: str) -> Floats:
    """Return the thickness (m) at positions down the slope from the dam.

    Mangeney et al. (2000): relative to snow that slides with the acceleration m = g (sin - mu cos),
    the dam breaks as on level ground. With x' = s - m t^2/2, h = (2 c - x'/t)^2/(9 g cos) for
    -c t < x' < 2 c t. Vertical columns press with g/cos in place of g cos.

    Examples
    --------
    In axes that move with the snow, the thickness at the dam is 4/9 of the initial one.

    >>> exact_thickness(np.array([PLANE.coulomb(FRICTION) / 2]), 1.0, "vertical").round(6).tolist()
    [0.444444]
    """
    c = wave_speed(columns)
    place = (s - 0.5 * PLANE.coulomb(FRICTION) * time**2) / time
    fan = (2 * c - np.clip(place, -c, 2 * c)) ** 2 / (9 * PLANE.pressing_gravity(columns))
    return np.asarray(fan)


def exact_front(time: float, columns: str) -> float:
    """Return the distance down the slope at which the thickness is `FRONT_THICKNESS`, m."""
    ahead = wave_speed(columns) * (2 - 3 * math.sqrt(FRONT_THICKNESS)) * time
    return 0.5 * PLANE.coulomb(FRICTION) * time**2 + ahead


def measure(settings: CaseSettings) -> Outcome:
    """Release a dam and compare the profile along its middle."""
    columns = str(settings["columns"])
    cosine = math.cos(PLANE.angle)
    dam = rectangle(-LENGTH * cosine, -HALF_WIDTH, 0.0, HALF_WIDTH, THICKNESS)
    site = Site(PLANE.height, -48.0, -28.0, 40.0, 28.0, [dam])
    drive = slide_drive(site, {"friction": FRICTION, **settings})
    drive.run_to(DURATION)
    maps, time = maps_of(drive), drive.core.time_s
    x, thickness = strip_mean(maps, maps.thickness, STRIP_HALF_WIDTH)
    s = x / cosine
    reach = wave_speed(columns) * time
    near = s > 0.5 * PLANE.coulomb(FRICTION) * time**2 - reach - 5.0  # without the upper end
    differs = np.abs(thickness - exact_thickness(s, time, columns))[near]
    profile = float(differs.sum() * maps.cell / cosine / (THICKNESS * reach))
    return drive.outcome(
        [
            Measured("profile", profile, 0.0, profile),
            absolute(
                "front",
                _front(s, thickness) / (3 * reach),
                exact_front(time, columns) / (3 * reach),
            ),
        ]
    )


def _front(s: Floats, thickness: Floats) -> float:
    """Return the position of the front, interpolated between nodes, m."""
    last = int(np.flatnonzero(thickness > FRONT_THICKNESS * THICKNESS)[-1])
    above, below = thickness[last], thickness[last + 1]
    share = (above - FRONT_THICKNESS * THICKNESS) / (above - below)
    return float(s[last] + share * (s[last + 1] - s[last]))


def matrix(full: bool) -> list[CaseSettings]:
    """Return sizes of particles with two sizes of cells, and several time steps."""
    if not full:
        coarse: list[CaseSettings] = [
            {**DEFAULTS, "layer_thickness": layer} for layer in LAYERS[:3]
        ]
        return [*coarse, {**coarse[-1], "columns": "vertical"}]
    settings_list: list[CaseSettings] = [{**DEFAULTS, "layer_thickness": layer} for layer in LAYERS]
    settings_list += [
        {**DEFAULTS, "cell": 1.0, "time_step": 0.01, "layer_thickness": layer} for layer in LAYERS
    ]
    settings_list += [
        {**DEFAULTS, "layer_thickness": LAYERS[2], "time_step": dt} for dt in (0.04, 0.005)
    ]
    settings_list += [
        {**DEFAULTS, "layer_thickness": LAYERS[2], **change}
        for change in ({"columns": "vertical"}, {"mixing_rate": 1.0}, {"mixing_rate": 8.0})
    ]
    return settings_list


CASE = Case(
    name="dam_break",
    title="Dry dam break on a slope with Coulomb friction",
    source=(
        "Mangeney, Heinrich & Roche (2000), Analytical solution for testing debris avalanche "
        "numerical models, Pure and Applied Geophysics 157, 1081-1096"
    ),
    description="""
    Snow 1 m thick behind a dam on a plane of 30 degrees, friction angle 20 degrees, is released.
    After 3 s the thickness along the middle of a strip 28 m wide is compared; the waves from its
    sides and its upper end have not reached the middle. The error of the profile is the mean
    absolute difference over the wave behind the dam, relative to the dam's height. At the front the
    thickness is a twentieth of the dam's height; the error of its position is relative to the
    length of the fan. There are no bonds, and velocities do not mix.
    """,
    quantities=(
        Quantity(
            "profile",
            "mean error of thickness over that of the dam",
            limit=0.08,
            limit_for={
                "cell": 2.0,
                "layer_thickness": LAYERS[2],
                "time_step": 0.02,
                "mixing_rate": None,
            },
            order_in="layer_thickness",
            min_order=0.5,
        ),
        Quantity(
            "front",
            "front over the length of the fan",
            limit=0.10,
            limit_for={
                "cell": 2.0,
                "layer_thickness": LAYERS[2],
                "time_step": 0.02,
                "mixing_rate": None,
            },
            relative=False,
        ),
    ),
    matrix=matrix,
    measure=measure,
    remarks="""
    The error falls with the number of particles within a cell, that is within the kernel. It is
    about proportional to the distance between particles, that is the square root of their area.
    Four particles per cell are too few: where the thickness has fallen to a third, they have no
    neighbours, and the front stays behind. Smaller cells alone do not help.

    Mixing (by default, at 8 1/s) slows the front far more than any other setting. It is meant for
    rough ground, where it damps the noise of particles.
    """,
)
