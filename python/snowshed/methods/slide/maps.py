"""Maps of a snow slide: what its solver tells at the nodes of the terrain."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from snowshed._core import InputError
from snowshed.base.arrays import Floats
from snowshed.base.core_simulation import AnySimulation, core_of
from snowshed.base.extras import require
from snowshed.io.raster.raster import Raster, read_raster

if TYPE_CHECKING:
    import xarray

#: Files of the maps in a results folder, which AvaFrame's tools know.
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
    "thickness": ("m", "Thickness of the snow at the end, normal to the ground"),
    "speed": ("m/s", "Speed of the snow at the end"),
}


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


def slide_maps(simulation: AnySimulation) -> SlideMaps:
    """Return the maps of a slide as they are now.

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
    # that people read, no place that snow never reached has a speed or a pressure.
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
        dimensions y and x: map coordinates, m, of the nodes. The attribute ``crs`` is the
        coordinate system, if it is known.

    Raises
    ------
    InputError
        If the maps are not there, or xarray (extra ``study``) is not installed.
    """
    library = require("xarray", "study", "a Dataset of maps")
    rasters = {}
    for name, file in RASTERS.items():
        if not (folder / file).is_file():
            raise InputError(f"{folder / file}: not there; a run that is not compact writes it")
        rasters[name] = read_raster(folder / file)
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
