"""Slides on analytical ground, for the cases of the snow slide."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.io.raster.raster import Raster, write_ascii_grid
from snowshed.methods.slide.maps import SlideMaps, slide_maps
from snowshed.methods.slide.settings import SlideSettings
from snowshed.scene.components import Events
from snowshed.scene.scene import Scene
from snowshed.scene.terrain_components import Area, Terrain
from snowshed.snow.accuracy.measurements import CaseSettings
from validation.framework.drive import TimedEventDriver

GRAVITY = 9.81  # m/s2

#: Height of the ground, m, at points of the map.
Height = Callable[[Floats, Floats], Floats]


@dataclass(frozen=True)
class Plane:
    """Plane that falls toward the east.

    Parameters
    ----------
    tilt
        Tilt, degrees.

    Examples
    --------
    >>> Plane(45.0).height(np.array(10.0), np.array(3.0)).round(6)
    np.float64(-10.0)
    """

    tilt: float

    def height(self, x: Floats, y: Floats) -> Floats:
        """Return the height of the ground, m; 0 at the origin."""
        return np.asarray(-math.tan(self.angle) * x + 0.0 * y)

    def coulomb(self, friction: float) -> float:
        """Return the acceleration of sliding snow down the slope, m/s2."""
        return GRAVITY * (math.sin(self.angle) - friction * math.cos(self.angle))

    @property
    def angle(self) -> float:
        """Tilt in radians."""
        return math.radians(self.tilt)

    def pressing_gravity(self, columns: str) -> float:
        """Return the gravity with which a layer's thickness drives snow down the fall line, m/s2.

        Columns across the flow are normal to the plane, vertical ones are longer.
        """
        cosine = math.cos(self.angle)
        return GRAVITY * (cosine if columns == "across_flow" else 1 / cosine)


@dataclass(frozen=True)
class Site:
    """Rectangle of ground, and the snow that is released on it.

    Parameters
    ----------
    height
        Height of the ground, m.
    west, south, east, north
        The rectangle on the map, m.
    release
        Areas of snow.
    """

    height: Height
    west: float
    south: float
    east: float
    north: float
    release: list[Area]


def rectangle(west: float, south: float, east: float, north: float, thickness: float) -> Area:
    """Return a rectangular area of snow; lengths in m."""
    corners = [(west, south), (east, south), (east, north), (west, north)]
    return Area(outline=corners, thickness=thickness)


def slide_drive(
    site: Site, settings: CaseSettings, case_settings: Collection[str] = (), **parts: object
) -> TimedEventDriver:
    """Return a slide before its first step.

    Parameters
    ----------
    site
        Ground and snow.
    settings
        Parameters of `SlideSettings`. By default there are no bonds, velocities do not mix,
        friction is Coulomb's, and the slide uses one thread.
    case_settings
        Names of settings that belong to the case, not to the method.
    parts
        Further fields of the terrain: inflows, resistance, dams.
    """
    bare = SlideSettings(
        bonds=False, mixing_rate=0.0, friction_law="coulomb", stop_ratio=0.0, threads=1
    )
    for name, value in settings.items():
        if name not in case_settings:
            setattr(bare, name, value)
    cell = float(settings["cell"])
    columns = round((site.east - site.west) / cell) + 1
    rows = round((site.north - site.south) / cell) + 1
    x, y = np.meshgrid(site.west + cell * np.arange(columns), site.south + cell * np.arange(rows))
    with TemporaryDirectory() as folder:
        file = Path(folder) / "terrain.asc"
        write_ascii_grid(file, Raster(site.height(x, y), site.west, site.south, cell))
        terrain = Terrain(file=file, release=site.release, max_slope=90.0)
        for name, part in parts.items():
            setattr(terrain, name, part)
        scene = Scene(
            method="slide",
            dimension=3,
            # Some grounds of the cases have cliffs.
            terrain=terrain,
            numerics=bare,
            events=Events(max_time=400.0),
        )
        return TimedEventDriver(scene)


def maps_of(drive: TimedEventDriver) -> SlideMaps:
    """Return a slide's present maps; the speed is the solver's, which extends beyond the snow."""
    speed = drive.core.slide_maps()["peak_speed"]
    return replace(slide_maps(drive.core), peak_speed=speed)


def node_axes(maps: SlideMaps) -> tuple[Floats, Floats]:
    """Return the coordinates of the columns and rows of nodes, m."""
    rows, columns = maps.terrain.shape
    east, north = (maps.cell * np.arange(count, dtype=np.float64) for count in (columns, rows))
    return maps.west + east, maps.south + north


def strip_mean(maps: SlideMaps, values: Floats, half_width: float) -> tuple[Floats, Floats]:
    """Return x, and a map's mean values over the rows within half a width of y = 0."""
    x, y = node_axes(maps)
    near = np.abs(y) <= half_width + 1e-9
    return x, np.asarray(values[near].mean(axis=0))
