"""Maps of a snow slide at the nodes of the terrain: in memory, in rasters, and in few bytes."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

import numpy as np
from numpy.typing import NDArray

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.arrays import Floats
from snowshed.base.core_simulation import AnySimulation, core_of
from snowshed.base.damage import DAMAGED
from snowshed.base.missing_result import MissingResultError
from snowshed.io.array_archive import open_archive
from snowshed.io.raster.map_dataset import map_dataset
from snowshed.io.raster.output import ENDINGS, MapFormat, write_raster
from snowshed.io.raster.raster import Raster, read_raster

if TYPE_CHECKING:
    import xarray

#: Files of the maps in a results folder without their endings, with names that AvaFrame's tools
#: know.
RASTERS: Mapping[str, str] = {
    "peak_thickness": "peaks/pft",
    "peak_speed": "peaks/pfv",
    "peak_pressure": "peaks/ppr",
    "thickness": "flow/FT",
    "speed": "flow/FV",
}
#: The same for a slide whose ground adapts to the snow.
GROUND_RASTERS: Mapping[str, str] = {
    "ground_change": "ground/sfcChange",
    "changed_terrain": "ground/demAdapted",
}

MEANINGS = {
    "peak_thickness": ("m", "Largest thickness of the snow, normal to the ground"),
    "peak_speed": ("m/s", "Largest speed of the snow"),
    "peak_pressure": ("kPa", "Largest pressure, density times the square of the speed"),
    "thickness": ("m", "Thickness of the snow, normal to the ground"),
    "speed": ("m/s", "Speed of the snow"),
    "ground_change": ("m", "Vertical rise of the ground by the snow"),
    "changed_terrain": ("m", "Elevation of the ground with this rise"),
}
Singles = NDArray[np.float32]
Mask = NDArray[np.bool_]
PEAKS_FILE = "peaks.npz"  # in the results folder of a compact run


def rasters_of(*, changes_ground: bool) -> dict[str, str]:
    """Return the rasters of a slide in its results folder, without their endings."""
    return {**RASTERS, **(GROUND_RASTERS if changes_ground else {})}


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
    ground_change
        Vertical rise of the ground, m; None if the ground does not adapt to the snow.
    stopped_depth
        The share of it that is snow which has stopped, m.
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
    ground_change: Optional[Floats] = None
    stopped_depth: Optional[Floats] = None

    @property
    def changed_terrain(self) -> Optional[Floats]:
        """Elevations with the rise of the ground, m; None if the ground does not change."""
        return None if self.ground_change is None else self.terrain + self.ground_change

    @property
    def holds_snow(self) -> Mask:
        """Where snow of the slide lies: on the ground, or as a part of it after it stopped."""
        on_ground: Mask = self.thickness > 0.0
        return on_ground if self.stopped_depth is None else on_ground | (self.stopped_depth > 0.0)

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
        ``peak_thickness``, ``peak_speed``, ``peak_pressure``, ``thickness`` and ``speed``, and if
        the ground adapts to the snow ``ground_change`` and ``changed_terrain``, with dimensions y
        and x: map coordinates of the nodes, m. The attribute ``crs`` is the coordinate system, if
        it is known; the coordinate ``spatial_ref`` describes it as the CF conventions (and
        rioxarray) have it.

    Raises
    ------
    MissingResultError
        If the maps are missing.
    InputError
        If they are damaged, or xarray (extra ``study``) is not installed.
    """
    of_ground = [
        name
        for name in GROUND_RASTERS
        if any(file.is_file() for file in _possible_files(folder, name))
    ]
    names = [*RASTERS, *of_ground]
    dataset = _maps_dataset({name: read_raster(map_file(folder, name)) for name in names})
    for name in ("thickness", "speed"):
        dataset[name].attrs["long_name"] += ", at the end"
    return dataset


def map_file(folder: Path, name: str) -> Path:
    """Return the file of a map in a results folder, in the format that the run has written.

    Parameters
    ----------
    folder
        The results folder.
    name
        Name in `RASTERS` or `GROUND_RASTERS`.

    Raises
    ------
    MissingResultError
        If it is missing.
    """
    files = _possible_files(folder, name)
    for file in files:
        if file.is_file():
            return file
    raise MissingResultError(f"{files[0]}: missing; a run that is not compact writes it")


def _possible_files(folder: Path, name: str) -> list[Path]:
    """Return the files of a map in all formats."""
    stem = rasters_of(changes_ground=True)[name]
    return [folder / f"{stem}{ending}" for ending in ENDINGS.values()]


def write_maps_of_run(folder: Path, maps: SlideMaps, crs: str, form: MapFormat) -> None:
    """Write all maps into a results folder, in place of those of another format."""
    others = {"ascii": (".tif",), "geotiff": (".asc", ".prj")}
    for name, stem in rasters_of(changes_ground=maps.ground_change is not None).items():
        target = folder / f"{stem}{ENDINGS[form]}"
        target.parent.mkdir(exist_ok=True)
        write_raster(target, maps.raster(getattr(maps, name), crs))
        for ending in others[form]:
            target.with_suffix(ending).unlink(missing_ok=True)


def present_maps(core: _core.Simulation, scene: Mapping[str, Any]) -> xarray.Dataset:
    """Return the maps of a slide up to now, as `read_maps` does."""
    maps, crs = slide_maps(core), str(scene["terrain"].get("crs", ""))
    names = rasters_of(changes_ground=maps.ground_change is not None)
    return _maps_dataset({name: maps.raster(getattr(maps, name), crs) for name in names})


def _maps_dataset(rasters: Mapping[str, Raster]) -> xarray.Dataset:
    first = rasters["peak_thickness"]
    dataset = map_dataset({name: raster.heights for name, raster in rasters.items()}, first)
    for name in rasters:
        unit, meaning = MEANINGS[name]
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
