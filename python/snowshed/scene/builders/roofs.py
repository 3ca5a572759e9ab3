"""Roofs with one slope (shed) or two (gable), with and without snow guards."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Optional

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.notes import issue_note
from snowshed.scene.builders.guards import note_overloaded_guards
from snowshed.scene.builders.panels import separate_part, single_panel, snow_layer
from snowshed.scene.builders.slope import (
    BOARD_CELLS,
    Slope,
    check_positive,
    check_resolved,
    upright_box,
)
from snowshed.scene.components import Obstacle
from snowshed.scene.panel_edge import panel_edge
from snowshed.scene.scene import Scene
from snowshed.scene.shape import Shape


@checked
def shed_roof(
    *,
    eaves: float,
    length: float,
    tilt: float,
    snow: float,
    width: Optional[float] = None,
    friction: float = 0.3,
    overhang: float = 0.3,
    guards: Sequence[float] = (),
    guard_height: float = 0.15,
    guard_thickness: float = 0.1,
    dx: float = 0.02,
) -> Scene:
    """Return a house under a shed roof (one slope), which is the scene's panel.

    Parameters
    ----------
    eaves
        Height of the eaves above the ground, m.
    length
        Length of a slope, from the eaves to the ridge, m.
    tilt
        Tilt from the horizontal, degrees.
    snow
        Thickness of the snow, normal to the roof, m.
    width
        Width of the house, m; without it the scene is 2D.
    friction
        Coulomb coefficient of the roof.
    overhang
        Overhang of the roof beyond the walls, along the slope, m.
    guards
        Positions of snow guards (rails across the roof), m up the slope from the eaves.
    guard_height
        Height of the guards above the roof, m.
    guard_thickness
        Thickness of the guards along the slope, m.
    dx
        Size of grid cells, m; parts must be at least two cells thick.

    Raises
    ------
    InputError
        If a part is too small for the grid or lies off the roof.

    Examples
    --------
    >>> roof = shed_roof(eaves=2.5, length=4.0, tilt=30.0, snow=0.3, guards=[0.5], dx=0.05)
    >>> [obstacle.name for obstacle in roof.obstacles]
    ['house', 'guard-1']
    """
    scene, slope = _first_slope(eaves, length, tilt, snow, width, friction, dx)
    upper = slope.point(length - overhang)[0]
    scene.append("obstacles", _house([slope], upper, length, overhang, dx))
    rails = _rails(slope, guards, length, (guard_height, guard_thickness), dx)
    _add_rails(scene, "guard", rails)
    _note_unheld_snow(scene, guards, length, guard_height, guard_thickness)
    if rails:  # the scene's own slab would lie in them
        scene.slab = None
        scene.append("bodies", snow_layer(slope, 0.0, length, snow, rails))
    return scene


@checked
def gable_roof(
    *,
    eaves: float,
    length: float,
    tilt: float,
    snow: float,
    width: Optional[float] = None,
    friction: float = 0.3,
    overhang: float = 0.3,
    guards: Sequence[float] = (),
    guard_height: float = 0.15,
    guard_thickness: float = 0.1,
    dx: float = 0.02,
) -> Scene:
    """Return a house under a gable roof (two equal slopes), both with snow.

    The slope that falls toward +x is the scene's panel. Snow from the other slope piles up on the
    far side of the house, and belongs to the stack, too. Snow that stays on a slope does not.

    Parameters
    ----------
    eaves, length, tilt, snow, width, friction, overhang, guards, guard_height, guard_thickness, dx
        As for `shed_roof`.

    Raises
    ------
    InputError
        As for `shed_roof`.

    Examples
    --------
    >>> roof = gable_roof(eaves=2.5, length=3.0, tilt=40.0, snow=0.2, dx=0.05)
    >>> [obstacle.name for obstacle in roof.obstacles]
    ['house', 'far-slope']
    """
    scene, slope = _first_slope(eaves, length, tilt, snow, width, friction, dx)
    far = Slope((2.0 * slope.point(length)[0] - slope.foot[0], eaves), tilt, width, toward=-1)
    upper = far.point(overhang)[0]
    scene.append("obstacles", _house([slope, far], upper, length, overhang, dx))
    board = far.board(0.0, length, BOARD_CELLS * dx)
    scene.append(
        "obstacles",
        Obstacle(name="far-slope", shape=board, condition="separate", friction=friction),
    )
    size = (guard_height, guard_thickness)
    rails, far_rails = (_rails(side, guards, length, size, dx) for side in (slope, far))
    _add_rails(scene, "guard", rails)
    _add_rails(scene, "far-guard", far_rails)
    _note_unheld_snow(scene, guards, length, guard_height, guard_thickness)
    if rails:  # the scene's own slab would lie in them
        scene.slab = None
        scene.append("bodies", snow_layer(slope, 0.0, length, snow, rails))
    scene.append("bodies", snow_layer(far, 0.0, length, snow, far_rails))
    return scene


def _first_slope(
    eaves: float,
    length: float,
    tilt: float,
    snow: float,
    width: Optional[float],
    friction: float,
    dx: float,
) -> tuple[Scene, Slope]:
    check_positive(eaves=eaves, length=length, snow=snow)
    scene = single_panel(
        height=eaves, length=length, tilt=tilt, snow=snow, width=width, friction=friction, dx=dx
    )
    edge = panel_edge(scene.to_data())
    return scene, Slope((edge.x, edge.z), tilt, width)


def _house(
    slopes: Sequence[Slope], upper: float, length: float, overhang: float, dx: float
) -> Obstacle:
    """Return the walls: a box from `upper` to the wall below the eaves, cut off under the roof."""
    first = slopes[0]
    if not 0.0 <= overhang < 0.5 * length:
        raise InputError(
            f"overhang: {overhang:g} m is outside the allowed range (0 <= value < {0.5 * length:g})"
        )
    under = 0.5 * BOARD_CELLS * dx  # inside the boards: walls and roof touch
    dimension = 2 if first.width is None else 3
    half = 0.5 * (first.width or 1.0)
    box = upright_box(
        (upper, first.point(overhang)[0]),
        (0.0, first.point(length)[1]),
        dimension,
        (-half, half),
    )
    above = [_everything_above(slope, under) for slope in slopes]
    return separate_part("house", Shape.difference(box, *above))


def _everything_above(slope: Slope, under: float) -> Shape:
    """Return all space above the plane that lies `under` a slope, m."""
    (x, z), (across, up) = slope.point(0.0, -under), slope.normal
    if slope.width is None:
        return Shape.plane((x, z), (-across, -up))
    return Shape.plane((x, 0.0, z), (-across, 0.0, -up))


def _rails(
    slope: Slope,
    guards: Sequence[float],
    length: float,
    size: tuple[float, float],
    dx: float,
) -> list[Shape]:
    """Return snow guards, of a height and a thickness, at some distances up the slope."""
    height, thickness = size
    for start in guards:
        check_resolved("guard_height", height, dx)
        check_resolved("guard_thickness", thickness, dx)
        if not 0.0 <= start <= length - thickness:
            raise InputError(
                f"guards: {start:g} m is outside the allowed range "
                f"(0 <= value <= {length - thickness:g} m)"
            )
    starts = sorted(guards)
    for lower, upper in zip(starts, starts[1:]):
        if upper < lower + thickness:
            raise InputError(f"guards: those at {lower:g} and {upper:g} m overlap")
    return [slope.layer(start, start + thickness, -dx, height) for start in guards]


#: Length below the lowest guard from which on a note says that its snow is not held, m.
UNHELD = 1.0


def _note_unheld_snow(
    scene: Scene, guards: Sequence[float], length: float, height: float, thickness: float
) -> None:
    """Note which snow the guards do not hold: below the lowest, and above an overloaded one."""
    if guards:
        starts = sorted(guards)
        if starts[0] > UNHELD:
            issue_note(f"no guard holds the snow on the lowest {starts[0]:.1f} m of the roof")
        above = [end - start - thickness for start, end in zip(starts, [*starts[1:], length])]
        note_overloaded_guards(scene, max(above), height)


def _add_rails(scene: Scene, name: str, rails: Sequence[Shape]) -> None:
    for number, rail in enumerate(rails, 1):
        scene.append("obstacles", separate_part(f"{name}-{number}", rail))
