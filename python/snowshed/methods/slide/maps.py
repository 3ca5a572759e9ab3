"""Maps of a snow slide at the nodes of the terrain: in memory, in rasters, and in few bytes."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.arrays import Floats
from snowshed.base.core_simulation import AnySimulation, core_of
from snowshed.base.damage import DAMAGED
from snowshed.base.extras import require
from snowshed.base.missing_result import MissingResultError
from snowshed.io.array_archive import open_archive
from snowshed.io.raster.raster import Raster, read_raster

if TYPE_CHECKING:
    import xarray

#: Files of the maps in a results folder, with names that AvaFrame's tools know.
RASTERS: Mapping[str, str] = {
    "peak_thickness": "peaks/pft.asc",
    "peak_speed": "peaks/pfv.asc",
    "peak_pressure": "peaks/ppr.asc",
    "thickness": "flow/FT.asc",
    "speed": "flow/FV.asc",
}
MEANINGS = {
    "peak_thickness": ("m", "Largest thickness of the snow, normal to the ground"),
    "peak_speed": ("m/s", "Largest speed of the snow"),
    "peak_pressure": ("kPa", "Largest pressure, density times the square of the speed"),
    "thickness": ("m", "Thickness of the snow, normal to the ground"),
    "speed": ("m/s", "Speed of the snow"),
}
Singles = NDArray[np.float32]
PEAKS_FILE = "peaks.npz"  # in the results folder of a compact run


@dataclass(frozen=True)
class SlideMaps:
    """Maps of a slide at the nodes of its grid, the southernmost row first.

    Attributes
    ----------
    terrain
        Elevations, m.
    peak_thickness, thickness
        Thickness of the snow normal to the ground, m: the largest over time, and the present one.
    peak_speed, speed
        Speed, m/s: the largest over time, and the present one.
    west, south
        Map coordinates of the south-west node, m.
    cell
        Distance of the nodes, m.
    density
        Density of the snow, kg/m3.
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
        """Return a map with its position and its coordinate system."""
        return Raster(values, self.west, self.south, self.cell, crs=crs)


def slide_maps(simulation: AnySimulation) -> SlideMaps:
    """Return the present maps of a slide.

    Parameters
    ----------
    simulation
        A `snowshed.Simulation`.

    Raises
    ------
    InputError
        If the scene's method is another.
    """
    maps = core_of(simulation).slide_maps()
    # The mean speed of the default mode fades beyond the snow (kernels/mean_speed.hpp). In the maps
    # that people read, speed and pressure are zero where snow never came.
    maps["peak_speed"] = np.where(maps["peak_thickness"] > 0.0, maps["peak_speed"], 0.0)
    return SlideMaps(**maps)


def read_maps(folder: Path) -> xarray.Dataset:
    """Read the maps of a finished slide.

    Parameters
    ----------
    folder
        Its results folder.

    Returns
    -------
    xarray.Dataset
        ``peak_thickness``, ``peak_speed``, ``peak_pressure``, ``thickness`` and ``speed`` with
        dimensions y and x: map coordinates of the nodes, m. The attribute ``crs`` is the coordinate
        system, if it is known.

    Raises
    ------
    MissingResultError
        If the maps are missing.
    InputError
        If they are damaged, or xarray (extra ``study``) is not installed.
    """
    rasters = {}
    for name, file in RASTERS.items():
        if not (folder / file).is_file():
            raise MissingResultError(
                f"{folder / file}: missing; a run that is not compact writes it"
            )
        rasters[name] = read_raster(folder / file)
    dataset = _maps_dataset(rasters)
    for name in ("thickness", "speed"):
        dataset[name].attrs["long_name"] += ", at the end"
    return dataset


def present_maps(core: _core.Simulation, scene: Mapping[str, Any]) -> xarray.Dataset:
    """Return the maps of a slide up to now, as `read_maps` does."""
    maps, crs = slide_maps(core), str(scene["terrain"].get("crs", ""))
    return _maps_dataset({name: maps.raster(getattr(maps, name), crs) for name in RASTERS})


