"""Maps of a snow slide: what its solver tells at the nodes of the terrain."""

from __future__ import annotations

from dataclasses import dataclass

from snowshed.io.arrays import Floats
from snowshed.io.raster import Raster


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
