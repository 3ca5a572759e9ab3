"""Free flight of snow from an edge: where it lands, and how fast, in closed form."""

from __future__ import annotations

import math
from dataclasses import dataclass

from snowshed._core import InputError
from snowshed.base.arguments import checked


@dataclass(frozen=True)
class Landing:
    """The flight of a body of snow from the edge to the ground.

    Attributes
    ----------
    edge_speed
        Speed at the edge, m/s, along the slope.
    distance
        Horizontal distance from the edge to the place of landing, m.
    speed
        Speed at landing, m/s.
    angle
        Angle of the path below the horizontal at landing, degrees.
    time
        Duration of the flight, s.
    """

    edge_speed: float
    distance: float
    speed: float
    angle: float
    time: float


def edge_speed(slide: float, tilt: float, friction: float, gravity: float = 9.81) -> float:
    """Return the speed (m/s) of a body that slid from rest, v^2 = 2 g l (sin a - mu cos a).

    Parameters
    ----------
    slide
        Length of the slide, m.
    tilt
        Tilt of the slope, degrees.
    friction
        Coulomb coefficient.
    gravity
        Gravity, m/s2.

    Examples
    --------
    >>> round(edge_speed(4.0, 60.0, 0.2), 2), edge_speed(4.0, 10.0, 0.5)
    (7.75, 0.0)
    """
    angle = math.radians(tilt)
    square = 2.0 * gravity * slide * (math.sin(angle) - friction * math.cos(angle))
    return math.sqrt(max(square, 0.0))


@checked
def landing(
    slide: float,
    tilt: float,
    friction: float,
    height: float,
    gravity: float = 9.81,
    ground_tilt: float = 0.0,
) -> Landing:
    """Return the flight of a body that slides from rest to an edge and falls to the ground.

    The air does not slow it: at 10 m/s the drag on a chunk of 20 cm is about a tenth of its weight.

    Parameters
    ----------
    slide
        Length of the slide to the edge, m.
    tilt, friction
        Tilt of the slope (degrees) and Coulomb coefficient.
    height
        Height of the edge above the ground below it, m.
    gravity
        Gravity, m/s2.
    ground_tilt
        Tilt of the ground in the slide direction, degrees.

    Raises
    ------
    InputError
        If the height or the length is negative, or the ground is steeper than the path.

    Examples
    --------
    >>> flight = landing(4.0, 60.0, 0.2, height=2.0)
    >>> round(flight.distance, 2), round(flight.speed, 1)
    (0.98, 10.0)
    """
    if not (slide >= 0.0 and height >= 0.0):
        raise InputError("a length or a height below 0 is not allowed")
    speed, angle = edge_speed(slide, tilt, friction, gravity), math.radians(tilt)
    along, down = speed * math.cos(angle), speed * math.sin(angle)
    # Height above the ground: height - (down - along tan(ground)) t - g t^2 / 2 = 0.
    closing = down - along * math.tan(math.radians(ground_tilt))
    time = (-closing + math.sqrt(closing**2 + 2.0 * gravity * height)) / gravity
    fall = down + gravity * time
    return Landing(
        speed, along * time, math.hypot(along, fall), math.degrees(math.atan2(fall, along)), time
    )
