"""Terrain heights from a raster: ESRI ASCII grids, and GeoTIFF with the extra snowshed[terrain]."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from snowshed._core import InputError, read_ascii_grid
from snowshed.io.arrays import Floats
from snowshed.io.atomic import replacing
from snowshed.io.coordinate_systems import read_prj
from snowshed.io.extras import require
from snowshed.io.gdal_fence import fenced_rasterio
from snowshed.io.paths import PathLike

GEOTIFF = (".tif", ".tiff")
LARGEST = 100_000_000  # cells of a raster that is read, 800 MB of heights


@dataclass(frozen=True)
class Raster:
    """Heights on a regular grid of a projected map.

    Attributes
    ----------
    heights : (rows, columns)
        m, the southernmost row first; NaN where there is none.
    east, north
        Map coordinates of the middle of the cell [0, 0], m.
    cell
        Size of a cell, m.
    name
        For messages.
    crs
        Coordinate system in words, such as "EPSG:31287"; empty where it is not known.
    """

    heights: Floats
    east: float
    north: float
    cell: float
    name: str = "raster"
    crs: str = ""

    def height_at(self, east: Floats, north: Floats) -> Floats:
        """Return heights at map coordinates, m, interpolated between cell middles (bilinear).

        Raises
        ------
        InputError
            If a place lies outside the raster, or where it holds no height.

        Examples
        --------
        >>> slope = Raster(np.array([[0.0, 1.0], [0.0, 1.0]]), 100.0, 200.0, 10.0)
        >>> slope.height_at(np.array([102.5]), np.array([203.0])).tolist()
        [0.25]
        """
        rows, columns = self.heights.shape
        u, v = (east - self.east) / self.cell, (north - self.north) / self.cell
        rounding = 1e-9
        outside = (u < -rounding) | (u > columns - 1 + rounding)
        outside |= (v < -rounding) | (v > rows - 1 + rounding)
        if outside.any():
            first = np.flatnonzero(outside)[0]
            raise InputError(
                f"{self.name}: {east.flat[first]:.10g} east, {north.flat[first]:.10g} north is "
                f"outside the raster ({self.east:.10g} to "
                f"{self.east + (columns - 1) * self.cell:.10g} east, {self.north:.10g} to "
                f"{self.north + (rows - 1) * self.cell:.10g} north, at the cells' middles)"
            )
        i = np.clip(np.floor(u).astype(int), 0, max(columns - 2, 0))
        j = np.clip(np.floor(v).astype(int), 0, max(rows - 2, 0))
        a, b = u - i, v - j
        z = self.heights
        right, up = np.minimum(i + 1, columns - 1), np.minimum(j + 1, rows - 1)
        found: Floats = (1 - b) * ((1 - a) * z[j, i] + a * z[j, right]) + b * (
            (1 - a) * z[up, i] + a * z[up, right]
        )
        if np.isnan(found).any():
            first = np.flatnonzero(np.isnan(found))[0]
            raise InputError(
                f"{self.name}: no height at {east.flat[first]:.10g} east, "
                f"{north.flat[first]:.10g} north"
            )
        return found


def read_raster(path: PathLike) -> Raster:
    """Read terrain heights.

    Parameters
    ----------
    path
        An ESRI ASCII grid (any name, its coordinate system in a .prj beside it), or a GeoTIFF
        (.tif, .tiff), in metres on a projected map.

    Raises
    ------
    InputError
        If the file is not such a raster, saying where; for a GeoTIFF without the library that
        reads it, what to install.
    OSError
        If the file cannot be read.
    """
    path = Path(path)
    return _read_geotiff(path) if path.suffix.lower() in GEOTIFF else _read_ascii(path)


def _read_ascii(path: Path) -> Raster:
    heights, west, south, cell = read_ascii_grid(str(path))
    return Raster(heights, west, south, cell, str(path), read_prj(path))


def is_single(raster: Raster) -> bool:
    """Return whether single precision holds all heights of a raster.

    Examples
    --------
    >>> is_single(Raster(np.array([[0.5, 0.1]]), 0.0, 0.0, 1.0))
    False
    """
    known = raster.heights[~np.isnan(raster.heights)]
    return bool((known == known.astype(np.float32)).all())


def write_ascii_grid(path: PathLike, raster: Raster, *, exact: bool = False) -> None:
    """Write a raster as an ESRI ASCII grid, whole or not at all; NaN becomes -9999.

    Values have nine digits, which keep single precision; with `exact` as many as double precision
    needs.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> flat = Raster(np.zeros((2, 3)), 100.0, 200.0, 5.0)
    >>> with TemporaryDirectory() as folder:
    ...     write_ascii_grid(Path(folder) / "flat.asc", flat)
    ...     read_raster(Path(folder) / "flat.asc").cell
    5.0
    """
    rows, columns = raster.heights.shape
    header = (
        f"ncols {columns}\nnrows {rows}\nxllcenter {raster.east:.15g}\n"
        f"yllcenter {raster.north:.15g}\ncellsize {raster.cell:.15g}\nnodata_value -9999\n"
    )
    known = np.where(np.isnan(raster.heights), -9999.0, raster.heights)
    single = not exact or is_single(raster)
    with replacing(path) as beside, beside.open("w", encoding="ascii") as file:
        file.write(header)
        np.savetxt(file, known[::-1], fmt="%.9g" if single else "%.17g")


def _check_band(source: Any, path: Path) -> None:
    """Refuse what would fill the memory, and what are no heights, before it is read."""
    if source.width * source.height > LARGEST:
        raise InputError(
            f"{path}: {source.width} columns and {source.height} rows; at most {LARGEST} cells "
            "are allowed; crop it first"
        )
    if np.dtype(source.dtypes[0]).kind not in "iuf":
        raise InputError(f"{path}: holds {source.dtypes[0]} values, which are no heights")


def _check_finite(heights: Floats, path: Path) -> None:
    if np.isinf(heights).any():
        row, column = np.argwhere(np.isinf(heights))[0]
        raise InputError(
            f"{path}: a height that is not finite, {column} cells from the west and {row} from "
            "the south"
        )


def _read_geotiff(path: Path) -> Raster:
    if not path.is_file():
        raise FileNotFoundError(2, "No such file or directory", str(path))
    rasterio: Any = require("rasterio", "terrain", "reading a GeoTIFF")
    try:
        with warnings.catch_warnings():
            # A raster without a place on the map is refused below.
            warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
            with fenced_rasterio(), rasterio.open(path, driver="GTiff") as source:
                _check_band(source, path)
                heights = source.read(1, masked=True).astype(np.float64).filled(np.nan)
                transform, crs = source.transform, source.crs
    except rasterio.errors.RasterioError as error:
        raise InputError(f"{path}: not a GeoTIFF: {error}") from None
    _check_finite(heights[::-1], path)
    if crs is not None and crs.is_geographic:
        raise InputError(f"{path}: its map is in degrees ({crs}); project it to metres first")
    if transform.b or transform.d or transform.a <= 0 or not math.isclose(
        transform.a, -transform.e, rel_tol=1e-6
    ):  # fmt: skip
        raise InputError(f"{path}: not on square cells with north up; resample it first")
    cell = float(transform.a)
    north = transform.f - (len(heights) - 0.5) * cell
    place = "" if crs is None else crs.to_string()
    return Raster(heights[::-1], transform.c + 0.5 * cell, north, cell, str(path), place)
