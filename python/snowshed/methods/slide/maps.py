"""Maps of a snow slide: what its solver tells at the nodes of the terrain."""

from __future__ import annotations

import json
from dataclasses import dataclass

import numpy as np

import snowshed._core as _core
from snowshed.base.arrays import Floats
from snowshed.io.raster.raster import Raster


@dataclass(frozen=True)
class SlideMaps:
    """Maps of a slide at the nodes of its grid, the southernmost row first.

    Attributes
    ----------
    terrain
        Elevations, m.
    peak_thickness, thickness
        Of the snow, normal to the ground, m: the largest over time, and now.
    peak_speed, speed
        m/s.
    west, south
        Map coordinates of the south-west node, m.
    cell
        Distance of the nodes, m.
    density
        Of the snow, kg/m3.
    """

    terrain: Floats
    peak_thickness: Floats
    thickness: Floats
    peak_speed: Floats
    speed: Floats
    west: float
    south: float
    cell: float
    density: float

    @property
    def peak_pressure(self) -> Floats:
        """Largest pressure over time, density times the square of the speed, kPa."""
        pressure: Floats = 1e-3 * self.density * self.peak_speed**2
        return pressure

    def raster(self, values: Floats, crs: str = "") -> Raster:
        """Return one of the maps with its place, and its coordinate system in words."""
        return Raster(values, self.west, self.south, self.cell, crs=crs)


def slide_maps(simulation: _core.Simulation) -> SlideMaps:
    """Return the maps of a slide as they are now.

    Raises
    ------
    InputError
        If the scene's method is another.
    """
    density = json.loads(simulation.scene)["numerics"]["density"]
    found = simulation.slide_maps()
    # The mean speed of the default mode fades beyond the snow (kernels/mean_speed.hpp). In the maps
    # that people read, no place that snow never reached has a speed or a pressure.
    found["peak_speed"] = np.where(found["peak_thickness"] > 0.0, found["peak_speed"], 0.0)
    return SlideMaps(**found, density=density)
