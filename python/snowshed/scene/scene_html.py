"""A scene as HTML for notebooks: a drawing in the plane y = 0 above its text."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from html import escape
from typing import Any

from snowshed.scene.panel_edge import ground_tilt, panel_edge

Point = tuple[float, float]
WIDTH, MAX_HEIGHT = 480, 320  # pixels
MARGIN = 0.15  # of the drawn width, on each side
PANEL, SNOW, SOLID, GROUND = "#3b4a5a", "#9cc4e4", "#8a8f98", "#6b5b4b"


def scene_html(data: Mapping[str, Any], text: str) -> str:
    """Return a drawing of a complete scene's data, and the scene as text.

    Panel, slab, ground, and obstacles that are boxes or spheres are drawn; the number of other
    solids is given below.

    Examples
    --------
    >>> from snowshed.scene.scene import Scene
    >>> scene = Scene.preset("lab-50")
    >>> scene_html(scene.resolve().data, repr(scene))[:4]
    '<div'
    """
    return f"<div>{_drawing(data)}<pre>{escape(text)}</pre></div>"


def _drawing(data: Mapping[str, Any]) -> str:
    solids = list(_solids(data))
    if not solids:
        return ""
    corners = [point for _, points in solids for point in points]
    tilt = math.tan(math.radians(ground_tilt(data)))
    highest = max(z for _, z in corners)
    left, right = _widened((x for x, _ in corners), highest)
    bottom = min(min(z for _, z in corners), -tilt * right) - 0.02 * (right - left)
    top = highest + 0.05 * (right - left)
    scale = min(WIDTH / (right - left), MAX_HEIGHT / (top - bottom))
    ground = ((left, -tilt * left), (right, -tilt * right), (right, bottom), (left, bottom))
    shapes = "".join(
        f'<polygon fill="{colour}" points="'
        + " ".join(f"{scale * (x - left):.1f},{scale * (top - z):.1f}" for x, z in points)
        + '"/>'
        for colour, points in [(GROUND, ground), *solids]
    )
    size = f'width="{scale * (right - left):.0f}" height="{scale * (top - bottom):.0f}"'
    others = len(data.get("obstacles") or ()) - sum(colour == SOLID for colour, _ in solids)
    note = f"<p>{others} obstacles of other shapes are not drawn.</p>" if others else ""
    return f'<svg xmlns="http://www.w3.org/2000/svg" {size}>{shapes}</svg>{note}'


def _solids(data: Mapping[str, Any]) -> Iterator[tuple[str, list[Point]]]:
    """Yield the colour and the corners (x, z), m, of the solids that can be drawn."""
    for obstacle in data.get("obstacles") or ():
        shape = obstacle["shape"]
        if shape["type"] == "box":
            yield SOLID, _box(shape["center"], shape["size"])
        elif shape["type"] == "sphere":
            yield SOLID, _circle(shape["center"], shape["radius"])
    if not data.get("panel"):
        return
    panel, edge = data["panel"], panel_edge(data)
    slab = data.get("slab") or {}
    layers = sum(layer["thickness"] for layer in slab.get("layers") or ())
    thickness = slab.get("thickness") or layers
    if thickness:
        part = (slab.get("length") or panel["length"]) / panel["length"]
        (x, z), (u, w) = edge.center, (edge.x - edge.center[0], edge.z - edge.center[1])
        ends = ((x - part * u, z - part * w), (x + part * u, z + part * w))
        yield SNOW, _plate(ends, edge.normal, thickness)
    depth = max(panel.get("thickness") or 0.0, 0.015 * panel["length"])
    yield PANEL, _plate((edge.upper, (edge.x, edge.z)), edge.normal, -depth)


def _plate(ends: tuple[Point, Point], normal: Point, thickness: float) -> list[Point]:
    (x0, z0), (x1, z1) = ends
    dx, dz = thickness * normal[0], thickness * normal[1]
    return [(x0, z0), (x1, z1), (x1 + dx, z1 + dz), (x0 + dx, z0 + dz)]


def _box(center: list[float], size: list[float]) -> list[Point]:
    x, z, dx, dz = center[0], center[-1], 0.5 * size[0], 0.5 * size[-1]
    return [(x - dx, z - dz), (x + dx, z - dz), (x + dx, z + dz), (x - dx, z + dz)]


def _circle(center: list[float], radius: float) -> list[Point]:
    angles = [math.radians(angle) for angle in range(0, 360, 15)]
    return [
        (center[0] + radius * math.cos(angle), center[-1] + radius * math.sin(angle))
        for angle in angles
    ]


def _widened(values: Iterable[float], height: float) -> Point:
    """Return the horizontal limits of the drawing, with the ground onto which the snow falls."""
    numbers = list(values)
    low, high = min(numbers), max(numbers)
    extra = MARGIN * max(high - low, 0.1)
    return low - extra, high + extra + 0.5 * max(height, 0.0)
