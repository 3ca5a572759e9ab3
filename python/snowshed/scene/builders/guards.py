"""The hand calculation of a snow guard: how much snow above it the snow's own strength carries.

A guard that stands firm loads the snow behind it. Snow crushes there, and flows over the guard, if
the stress along the slope exceeds the strength of the modified Cam clay law (Gaume et al. 2018,
Nat. Commun. 9, 3047).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from snowshed.base.notes import issue_note
from snowshed.scene.scene import Scene


def crushing_stress(snow: Mapping[str, Any], confinement: float) -> float:
    """Return the largest stress, Pa, that snow carries between equal smaller stresses.

    Parameters
    ----------
    snow
        Complete snow of the Cam clay model.
    confinement
        The smaller stresses, Pa.

    Examples
    --------
    >>> from snowshed.scene.components import Snow
    >>> snow = Snow.preset("calibrated").to_data() | {"cohesion": 0.2}
    >>> round(crushing_stress(snow, 0.0)), round(crushing_stress(snow, 300.0))
    (1484, 1866)
    """
    slope, cohesion = float(snow["critical_state_slope"]), float(snow["cohesion"])
    pressure = float(snow["preconsolidation_pressure"])
    # The yield surface (1 + 2 b) q^2 + M^2 (p + b p0) (p - p0) = 0 with p = confinement + q / 3.
    low, high = confinement + cohesion * pressure, confinement - pressure
    square = 1.0 + 2.0 * cohesion + slope**2 / 9.0
    linear, constant = slope**2 * (low + high) / 3.0, slope**2 * low * high
    root = math.sqrt(max(linear**2 - 4.0 * square * constant, 0.0))
    return confinement + max((-linear + root) / (2.0 * square), 0.0)


def carried_length(
    snow: Mapping[str, Any],
    thickness: float,
    tilt: float,
    friction: float,
    guard_height: float,
    gravity: float = 9.81,
) -> float:
    """Return the length of slope above a guard whose snow the guard holds, m.

    The downslope weight of the snow, less its friction on the roof, is carried through the height
    of the guard at the crushing stress of the snow. The confinement is the mean stress of the
    snow's weight normal to the roof.

    Parameters
    ----------
    snow
        Complete snow of the Cam clay model.
    thickness
        Thickness of the snow, normal to the roof, m.
    tilt
        Tilt of the roof, degrees.
    friction
        Coulomb coefficient of the roof.
    guard_height
        Height of the guard, m.
    gravity
        Gravity, m/s2.

    Examples
    --------
    >>> from snowshed.scene.components import Snow
    >>> snow = Snow.preset("calibrated").to_data() | {"cohesion": 0.2}
    >>> round(carried_length(snow, 0.3, 30.0, 0.3, guard_height=0.3), 1)
    3.7
    """
    weight, slope = float(snow["density"]) * gravity, math.radians(tilt)
    pull = weight * (math.sin(slope) - friction * math.cos(slope))
    if pull <= 0.0:
        return math.inf
    stress = crushing_stress(snow, 0.5 * weight * thickness * math.cos(slope))
    return stress * min(guard_height / thickness, 1.0) / pull


def note_overloaded_guards(scene: Scene, above: float, guard_height: float) -> None:
    """Note that snow will flow over a guard, if the hand calculation says so.

    Parameters
    ----------
    scene
        The scene of the roof, with its slab.
    above
        Length of the slope from the guard to the next one or to the ridge, m.
    guard_height
        Height of the guard, m.
    """
    data = scene.resolve().data
    panel, snow, thickness = data["panel"], data["snow"], data["slab"]["thickness"]
    if snow["model"] != "cam_clay":
        return
    carried = carried_length(
        snow, thickness, panel["tilt"], panel["friction"], guard_height, data["gravity"]
    )
    if above > carried:
        issue_note(
            f"snow crushes at a guard and flows over it: {above:.1f} m of slope lie above one "
            f"guard, but the strength of this snow carries about {carried:.1f} m (hand calculation)"
        )
