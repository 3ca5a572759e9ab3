"""Terrain heights from a raster: ESRI ASCII grids, and GeoTIFF with the extra snowshed[terrain]."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Optional

import numpy as np

from snowshed._core import InputError, read_ascii_grid
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats
from snowshed.base.field_type import shown
from snowshed.base.notes import InputNote, issue_note
from snowshed.base.paths import PathLike
from snowshed.io.atomic import replacing
from snowshed.io.coordinates.systems import read_prj
from snowshed.io.input_file import first_bytes
from snowshed.io.raster.geotiff import read_geotiff
from snowshed.io.raster.sidecars import refuse_other_facts
from snowshed.io.raster.vertical_units import split_vertical

GEOTIFF = (".tif", ".tiff")
TIFF_MARKS = (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")


@checked
@dataclass(frozen=True)
class Raster:
    """Heights on a regular grid of a projected map.

    Attributes
    ----------
    heights : (rows, columns)
        Elevations, m, the southernmost row first; NaN for missing values.
    east, north
        Map coordinates of the centre of the cell [0, 0], m.
    cell
        Size of a cell, m.
    name
        Name for messages.
    crs
        Coordinate system of the map as text, such as "EPSG:31287"; empty if unknown.
    plain
        Whether the file `name` is an ESRI ASCII grid that holds exactly these heights.
    numbers
        Type of the numbers in the file, such as "int16"; empty for text.
    """

    heights: Floats
    east: float
    north: float
    cell: float
    name: str = "raster"
    crs: str = ""
    plain: bool = False
    numbers: str = ""

    def __post_init__(self) -> None:
        """Refuse heights that are no numbers in rows and columns; masked ones become NaN."""
        heights: Any = self.heights
        if (
            not isinstance(heights, np.ndarray)
            or heights.ndim != 2
            or heights.dtype.kind not in "iuf"
        ):
            raise InputError(
                f"{self.name}: heights: {shown(heights)}; needed: an array of numbers with rows "
                "and columns"
            )
        if isinstance(heights, np.ma.MaskedArray):
            masked: Any = heights.astype(np.float64)
            object.__setattr__(self, "heights", masked.filled(np.nan))

    def height_at(self, east: Floats, north: Floats) -> Floats:
        """Return heights at map coordinates, m, interpolated between cell centres (bilinear).

        Raises
        ------
        InputError
            If a point lies outside the raster, or where the raster has no height.

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
        heights: Floats = (1 - b) * ((1 - a) * z[j, i] + a * z[j, right]) + b * (
            (1 - a) * z[up, i] + a * z[up, right]
        )
        if np.isnan(heights).any():
            first = np.flatnonzero(np.isnan(heights))[0]
            raise InputError(
                f"{self.name}: no height at {east.flat[first]:.10g} east, "
                f"{north.flat[first]:.10g} north"
            )
        return heights


@checked
def read_raster(path: PathLike, band: Optional[int] = None) -> Raster:
    """Read heights in metres.

    Scale, offset, unit and missing values of the file are applied; a note reports changes.

    Parameters
    ----------
    path
        An ESRI ASCII grid (any name, its coordinate system in a .prj beside it) or a GeoTIFF,
        recognised by content, on a projected map.
    band
        Band of a GeoTIFF, from 1; needed if there are several.

    Raises
    ------
    InputError
        If the file is not such a raster; the message names the position. If the library for
        GeoTIFF is missing, it names the package to install.
    OSError
        If the file cannot be read.
    """
    path = Path(path)
    if path.suffix.lower() in GEOTIFF or first_bytes(path, 4) in TIFF_MARKS:
        raster = read_geotiff(path, band)
        place = (raster.east, raster.north, raster.cell)
        return Raster(raster.heights, *place, str(path), raster.system, numbers=raster.numbers)
    if band not in (None, 1):
        raise InputError(f"{path}: has no band {band}; an ESRI ASCII grid has one")
    return _read_ascii(path)


def _read_ascii(path: Path) -> Raster:
    heights, west, south, cell, missing, comma_count = read_ascii_grid(str(path))
    refuse_other_facts(path, heights)
    if missing:
        issue_note(
            f"{path.name}: {missing} values of -9999 are missing; the header declares none",
            InputNote,
        )
    if comma_count:
        issue_note(f"{path.name}: {comma_count} numbers have a decimal comma", InputNote)
    raster = Raster(heights, west, south, cell, str(path), read_prj(path), plain=True)
    system, metres_per_unit = split_vertical(raster.crs, str(path))
    if metres_per_unit in (None, 1.0):
        return replace(raster, crs=system)
    issue_note(
        f"{path.name}: its values were converted to metres; one unit is {metres_per_unit:.10g} m",
        InputNote,
    )
    return replace(raster, crs=system, heights=heights * metres_per_unit, plain=False)


def is_single(raster: Raster) -> bool:
    """Return whether single precision holds all heights of a raster.

    Examples
    --------
    >>> is_single(Raster(np.array([[0.5, 0.1]]), 0.0, 0.0, 1.0))
    False
    """
    elevations = raster.heights[~np.isnan(raster.heights)]
    return bool((elevations == elevations.astype(np.float32)).all())


def write_ascii_grid(path: PathLike, raster: Raster, *, exact: bool = False) -> None:
    """Write a raster as an ESRI ASCII grid, whole or not at all; NaN becomes -9999.

    Values have nine digits, enough to recover single precision; with `exact`, they have enough
    digits for double precision. Values in single precision need them, too, if the reader uses
    double precision.

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
    elevations = np.where(np.isnan(raster.heights), -9999.0, raster.heights)
    with replacing(path) as beside, beside.open("w", encoding="ascii") as file:
        file.write(header)
        number = "%.17g" if exact else "%.9g"
        empty = " ".join(["0"] * columns) + "\n"  # most rows of a map
        for row in elevations[::-1]:
            filled = row.any() or np.signbit(row).any()
            file.write(" ".join([number] * columns) % tuple(row) + "\n" if filled else empty)
