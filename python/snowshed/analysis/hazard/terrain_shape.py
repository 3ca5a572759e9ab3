"""Slope, aspect, plan curvature and ruggedness of terrain, cell by cell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from snowshed.base.arrays import Floats, Integers
from snowshed.io.raster.raster import Raster


@dataclass(frozen=True)
class TerrainShape:
    """The shape of the ground at each cell; NaN where a neighbouring cell has no elevation.

    The outermost cells have no neighbours beyond the border, and are NaN, too.

    Attributes
    ----------
    east, north : (rows, columns)
        Rise of the ground per metre to the east and to the north.
    plan_curvature
        Curvature across the direction of the slope, 1/m: positive on ridges, negative in gullies.
    """

    east: Floats
    north: Floats
    plan_curvature: Floats

    def at(self, cells: tuple[Integers, Integers]) -> TerrainShape:
        """Return the shape at some cells, given by their rows and columns."""
        return TerrainShape(self.east[cells], self.north[cells], self.plan_curvature[cells])

    @property
    def slope(self) -> Floats:
        """Slope, degrees from the horizontal."""
        degrees: Floats = np.degrees(np.arctan(np.hypot(self.east, self.north)))
        return degrees

    @property
    def surface(self) -> Floats:
        """Area along the ground per area on the map."""
        ratio: Floats = np.sqrt(1.0 + self.east**2 + self.north**2)
        return ratio

    def ruggedness(self, window: int) -> Floats:
        """Return how much the directions of the ground differ around each cell, 0 to 1.

        It is the vector ruggedness measure of Sappington et al. (2007), doi:10.2193/2005-723:
        one minus the length of the mean unit normal of the ground. A plane has 0, at any slope.

        Parameters
        ----------
        window
            Odd number of cells along the sides of the square around a cell. Cells in it that have
            no normal are left out.
        """
        length = self.surface
        valid = np.isfinite(length)
        total = np.zeros(length.shape)
        for component in (-self.east / length, -self.north / length, 1.0 / length):
            total += _mean_around(component, window) ** 2
        count = _mean_around(np.where(valid, 1.0, np.nan), window)
        mean = np.divide(np.sqrt(total), count, out=np.ones(length.shape), where=valid)
        rugged: Floats = np.where(valid, np.clip(1.0 - mean, 0.0, 1.0), np.nan)
        return rugged

    def aspect(self, window: int) -> Floats:
        """Return the direction that the ground faces, degrees clockwise from north, 0 to 360.

        Parameters
        ----------
        window
            Odd number of cells along the sides of the square over which unit vectors of the
            direction are averaged. Cells in it that have no slope are left out.
        """
        steepness = np.hypot(self.east, self.north)
        x, y = (
            _mean_around(np.divide(-rise, steepness, out=0.0 * rise, where=steepness > 0.0), window)
            for rise in (self.east, self.north)
        )
        degrees: Floats = np.degrees(np.arctan2(x, y)) % 360.0
        degrees[np.isnan(steepness)] = np.nan
        return degrees


def _mean_around(values: Floats, window: int) -> Floats:
    """Return the mean over squares of `window` cells; cells that are NaN or outside count as 0."""
    from scipy import ndimage

    mean: Floats = ndimage.uniform_filter(np.nan_to_num(values), window, mode="constant")
    return mean


def terrain_shape(ground: Raster) -> TerrainShape:
    """Return the shape of terrain, from central differences between neighbouring cells.

    The plan curvature is that of Zevenbergen and Thorne (1987), doi:10.1002/esp.3290120107, with
    the sign of GIS programs. They print it per 100 m.

    Examples
    --------
    >>> x, y = np.meshgrid(np.arange(-2.0, 3.0), np.arange(-2.0, 3.0))
    >>> ridge = terrain_shape(Raster(-0.5 * y - 0.05 * x**2, 0.0, 0.0, 1.0))
    >>> round(float(ridge.slope[2, 2]), 2), round(float(ridge.plan_curvature[2, 2]), 6)
    (26.57, 0.1)
    """
    east, north, curvature = (np.full(ground.heights.shape, np.nan) for _ in range(3))
    if min(ground.heights.shape) < 3:
        return TerrainShape(east, north, curvature)
    z, d = ground.heights, ground.cell
    middle, west, right = z[1:-1, 1:-1], z[1:-1, :-2], z[1:-1, 2:]
    below, above = z[:-2, 1:-1], z[2:, 1:-1]
    p, q = (right - west) / (2.0 * d), (above - below) / (2.0 * d)
    pp = (right - 2.0 * middle + west) / d**2
    qq = (above - 2.0 * middle + below) / d**2
    pq = ((z[2:, 2:] + z[:-2, :-2]) - (z[2:, :-2] + z[:-2, 2:])) / (4.0 * d**2)
    steepness = p**2 + q**2
    bend = 2.0 * pq * p * q - (pp * q**2 + qq * p**2)
    inner = np.divide(bend, steepness, out=0.0 * bend, where=steepness > 0.0)
    for target, values in ((east, p), (north, q), (curvature, inner)):
        target[1:-1, 1:-1] = np.where(np.isfinite(bend), values, np.nan)
    return TerrainShape(east, north, curvature)
