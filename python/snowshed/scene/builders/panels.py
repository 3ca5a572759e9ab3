"""Panels: several in a row, and tables of modules with gaps on posts."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Optional

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.methods.mpm.settings import MpmSettings
from snowshed.scene.builders.slope import (
    BOARD_CELLS,
    Slope,
    check_positive,
    check_resolved,
    upright_box,
)
from snowshed.scene.components import Body, Ground, Obstacle, Panel, Slab
from snowshed.scene.panel_edge import ground_tilt, panel_edge
from snowshed.scene.scene import Scene
from snowshed.scene.shape import Shape

SNOW_OF_PANEL = 2.0 / 3.0  # width of the slab over width of the panel, the default of a scene


@checked
def single_panel(
    *,
    height: float,
    length: float,
    tilt: float,
    snow: float,
    width: Optional[float] = None,
    friction: float = 0.3,
    ground_tilt: float = 0.0,
    dx: float = 0.02,
) -> Scene:
    """Return the scene of one panel, from which the other builders start.

    Parameters
    ----------
    height
        Height of the lower edge above the ground, m.
    length
        Length along the slope, m.
    tilt
        Tilt from the horizontal, degrees.
    snow
        Thickness of the snow, normal to the slope, m.
    width
        Width across the slope, m; without it the scene is 2D.
    friction
        Coulomb coefficient of the surface on which the snow slides.
    ground_tilt
        Tilt of the ground, degrees; positive falls in the slide direction.
    dx
        Size of grid cells, m; parts must be at least two cells thick.

    Examples
    --------
    >>> single_panel(height=0.5, length=2.0, tilt=40.0, snow=0.1).dimension
    2
    """
    return Scene(
        dimension=2 if width is None else 3,
        panel=Panel(height=height, length=length, width=width, tilt=tilt, friction=friction),
        slab=Slab(thickness=snow),
        ground=Ground(tilt=ground_tilt),
        numerics=MpmSettings(dx=dx),
    )


@checked
def panel_rows(
    count: int,
    pitch: float,
    *,
    height: float,
    length: float,
    tilt: float,
    snow: float,
    width: Optional[float] = None,
    friction: float = 0.3,
    ground_tilt: float = 0.0,
    dx: float = 0.02,
) -> Scene:
    """Return several panels in a row, all with snow, on level or tilted ground.

    The first is the scene's panel; the others stand down the slide direction. Snow that stays on
    any of them does not count as stack. Only on the first panel is a new slab laid on top of
    remaining snow.

    Parameters
    ----------
    count
        Number of panels, at least 2.
    pitch
        Horizontal distance from a panel to the next, m.
    height, length, tilt, snow, width, friction, ground_tilt, dx
        As for `single_panel`.

    Raises
    ------
    InputError
        If the panels overlap.

    Examples
    --------
    >>> rows = panel_rows(3, 4.0, height=0.6, length=2.0, tilt=35.0, snow=0.1)
    >>> [obstacle.name for obstacle in rows.obstacles]
    ['panel-2', 'panel-3']
    """
    check_positive(pitch=pitch, length=length, snow=snow)
    if count < 2:
        raise InputError(f"count: {count} is not allowed; give 2 panels or more")
    scene = single_panel(
        height=height, length=length, tilt=tilt, snow=snow, width=width, friction=friction,
        ground_tilt=ground_tilt, dx=dx,
    )  # fmt: skip
    for number, slope in enumerate(further_rows(scene.to_data(), count, pitch), 2):
        scene.append("obstacles", row_board(number, slope, length, friction, dx))
        scene.append("bodies", snow_layer(slope, 0.0, length, snow))
    return scene


def further_rows(scene: Mapping[str, Any], count: int, pitch: float) -> list[Slope]:
    """Return the faces of all rows but the first, which is the panel of a scene's data.

    Parameters
    ----------
    scene
        Data with the panel, the ground and the cells.
    count, pitch
        As for `panel_rows`.

    Raises
    ------
    InputError
        If the panels overlap.
    """
    panel, edge = scene["panel"], panel_edge(scene)
    least = panel["length"] * math.cos(math.radians(panel["tilt"])) + 2 * scene["numerics"]["dx"]
    if pitch < least:
        raise InputError(
            f"pitch: {pitch:g} m is not allowed; the panels overlap below {least:.3g} m"
        )
    fall = math.tan(math.radians(ground_tilt(scene)))
    width = panel.get("width") if scene["dimension"] == 3 else None
    away = [number * pitch for number in range(1, count)]
    return [Slope((edge.x + x, edge.z - x * fall), panel["tilt"], width) for x in away]


def row_board(number: int, slope: Slope, length: float, friction: float, dx: float) -> Obstacle:
    """Return the board of a row, of a number from 2."""
    return _board(f"panel-{number}", slope, 0.0, length, friction, dx)


@checked
def panel_table(
    modules: int,
    gap: float,
    *,
    module_length: float,
    height: float,
    tilt: float,
    snow: float,
    width: Optional[float] = None,
    friction: float = 0.3,
    ground_tilt: float = 0.0,
    lip: float = 0.0,
    posts: Sequence[float] = (0.2, 0.8),
    post_size: float = 0.1,
    dx: float = 0.02,
) -> Scene:
    """Return a table of modules on posts, with gaps between them, under one slab.

    The lowest module is the scene's panel: x is 0 at its centre, and the height of the table is
    the height of its lower edge.

    Parameters
    ----------
    modules
        Number of modules up the slope.
    gap
        Gap between modules, m; 0 or at least two grid cells.
    module_length
        Length of a module along the slope, m.
    height, tilt, snow, width, friction, ground_tilt, dx
        As for `single_panel`.
    lip
        Height of the frame above the face at each module's lower end, m; 0, or at least two grid
        cells and at most the gap.
    posts
        Positions of the posts, relative to the table's length, from its lower end.
    post_size
        Thickness of the posts, m.

    Raises
    ------
    InputError
        If a part is too small for the grid, or a post does not fit below the table.

    Examples
    --------
    >>> table = panel_table(2, 0.06, module_length=1.0, height=0.6, tilt=35.0, snow=0.1)
    >>> [obstacle.name for obstacle in table.obstacles]
    ['module-2', 'post-1', 'post-2']
    """
    check_positive(module_length=module_length, snow=snow, post_size=post_size)
    if modules < 1:
        raise InputError(f"modules: {modules} is not allowed; give 1 or more")
    for name, size in (("gap", gap), ("lip", lip)):
        if size:
            check_resolved(name, size, dx)
    scene = single_panel(
        height=height, length=module_length, tilt=tilt, snow=snow, width=width,
        friction=friction, ground_tilt=ground_tilt, dx=dx,
    )  # fmt: skip
    edge = panel_edge(scene.to_data())
    slope = Slope((edge.x, edge.z), tilt, width)
    starts = [number * (module_length + gap) for number in range(modules)]
    for number, start in enumerate(starts[1:], 2):
        end = start + module_length
        scene.append("obstacles", _board(f"module-{number}", slope, start, end, friction, dx))
    if lip and modules > 1 and gap < lip:
        raise InputError(f"lip: {lip:g} m does not fit into the gap of {gap:g} m")
    lips = [slope.layer(start - lip, start, -lip, lip) for start in starts] if lip else []
    for number, rail in enumerate(lips, 1):
        scene.append("obstacles", separate_part(f"lip-{number}", rail))
    if modules > 1:
        snow_end = starts[-1] + module_length
        scene.append("bodies", snow_layer(slope, module_length, snow_end, snow, lips[1:]))
    _add_posts(scene, slope, starts[-1] + module_length, posts, post_size, ground_tilt, dx)
    return scene


def _board(
    name: str, slope: Slope, start: float, end: float, friction: float, dx: float
) -> Obstacle:
    board = slope.board(start, end, BOARD_CELLS * dx)
    return Obstacle(name=name, shape=board, condition="separate", friction=friction)


def snow_layer(
    slope: Slope, start: float, end: float, thickness: float, rails: Sequence[Shape] = ()
) -> Body:
    """Return snow over a whole slope, except at rails, laid in every event."""
    across = None if slope.width is None else SNOW_OF_PANEL * slope.width
    lying = slope.narrowed(across).layer(start, end, 0.0, thickness)
    return Body(shape=Shape.difference(lying, *rails) if rails else lying, event=0)


def separate_part(name: str, shape: Shape) -> Obstacle:
    """Return an obstacle from which snow may separate, such as a post, a rail or a wall."""
    return Obstacle(name=name, shape=shape, condition="separate", friction=0.3)


def _add_posts(
    scene: Scene,
    slope: Slope,
    length: float,
    posts: Sequence[float],
    size: float,
    ground_tilt: float,
    dx: float,
) -> None:
    if posts:
        check_resolved("post_size", size, dx)
    fall = math.tan(math.radians(ground_tilt))
    steep = math.tan(math.radians(slope.tilt))
    below = BOARD_CELLS * dx * math.hypot(1.0, steep) + 0.5 * size * steep
    # In 3D one post on either side, a third of the width from the middle.
    sides = (0.0,) if slope.width is None else (-slope.width / 3.0, slope.width / 3.0)
    for number, part in enumerate(posts, 1):
        if not 0.0 <= part <= 1.0:
            raise InputError(f"posts: {part:g} is outside the allowed range (0 <= value <= 1)")
        x, z = slope.point(part * length)
        x_span = (x - 0.5 * size, x + 0.5 * size)
        z_span = (-x_span[1] * fall, z - below)
        if z_span[0] >= z_span[1]:
            raise InputError(f"posts: the table is too low for a post at {part:g} of its length")
        for side, y in enumerate(sides, 1):
            y_span = (y - 0.5 * size, y + 0.5 * size)
            post = upright_box(x_span, z_span, 2 if slope.width is None else 3, y_span)
            name = f"post-{number}" if slope.width is None else f"post-{number}-{side}"
            scene.append("obstacles", separate_part(name, post))
