"""Scenes of snow slides: terrain from a raster, areas from files of polygons."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Optional, Union
from uuid import uuid4

import numpy as np

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.callers import argument
from snowshed.base.limits import MAX_TERRAIN_CELLS
from snowshed.base.notes import record_notes
from snowshed.base.paths import PathLike
from snowshed.io.array_files import array_folder
from snowshed.io.raster.areas import MapArea, read_areas
from snowshed.io.raster.arrays import areas_of, raster_of
from snowshed.io.raster.raster import Raster, is_single, read_raster, write_ascii_grid
from snowshed.io.raster.release import areas_of_depth, snow_part
from snowshed.io.raster.terrain_nodes import thickness_on_terrain
from snowshed.methods.slide.settings import SlideSettings
from snowshed.scene.builders.dams import read_dams
from snowshed.scene.builders.hillside import hillside
from snowshed.scene.builders.hydrographs import read_hydrograph
from snowshed.scene.builders.terrain_checks import (
    MAX_SLOPE,
    check_apart,
    check_place,
    check_terrain,
    common_system,
    note_assumed_system,
    note_small_areas,
    read_terrain,
)
from snowshed.scene.builders.terrain_copy import thickness_copy
from snowshed.scene.components import Events
from snowshed.scene.scene import Scene
from snowshed.scene.terrain_components import Area, Hole, Inflow, Pulse, ResistanceArea, Terrain

if TYPE_CHECKING:
    import xarray

MAX_TIME = 400.0  # s, as in AvaFrame
MIN_THICKNESS = 0.01  # m, smallest thickness of snow for a slide
MAX_THICKNESS = 10.0  # m, largest plausible thickness of snow, as in the core
#: Options of the command line that name the layer of a file of polygons, by its purpose.
LAYER_OPTIONS = {
    "release": "layer",
    "entrainment": "entrainment-layer",
    "resistance": "resistance-layer",
    "secondary_release": "secondary-release-layer",
    "inflow": "inflow-layer",
}


@checked
def slide_scene(
    raster: Union[PathLike, Raster, xarray.DataArray],
    release: Optional[object] = None,
    *,
    thickness: Optional[float] = None,
    thickness_raster: Optional[Union[PathLike, Raster]] = None,
    entrainment: Optional[object] = None,
    entrained_thickness: Optional[float] = None,
    resistance: Optional[object] = None,
    secondary_release: Optional[object] = None,
    secondary_thickness: Optional[float] = None,
    inflow: Optional[object] = None,
    hydrograph: Optional[PathLike] = None,
    dams: Optional[PathLike] = None,
    layers: Optional[Mapping[str, str]] = None,
    settings: Optional[SlideSettings] = None,
    ascii_copy: Optional[PathLike] = None,
    title: str = "",
    band: Optional[int] = None,
    thickness_band: Optional[int] = None,
    max_slope: Optional[float] = None,
    max_thickness: Optional[float] = None,
    max_cells: Optional[int] = None,
) -> Scene:
    """Return the scene of a slide on terrain.

    Parameters
    ----------
    raster
        Elevations, m: an ESRI ASCII grid or a GeoTIFF, on a projected map; or a `Raster`, or a
        DataArray of xarray with the coordinates x and y.
    release
        Polygons of the release areas: a file, shapely polygons, a GeoDataFrame, or the outlines
        of `snowshed.analysis.hazard.ReleaseCandidates`; a field "thickness" holds the thickness of
        the snow, m.
        None: all cells with snow in `thickness_raster`.
    thickness
        Thickness of the snow, normal to the ground [m], instead of the thickness in the file.
    thickness_raster
        Raster of the thickness, m, with a value everywhere in the release: a file or a `Raster`.
        In the mode "compatible" it covers the terrain; it is interpolated onto other cells as in
        AvaFrame.
    entrainment, resistance
        Polygons of entrainment areas, and of forest.
    entrained_thickness
        Thickness of the erodible snow [m], instead of the thickness in the file.
    secondary_release
        Polygons of areas that are released when snow of the slide enters them; the thickness is
        that of the file.
    secondary_thickness
        Thickness of their snow [m], instead of the thickness in the file.
    inflow
        Polygons that snow enters at the times of `hydrograph`.
    hydrograph
        A CSV file with the columns timestep [s], thickness [m] and velocity [m/s, down the slope].
    dams
        Lines of dams: a file whose field "height" is the height of the crown above the ground [m],
        or a shapefile whose lines have the elevation of the crown as z. A field "restitution" is
        optional.
    layers
        Layers of GeoPackages with several, by purpose: "release", "entrainment", "resistance",
        "secondary_release", "inflow".
    settings
        Settings of the method; None: its defaults.
    ascii_copy
        File for a copy of the terrain as an ASCII grid in metres, if the terrain has another
        format; the scene then names the copy. A copy of a raster of thickness goes beside it.
    title
        Title of the scene.
    band, thickness_band
        Bands of the rasters of elevations and of thickness, from 1; needed if a GeoTIFF has
        several.
    max_slope
        Steepest plausible cliff under the release [degrees]. [default: 70]
    max_thickness
        Largest plausible thickness of snow [m]. [default: 10]
    max_cells
        Largest number of cells of the raster of elevations. [default: 2.5 million]

    Raises
    ------
    InputError
        If a file is invalid, coordinate systems differ, elevations or cells are not in metres,
        areas lie beside the terrain or overlap, or the thickness is missing.
    OSError
        If a file cannot be read, or the copy not be written.
    """
    with record_notes() as notes:
        steepest = MAX_SLOPE if max_slope is None else max_slope
        terrain = _terrain(raster, band, steepest, max_cells or MAX_TERRAIN_CELLS)
        depth = None
        if thickness_raster is not None:
            depth = _depth(thickness_raster, thickness_band)
            if settings is not None and settings.mode == "compatible":
                depth = thickness_on_terrain(depth, terrain, cell=settings.cell or 0.0)
        polygons = _Polygons(layers)
        areas = _release_areas(release, thickness, depth, polygons)
        eroded = polygons.areas(
            entrainment, "entrainment", _replacement(entrained_thickness, "entrained_thickness")
        )
        held = polygons.areas(resistance, "resistance")
        waiting = polygons.areas(
            secondary_release,
            "secondary_release",
            _replacement(secondary_thickness, "secondary_thickness"),
        )
        entered = polygons.areas(inflow, "inflow")
        pulses = _pulses(inflow, hydrograph)
        walls, walls_crs = ([], "") if dams is None else read_dams(Path(dams), terrain)
        files = [(terrain.name, terrain.crs)]
        files += [(area.file, area.crs) for area in areas + eroded + held + waiting + entered]
        if walls:
            files.append((str(dams), walls_crs))
        if depth is not None:
            files.append((depth.name, depth.crs))
        crs = common_system(files)
        note_assumed_system(terrain, crs)
        note_small_areas([*areas, *eroded, *held, *waiting, *entered], terrain)
    check_place(terrain, areas)
    check_apart(areas)
    most = MAX_THICKNESS if max_thickness is None else max_thickness
    rings = [_snow_area(area, thickness, most, depth) for area in areas]
    file = _ascii_grid(Path(terrain.name), terrain, ascii_copy)
    map_file = None if depth is None else str(_thickness_file(depth, ascii_copy).resolve())
    return Scene(
        method="slide",
        dimension=3,
        title=title,
        terrain=Terrain(
            file=file.resolve(),
            crs=crs,
            # GeoTIFF keeps double precision; AvaFrame reads text in single precision.
            single_precision=None if terrain.plain or is_single(terrain) else False,
            thickness_file=map_file,
            max_thickness=max_thickness,
            max_slope=max_slope,
            notes="\n".join(notes) or None,
            release=rings,
            entrainment=[
                _snow_area(area, entrained_thickness, most, name="entrained_thickness")
                for area in eroded
            ]
            or None,
            secondary_release=[
                _snow_area(area, secondary_thickness, most, name="secondary_thickness")
                for area in waiting
            ]
            or None,
            inflows=[
                Inflow(name=area.name, outline=area.outline, holes=_holes(area), hydrograph=pulses)
                for area in entered
            ]
            or None,
            dams=walls or None,
            resistance=[
                ResistanceArea(name=area.name, outline=area.outline, holes=_holes(area))
                for area in held
            ]
            or None,
        ),
        numerics=settings or SlideSettings(),
        events=Events(max_time=MAX_TIME),
    )


def _terrain(
    raster: Union[PathLike, Raster, xarray.DataArray],
    band: Optional[int],
    steepest: float,
    max_cells: int,
) -> Raster:
    """Return elevations from a file, or from an object in memory."""
    if isinstance(raster, (str, os.PathLike)):
        return read_terrain(raster, band, steepest, max_cells)
    terrain = raster if isinstance(raster, Raster) else raster_of(raster)
    if terrain.heights.size > max_cells:
        raise InputError(f"terrain: {terrain.heights.size} cells; at most {max_cells} are allowed")
    check_terrain(terrain, steepest)
    return dataclasses.replace(terrain, plain=False)


def _depth(raster: Union[PathLike, Raster], band: Optional[int]) -> Raster:
    """Return thicknesses from a file, or those of a raster."""
    return raster if isinstance(raster, Raster) else read_raster(raster, band)


@checked
def example_slide(folder: PathLike) -> Scene:
    """Write an example's terrain to a folder, and return the scene of a slide on it.

    A hillside of up to 38 degrees with a winding gully, spurs and hummocks runs out onto a gentle
    meadow; a slab of half a metre is released near its top. Formulas define all of it.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     scene = example_slide(folder)
    >>> scene.terrain.release[0].thickness
    0.5
    """
    file = Path(folder) / "terrain.asc"
    write_ascii_grid(file, hillside())
    outline = [(24.0, 36.0), (50.0, 32.0), (56.0, 60.0), (48.0, 86.0), (26.0, 82.0), (20.0, 60.0)]
    return Scene(
        method="slide",
        dimension=3,
        title="Slide on an example slope",
        terrain=Terrain(file=file, release=[Area(name="slab", outline=outline, thickness=0.5)]),
        events=Events(max_time=MAX_TIME),
    )


def _ascii_grid(file: Path, raster: Raster, copy: Optional[PathLike]) -> Path:
    """Return an ASCII grid of a raster: itself, or its copy."""
    if raster.plain:
        return file
    if copy is None and not file.exists():  # elevations in memory
        copy = array_folder() / f"{uuid4().hex}.asc"
    if copy is None:
        raise InputError(f"{file}: give the file for its copy as an ASCII grid (ascii_copy)")
    write_ascii_grid(copy, raster, exact=True)
    return Path(copy)


def _thickness_file(depth: Raster, ascii_copy: Optional[PathLike]) -> Path:
    """Return an ASCII grid of a raster of thickness; a copy has only the part with snow."""
    copy = None
    if ascii_copy is not None:
        copy = thickness_copy(Path(ascii_copy))
    return _ascii_grid(Path(depth.name), depth if depth.plain else snow_part(depth), copy)


class _Polygons:
    """Reader of files of polygons, and of the named layer of each."""

    def __init__(self, layers: Optional[Mapping[str, str]]) -> None:
        self.layers = layers or {}
        for part in self.layers:
            if part not in LAYER_OPTIONS:
                raise InputError(f"layers: {part!r} is none of {', '.join(LAYER_OPTIONS)}")

    def areas(self, file: Optional[object], part: str, replacement: str = "") -> list[MapArea]:
        """Return the areas of a file; none without a file. Forest has no thickness.

        `replacement` says what replaces the thickness in the file.
        """
        if file is None:
            return []
        if not isinstance(file, (str, os.PathLike)):
            return areas_of(file, name=part)
        return read_areas(
            file,
            self.layers.get(part),
            option=argument(f"layers[{part!r}]", option=LAYER_OPTIONS[part]),
            with_thickness=part not in ("resistance", "inflow"),
            replacement=replacement,
        )


def _replacement(thickness: Optional[float], name: str) -> str:
    """Return the argument that replaces the thickness in a file; empty without one."""
    return "" if thickness is None else argument(name)


def _pulses(inflow: Optional[object], hydrograph: Optional[PathLike]) -> list[Pulse]:
    if (inflow is None) != (hydrograph is None):
        raise InputError("give both the polygons of an inflow and its hydrograph")
    return [] if hydrograph is None else read_hydrograph(Path(hydrograph))


def _release_areas(
    release: Optional[object],
    thickness: Optional[float],
    depth: Optional[Raster],
    polygons: _Polygons,
) -> list[MapArea]:
    if depth is not None:
        if thickness is not None:
            raise InputError("give one of a thickness and a raster of thickness")
        snow_part(depth)  # checks the values of the raster
        if release is None:
            return areas_of_depth(depth)
        return polygons.areas(release, "release", depth.name)
    if release is None:
        raise InputError("give the release: polygons or a raster of thickness")
    return polygons.areas(release, "release", _replacement(thickness, "thickness"))


def _snow_area(
    area: MapArea,
    thickness: Optional[float],
    most: float,
    depth: Optional[Raster] = None,
    name: str = "thickness",
) -> Area:
    snow = thickness if thickness is not None else area.thickness
    if depth is not None:  # the scene's raster has priority
        snow = float(np.nanmax(depth.heights))
    if snow is None:
        raise InputError(f"{area.name}: the file gives no thickness; give one ({argument(name)})")
    if snow < MIN_THICKNESS:
        raise InputError(
            f"{area.name}: {snow:g} m of snow; at least {MIN_THICKNESS:g} m are needed"
        )
    if snow > most and depth is None:  # the core checks the cells of a raster
        raise InputError(
            f"{area.name}: {snow:g} m of snow; at most {most:g} m are plausible; is it in "
            f"centimetres? If not, raise {argument('max_thickness')}"
        )
    return Area(name=area.name, outline=area.outline, holes=_holes(area), thickness=snow)


def _holes(area: MapArea) -> Optional[list[Hole]]:
    return [Hole(outline=ring) for ring in area.holes] or None
