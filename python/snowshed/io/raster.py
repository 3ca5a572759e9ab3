"""Terrain heights from a raster: ESRI ASCII grids, and GeoTIFF with the extra snowshed[terrain]."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from snowshed._core import InputError
from snowshed.io.arrays import Floats
from snowshed.io.extras import require
from snowshed.io.paths import PathLike

GEOTIFF = (".tif", ".tiff")
CORNERS = ("xllcorner", "yllcorner", "xllcenter", "yllcenter")
HEADER = ("ncols", "nrows", *CORNERS, "cellsize", "nodata_value")
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
    """

    heights: Floats
    east: float
    north: float
    cell: float
    name: str = "raster"

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
        An ESRI ASCII grid (any name), or a GeoTIFF (.tif, .tiff), in metres on a projected map.

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
    try:
        lines = path.read_text(encoding="ascii").splitlines()
    except UnicodeDecodeError:
        raise InputError(f"{path}: not an ESRI ASCII grid: not plain text") from None
    header: dict[str, float] = {}
    for line in lines:
        words = line.split()
        if not words or words[0].lower() not in HEADER:
            break
        header[words[0].lower()] = _header_value(words, f"{path}, line {len(header) + 1}")
    _check_header(header, path)
    columns, rows = int(header["ncols"]), int(header["nrows"])
    values = [_heights(line, f"{path}, line {number}")
              for number, line in enumerate(lines[len(header):], len(header) + 1)]  # fmt: skip
    heights = np.concatenate(values) if values else np.zeros(0)
    if heights.size != rows * columns:
        raise InputError(
            f"{path}: {heights.size} heights; {columns} columns and {rows} rows need "
            f"{rows * columns}"
        )
    heights = heights.reshape(rows, columns)[::-1]
    _check_finite(heights, path)
    if "nodata_value" in header:
        heights = np.where(heights == header["nodata_value"], np.nan, heights)
    cell = header["cellsize"]
    east, north = (
        header[f"{axis}llcenter"] if f"{axis}llcenter" in header
        else header[f"{axis}llcorner"] + 0.5 * cell
        for axis in "xy"
    )  # fmt: skip
    return Raster(heights, east, north, cell, str(path))


def _header_value(words: list[str], where: str) -> float:
    try:
        (value,) = words[1:]
        return float(value)
    except ValueError:
        raise InputError(f"{where}: {' '.join(words)!r} is not a key and a number") from None


def _check_header(header: dict[str, float], path: Path) -> None:
    def need(*names: str) -> None:
        if not any(name in header for name in names):
            raise InputError(f"{path}: not an ESRI ASCII grid: no {' or '.join(names)} at its top")

    for names in (("ncols",), ("nrows",), ("xllcorner", "xllcenter"), ("yllcorner", "yllcenter"),
                  ("cellsize",)):  # fmt: skip
        need(*names)
    for name in ("ncols", "nrows"):
        if not header[name].is_integer() or header[name] < 2:
            raise InputError(f"{path}: {name} {header[name]:g}; give a whole number of 2 or more")
    if not (math.isfinite(header["cellsize"]) and header["cellsize"] > 0.0):
        raise InputError(f"{path}: cellsize {header['cellsize']:g}; give a length above 0 m")
    for name in CORNERS:
        if not math.isfinite(header.get(name, 0.0)):
            raise InputError(f"{path}: {name} {header[name]:g}; give a map coordinate, m")


def _heights(line: str, where: str) -> Floats:
    try:
        return np.array(line.split(), dtype=np.float64)
    except ValueError:
        raise InputError(f"{where}: not a row of heights") from None


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
            with rasterio.open(path, driver="GTiff") as source:
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
    return Raster(heights[::-1], transform.c + 0.5 * cell, north, cell, str(path))