def _maps_dataset(rasters: Mapping[str, Raster]) -> xarray.Dataset:
    library = require("xarray", "study", "a Dataset of maps")
    first = rasters["peak_thickness"]
    rows, columns = first.heights.shape
    dataset: xarray.Dataset = library.Dataset(
        {name: (("y", "x"), raster.heights) for name, raster in rasters.items()},
        coords={
            "y": ("y", first.north + first.cell * np.arange(rows), {"units": "m"}),
            "x": ("x", first.east + first.cell * np.arange(columns), {"units": "m"}),
        },
        attrs={"crs": first.crs},
    )
    for name, (unit, meaning) in MEANINGS.items():
        dataset[name].attrs.update(units=unit, long_name=meaning)
    return dataset


@dataclass(frozen=True)
class PeakMaps:
    """The largest thickness, speed and pressure that a slide had at the nodes of its grid.

    Only the rectangle that holds all snow is kept.

    Attributes
    ----------
    thickness, speed, pressure : (rows, columns)
        Values in m, m/s and kPa, in single precision, the southernmost row first.
    first_row, first_column
        First row and column of the rectangle in the whole grid.
    shape
        Rows and columns of the whole grid.

    Examples
    --------
    >>> whole = np.zeros((4, 5)); whole[1, 2] = 0.5
    >>> maps = PeakMaps.cropped(whole, 2.0 * whole, 3.0 * whole)
    >>> PeakMaps.unpacked(maps.packed()).window("thickness", 0, 2).tolist()
    [[0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.5, 0.0, 0.0]]
    """

    thickness: Singles
    speed: Singles
    pressure: Singles
    first_row: int
    first_column: int
    shape: tuple[int, int]

    @classmethod
    def cropped(cls, thickness: Any, speed: Any, pressure: Any) -> PeakMaps:
        """Return the rectangle of whole maps (rows, columns) that holds all snow."""
        snow = (np.asarray(thickness) > 0.0) | (np.asarray(speed) > 0.0)
        rows, columns = (np.flatnonzero(snow.any(axis=axis)) for axis in (1, 0))
        if not rows.size:
            rows = columns = np.array([0])
        window = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
        cut = (
            np.asarray(values)[window].astype(np.float32) for values in (thickness, speed, pressure)
        )
        height, width = snow.shape
        h, v, p = cut
        return cls(h, v, p, int(rows[0]), int(columns[0]), (height, width))

    def window(self, name: str, begin: int, end: int) -> Singles:
        """Return rows `begin` to before `end` of a whole map, zero where there was no snow."""
        window: Singles = np.zeros((end - begin, self.shape[1]), dtype=np.float32)
        stored: Singles = getattr(self, name)
        rows, columns = stored.shape
        top, bottom = max(begin, self.first_row), min(end, self.first_row + rows)
        if top < bottom:
            across = slice(self.first_column, self.first_column + columns)
            cut = stored[top - self.first_row : bottom - self.first_row]
            window[top - begin : bottom - begin, across] = cut
        return window

    def packed(self) -> bytes:
        """Return the maps as a compressed NumPy archive, which `unpacked` reads."""
        stream = io.BytesIO()
        np.savez_compressed(
            stream,
            thickness=self.thickness,
            speed=self.speed,
            pressure=self.pressure,
            place=np.array([self.first_row, self.first_column, *self.shape]),
        )
        return stream.getvalue()

    @classmethod
    def unpacked(cls, data: bytes) -> PeakMaps:
        """Return the maps in bytes that `packed` returned.

        Raises
        ------
        InputError
            If the bytes are damaged, or of another origin.
        """
        try:
            with open_archive(data) as archive:
                row, column, rows, columns = archive["place"].tolist()
                h, v, p = (archive[name] for name in ("thickness", "speed", "pressure"))
                return cls(h, v, p, row, column, (rows, columns))
        except (OSError, *DAMAGED) as error:
            raise InputError(f"not maps that snowshed stored: {error}") from None
