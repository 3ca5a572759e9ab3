"""Scenes of snow slides: terrain from a raster, areas from files of polygons."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

import numpy as np

from snowshed._core import InputError
from snowshed.io.map_areas import MapArea, read_areas
from snowshed.io.paths import PathLike
from snowshed.io.raster import GEOTIFF, Raster, read_raster, write_ascii_grid
from snowshed.methods.slide import SlideSettings
from snowshed.scene.builders.hillside import hillside
from snowshed.scene.components import Area, Events, Hole, ResistanceArea, Terrain
from snowshed.scene.scene import Scene

MAX_TIME = 400.0  # s, as AvaFrame has it
LOWEST, HIGHEST = -430.0, 8850.0  # m, of the Earth's land
THINNEST = 0.01  # m, of snow that is worth a slide


def slide_scene(
    raster: PathLike,
    release: PathLike,
    *,
    thickness: Optional[float] = None,
    entrainment: Optional[PathLike] = None,
    resistance: Optional[PathLike] = None,
    settings: Optional[SlideSettings] = None,
    ascii_copy: Optional[PathLike] = None,
    title: str = "",
) -> Scene:
    """Return the scene of a slide on terrain.

    Parameters
    ----------
    raster
        Elevations, m: an ESRI ASCII grid or a GeoTIFF, on a projected map.
    release
        Polygons of the areas that break loose; a field "thickness" holds that of the snow, m.
    thickness
        Thickness of the snow, normal to the ground [m], in place of the file's.
    entrainment, resistance
        Polygons of areas where snow is taken up, and of forest.
    settings
        Settings of the method; None: its defaults.
    ascii_copy
        Where a GeoTIFF's copy as an ASCII grid goes, which the scene names.
    title
        What this scene is.

    Raises
    ------
    InputError
        If a file is not what it should be, coordinate systems differ, elevations are none in
        metres, or the thickness is missing.
    OSError
        If a file cannot be read, or the copy not be written.
    """
    terrain = read_raster(raster)
    _check_elevations(terrain)
    areas = read_areas(release)
    eroded = read_areas(entrainment) if entrainment is not None else []
    held = read_areas(resistance) if resistance is not None else []
    crs = _common_crs([terrain.crs, *(area.crs for area in (*areas, *eroded, *held))])
    file = Path(raster)
    if file.suffix.lower() in GEOTIFF:
        if ascii_copy is None:
            raise InputError(f"{raster}: say where its copy as an ASCII grid shall go (ascii_copy)")
        write_ascii_grid(ascii_copy, terrain)
        file = Path(ascii_copy)
    return Scene(
        method="slide",
        dimension=3,
        title=title,
        terrain=Terrain(
            file=file.resolve(),
            crs=crs,
            release=[_snow_area(area, thickness) for area in areas],
            entrainment=[_snow_area(area, None) for area in eroded] or None,
            resistance=[
                ResistanceArea(name=area.name, outline=area.outline, holes=_holes(area))
                for area in held
            ]
            or None,
        ),
        numerics=settings,
        events=Events(max_time=MAX_TIME),
    )


def example_slide(folder: PathLike) -> Scene:
    """Write an example's terrain to a folder, and return the scene of a slide on it.

    A hillside of up to 38 degrees with a winding gully, spurs and hummocks runs out onto a gentle
    meadow; a slab of half a metre breaks loose near its top. All of it is made of formulas.

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


def _check_elevations(terrain: Raster) -> None:
    known = terrain.heights[~np.isnan(terrain.heights)]
    if known.size == 0:
        raise InputError(f"{terrain.name}: holds no elevation")
    low, high = float(known.min()), float(known.max())
    if low < LOWEST or high > HIGHEST:
        raise InputError(
            f"{terrain.name}: elevations from {low:g} to {high:g} m are none of the Earth "
            f"({LOWEST:g} to {HIGHEST:g} m); are they in feet?"
        )


def _common_crs(names: list[str]) -> str:
    """Return the coordinate system that all files have that say it; empty where none does."""
    given = [name for name in names if name]
    for name in given:
        if name != given[0]:
            raise InputError(
                f"the files have different coordinate systems, {given[0]} and {name}; "
                "bring them to one first"
            )
    return given[0] if given else ""


def _snow_area(area: MapArea, thickness: Optional[float]) -> Area:
    snow = thickness if thickness is not None else area.thickness
    if snow is None:
        raise InputError(f"{area.name}: the file gives no thickness; give one (--thickness)")
    if snow < THINNEST:
        raise InputError(f"{area.name}: {snow:g} m of snow; at least {THINNEST:g} m are needed")
    return Area(name=area.name, outline=area.outline, holes=_holes(area), thickness=snow)


def _holes(area: MapArea) -> Optional[list[Hole]]:
    return [Hole(outline=ring) for ring in area.holes] or None
