"""A tracker that tilts and dumps its snow."""

from __future__ import annotations

import math
from typing import Optional

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.methods.mpm.settings import MpmSettings
from snowshed.scene.builders.panels import snow_layer
from snowshed.scene.builders.slope import BOARD_CELLS, Slope, check_positive
from snowshed.scene.components import Events, Ground, Motion, Obstacle
from snowshed.scene.scene import Scene


@checked
def tracker(
    *,
    axis_height: float,
    length: float,
    snow: float,
    tilt_from: float = 0.0,
    tilt_to: float = 55.0,
    seconds: float = 4.0,
    width: Optional[float] = None,
    friction: float = 0.5,
    dx: float = 0.02,
    settle: float = 6.0,
) -> Scene:
    """Return a board with snow on it that turns about an axis in the middle of its face.

    The scene has no panel, because a panel stands still: snow that stays on the board counts as
    part of the stack. There is one event, which ends after the board has stopped.

    Parameters
    ----------
    axis_height
        Height of the axis above the ground, m.
    length
        Length of the board along the slope, m.
    snow
        Thickness of the snow, m.
    tilt_from
        Tilt of the board before it turns, degrees; positive falls toward +x.
    tilt_to
        Tilt of the board after it has turned, degrees.
    seconds
        Duration of the turn, s. Real trackers take minutes; the tilt at which the snow slides is
        the same as long as the board moves much more slowly than the snow.
    width
        Width of the board, m; without it the scene is 2D.
    friction
        Coulomb coefficient of the board: snow slides from about atan(friction).
    dx
        Size of grid cells, m; parts must be at least two cells thick.
    settle
        Longest time for the snow to come to rest after the board stops, s.

    Raises
    ------
    InputError
        If the board would reach into the ground.

    Examples
    --------
    >>> scene = tracker(axis_height=1.5, length=2.0, snow=0.1, tilt_to=45.0, seconds=3.0)
    >>> round(scene.obstacles[0].motion.angular_velocity, 4)
    0.2618
    """
    check_positive(axis_height=axis_height, length=length, snow=snow, seconds=seconds)
    for name, tilt in (("tilt_from", tilt_from), ("tilt_to", tilt_to)):
        if not -90.0 < tilt < 90.0:
            raise InputError(
                f"{name}: {tilt:g} is outside the allowed range (-90 < value < 90 degrees)"
            )
    steepest = math.radians(max(abs(tilt_from), abs(tilt_to)))
    least = 0.5 * length * math.sin(steepest) + BOARD_CELLS * dx
    if axis_height < least:
        raise InputError(
            f"axis_height: {axis_height:g} m is not allowed; the board reaches the ground below "
            f"{least:.3g} m"
        )
    slope = _face(axis_height, length, tilt_from, width)
    turn = math.radians(tilt_to - tilt_from) / seconds
    pivot = (0.0, axis_height) if width is None else (0.0, 0.0, axis_height)
    motion = Motion(
        angular_velocity=turn if width is None else (0.0, turn, 0.0), pivot=pivot, end=seconds
    )
    board = Obstacle(
        name="tracker",
        shape=slope.board(0.0, length, BOARD_CELLS * dx),
        condition="separate",
        friction=friction,
        motion=motion,
    )
    return Scene(
        dimension=2 if width is None else 3,
        ground=Ground(),
        obstacles=[board],
        bodies=[snow_layer(slope, 0.0, length, snow)],
        numerics=MpmSettings(dx=dx),
        # Snow that rests on a slowly moving board must not end the event: rest must last for
        # longer than the board moves.
        events=Events(count=1, rest_time=seconds, max_time=2.0 * seconds + settle),
    )


def _face(axis_height: float, length: float, tilt: float, width: Optional[float]) -> Slope:
    """Return the board's face, whose middle is on the axis."""
    half, angle = 0.5 * length, math.radians(tilt)
    return Slope((half * math.cos(angle), axis_height - half * math.sin(angle)), tilt, width)
