"""Structures in front of a panel or a roof, whose loads are of interest: roofs, walls and posts."""

from __future__ import annotations

import math

from snowshed.base.arguments import checked
from snowshed.base.notes import issue_note
from snowshed.methods.registry import resolution_of
from snowshed.scene.builders.panels import separate_part
from snowshed.scene.builders.slope import check_positive, check_resolved, upright_box
from snowshed.scene.panel_edge import ground_tilt, panel_edge
from snowshed.scene.scene import Scene


@checked
def lower_roof(
    scene: Scene, distance: float, width: float, height: float, thickness: float = 0.2
) -> Scene:
    """Return the scene with a level roof in front of its panel, named "lower roof".

    Parameters
    ----------
    scene
        A scene with a panel, which is changed.
    distance
        Horizontal distance from the panel's lower edge to the roof, m; negative: behind the edge.
    width
        Width of the roof in the slide direction, m.
    height
        Height of its upper face above the ground below the panel's edge, m.
    thickness
        Thickness, m.

    Raises
    ------
    InputError
        If a length is not positive, or the roof is thinner than two cells.

    Examples
    --------
    >>> from snowshed.scene import shed_roof
    >>> roof = shed_roof(eaves=3.0, length=4.0, tilt=40.0, snow=0.3, dx=0.05)
    >>> [obstacle.name for obstacle in lower_roof(roof, 0.2, 2.5, 1.5).obstacles]
    ['house', 'lower roof']
    """
    check_positive(width=width, height=height, thickness=thickness)
    return _add_box(scene, "lower roof", distance, width, (height - thickness, height))


@checked
def wall(scene: Scene, distance: float, height: float, thickness: float = 0.2) -> Scene:
    """Return the scene with a wall or a fence in front of its panel, named "wall".

    Parameters
    ----------
    scene
        A scene with a panel, which is changed.
    distance
        Horizontal distance from the panel's lower edge to the wall, m; negative: behind the edge.
    height
        Height above the ground at the wall, m.
    thickness
        Thickness, m.

    Raises
    ------
    InputError
        If a length is not positive, or the wall is thinner than two cells.

    Examples
    --------
    >>> from snowshed.scene import single_panel
    >>> panel = single_panel(height=1.5, length=3.0, tilt=50.0, snow=0.2, dx=0.05)
    >>> wall(panel, distance=2.0, height=1.2).obstacles[-1].name
    'wall'
    """
    check_positive(height=height, thickness=thickness)
    return _add_box(scene, "wall", distance, thickness, (-thickness, height), on_ground=True)


@checked
def post(scene: Scene, distance: float, height: float, size: float = 0.2) -> Scene:
    """Return the scene with a square post in front of the middle of its panel, named "post".

    In 2D a post is a wall: its load per metre is then that of a wall. Give the panel a width for
    the load on a single post.

    Parameters
    ----------
    scene
        A scene with a panel, which is changed.
    distance
        Horizontal distance from the panel's lower edge to the post, m; negative: behind the edge.
    height
        Height above the ground at the post, m.
    size
        Edge of its section, m.

    Raises
    ------
    InputError
        If a length is not positive, or the post is thinner than two cells.

    Examples
    --------
    >>> from snowshed.scene import single_panel
    >>> panel = single_panel(height=1, length=1, tilt=50, snow=0.1, width=1, dx=0.05)
    >>> post(panel, distance=0.5, height=1.0).obstacles[-1].name
    'post'
    """
    check_positive(height=height, size=size)
    return _add_box(scene, "post", distance, size, (-size, height), on_ground=True, across=size)


def _add_box(
    scene: Scene,
    name: str,
    distance: float,
    width: float,
    heights: tuple[float, float],
    *,
    on_ground: bool = False,
    across: float = math.inf,
) -> Scene:
    """Add a box between two heights: above the ground at the edge, or at the box."""
    data = scene.resolve().data
    if distance + width <= 0:
        issue_note(f"distance: {distance:g} m is behind the edge, where the {name} meets no snow")
    check_resolved(name, min(width, heights[1] - heights[0]), resolution_of(data))
    x = panel_edge(data).x + distance + 0.5 * width
    at = x if on_ground else panel_edge(data).x
    ground = -at * math.tan(math.radians(ground_tilt(data)))
    low, high = (ground + height for height in heights)
    half = 0.5 * min(across, 2.0 * float(data["panel"].get("width") or 1.0))
    shape = upright_box(
        (x - 0.5 * width, x + 0.5 * width), (low, high), data["dimension"], (-half, half)
    )
    return scene.append("obstacles", separate_part(name, shape))
