"""The load of a slide on objects: masts, walls and buildings, as lines or polygons on the map.

The pressure on an object is c_d rho u^2 over its width and the depth of the flow. The user states
the drag coefficient c_d. Speed and depth are the largest over time at the nodes of the grid in and
around the object. They need not occur at the same time, so that the load is an upper bound.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.base.arrays import Booleans, Floats
from snowshed.base.extras import require
from snowshed.io.raster.areas import names_of, read_map_layer
from snowshed.methods.slide.frames import Frame

#: Objects receive the snow of nodes up to this distance from them, in cells.
REACH = 1.0
MAX_DRAG = 100.0


@dataclass(frozen=True)
class SlideObject:
    """An object on the terrain.

    Attributes
    ----------
    name
        Its name in tables.
    shape
        A line or polygon of shapely on the map, m.
    crs
        Coordinate system of its file; empty: that of the terrain is assumed.
    file
        Its file.
    """

    name: str
    shape: Any
    crs: str = ""
    file: str = ""

    @property
    def width(self) -> float:
        """The largest distance between two of its points, m: its widest front to the flow."""
        shapely: Any = require("shapely", "terrain", "loads on objects")
        corners = shapely.get_coordinates(self.shape.convex_hull)
        away = corners[:, None, :] - corners[None, :, :]
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
    """

    pressure: float
    depth: float
    force: float


class ObjectNodes:
    """The nodes of a grid that belong to an object.

    Parameters
    ----------
    target
        The object.
    east : (columns,)
        Map coordinates of the nodes along x, m.
    north : (rows,)
        The same along y.

    Raises
    ------
    InputError
        If no node is near the object.

    Examples
    --------
    >>> import shapely
    >>> wall = SlideObject("wall", shapely.box(4.0, 0.0, 5.0, 10.0))
    >>> axis, speed = np.arange(0.0, 11.0), np.full((11, 11), 10.0)
    >>> nodes = ObjectNodes(wall, axis, axis)
    >>> load = nodes.load(speed, 0.1 * speed, density=200.0, drag=2.0)
    >>> load.pressure, round(load.force)
    (40.0, 402)
    """

    def __init__(self, target: SlideObject, east: Floats, north: Floats) -> None:
        shapely: Any = require("shapely", "terrain", "loads on objects")
        reach = REACH * float(east[1] - east[0])
        points = shapely.points(*np.meshgrid(east, north))
        self.target = target
        self.near: Booleans = np.asarray(shapely.distance(target.shape, points) <= reach)
        if not self.near.any():
            raise InputError(f"{target.name}: lies outside the terrain")

    def load(self, speed: Floats, depth: Floats, density: float, drag: float) -> ObjectLoad:
        """Return the load of flow with these maps of speed (m/s) and depth (m)."""
        deepest = float(depth[self.near].max())
        fastest = float(speed[self.near].max()) if deepest > 0.0 else 0.0
        pressure = 1e-3 * drag * density * fastest**2
        return ObjectLoad(pressure, deepest, pressure * deepest * self.target.width)

    def duration(self, frames: Sequence[Frame]) -> float:
        """Return the time from the first to the last map of the flow with snow at the object, s."""
        rows, columns = (slice(0, size) for size in self.near.shape)
        times = [frame.time for frame in frames if frame.window(rows, columns)[self.near].any()]
        return times[-1] - times[0] if times else 0.0


def read_objects(file: Path, layer: Optional[str] = None) -> list[SlideObject]:
    """Return the objects of a file of lines or polygons: GeoPackage, shapefile or GeoJSON.

    Their names are those of the field "name", or "object 1", and so on. Each part of a feature is
    an object.

    Raises
    ------
    InputError
        If the file is damaged, holds neither lines nor polygons, or is not in metres.
    OSError
        If it cannot be read.
    """
    shapely: Any = require("shapely", "terrain", "loads on objects")
    features = read_map_layer(file, layer, lines=True)
    parts, owners = shapely.get_parts(features.shapes, return_index=True)
    names = names_of(features, "object")
    counts = np.bincount(owners, minlength=len(names))
    ranks = np.arange(len(owners)) - np.searchsorted(owners, owners) + 1
    objects = [
        SlideObject(
            names[owner] if counts[owner] == 1 else f"{names[owner]}, part {rank}",
            part,
            features.crs,
            str(file),
        )
        for part, owner, rank in zip(parts, owners.tolist(), ranks.tolist())
        if not part.is_empty
    ]
    if not objects:
        raise InputError(f"{file}: holds no line or polygon")
    return objects


def check_drag(drag: float) -> None:
    """Raise InputError unless a drag coefficient is allowed."""
    if not 0.0 < drag <= MAX_DRAG:
        raise InputError(f"drag coefficient: {drag:g}; allowed: above 0, at most {MAX_DRAG:g}")
