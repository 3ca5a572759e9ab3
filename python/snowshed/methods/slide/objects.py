"""The load of a slide on objects: masts, walls and buildings, given as polygons on the map.

The pressure on an object is c_d rho u^2 over its width and the depth of the flow, with a drag
coefficient that the user states. Speed and depth are the largest over time at the nodes of the grid
in and around the object. They need not occur at the same time, so that the load is an upper bound.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Optional

import numpy as np

from snowshed._core import InputError
from snowshed.base.arrays import Floats
from snowshed.methods.slide.frames import Frame

#: Objects receive the snow of nodes up to this distance from them, in cells.
REACH = 1.0


@dataclass(frozen=True)
class SlideObject:
    """An object on the terrain.

    Attributes
    ----------
    name
        Its name in tables.
    corners : (n, 2)
        The polygon on the map, m.
    drag
        Drag coefficient c_d.
    """

    name: str
    corners: Floats
    drag: float = 1.0

    def __post_init__(self) -> None:
        if not 0.0 < self.drag <= 100.0:
            raise InputError(f"drag coefficient: {self.drag:g}; allowed: above 0, at most 100")

    @property
    def width(self) -> float:
        """The largest distance between two corners, m: the widest front to the flow."""
        away = self.corners[:, None, :] - self.corners[None, :, :]
        return float(np.linalg.norm(away, axis=-1).max())


@dataclass(frozen=True)
class ObjectLoad:
    """The largest load of a slide on an object.

    Attributes
    ----------
    pressure
        c_d rho u^2, kPa.
    depth
        Depth of the flow, m, normal to the ground.
    force
        Pressure times width and depth, kN.
    duration
        Time between the first and the last picture of the film with snow at the object, s; None
        without a film.
    """

    pressure: float
    depth: float
    force: float
    duration: Optional[float] = None


def object_load(
    target: SlideObject,
    east: Floats,
    north: Floats,
    peak_speed: Floats,
    peak_depth: Floats,
    density: float,
    frames: Sequence[Frame] = (),
) -> ObjectLoad:
    """Return the largest load of a slide on an object.

    Parameters
    ----------
    target
        The object.
    east : (columns,)
        Map coordinates of the nodes along x, m.
    north : (rows,)
        The same along y.
    peak_speed, peak_depth : (rows, columns)
        Largest speed (m/s) and thickness (m) over time at the nodes.
    density
        Density of the snow, kg/m3.
    frames
        Maps of the thickness over time, for the duration.

    Raises
    ------
    InputError
        If no node of the grid is near the object.

    Examples
    --------
    >>> wall = SlideObject("wall", np.array([[4.0, 0.0], [4.0, 10.0], [5.0, 10.0], [5.0, 0.0]]), 2.0)
    >>> axis, still = np.arange(0.0, 11.0), np.full((11, 11), 10.0)
    >>> load = object_load(wall, axis, axis, still, 0.1 * still, 200.0)
    >>> load.pressure, round(load.force), round(wall.width, 2)
    (40.0, 402, 10.05)
    """
    cell = float(east[1] - east[0])
    near = _near(target.corners, east, north, REACH * cell)
    if not near.any():
        raise InputError(f"{target.name}: lies outside the terrain")
    speed, depth = float(peak_speed[near].max()), float(peak_depth[near].max())
    pressure = 1e-3 * target.drag * density * speed**2 if depth > 0.0 else 0.0
    duration: Optional[float] = None
    if frames:
        rows, columns = near.shape
        hit = [
            frame.time
            for frame in frames
            if (frame.window(slice(0, rows), slice(0, columns))[near] > 0.0).any()
        ]
        duration = hit[-1] - hit[0] if hit else 0.0
    return ObjectLoad(pressure, depth, pressure * depth * target.width, duration)


def _near(corners: Floats, east: Floats, north: Floats, reach: float) -> np.ndarray:
    """Return the nodes (rows, columns) in a polygon, or up to a distance from its outline."""
    x, y = np.meshgrid(east, north)
    inside = np.zeros(x.shape, dtype=bool)
    nearest = np.full(x.shape, np.inf)
    for (x0, y0), (x1, y1) in zip(corners, np.roll(corners, -1, axis=0)):
        length = (x1 - x0) ** 2 + (y1 - y0) ** 2
        along = np.clip(((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / max(length, 1e-12), 0, 1)
        nearest = np.minimum(nearest, np.hypot(x - x0 - along * (x1 - x0), y - y0 - along * (y1 - y0)))
        if y0 != y1:
            crosses = ((y0 > y) != (y1 > y)) & (x < x0 + (y - y0) / (y1 - y0) * (x1 - x0))
            inside ^= crosses
    return inside | (nearest <= reach)
