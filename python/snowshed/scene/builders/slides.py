"""Scenes of snow slides: terrain from a raster, areas from files of polygons."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Optional

import numpy as np

from snowshed._core import InputError
from snowshed.io.map_areas import MapArea, read_areas
from snowshed.io.paths import PathLike
from snowshed.io.raster import GEOTIFF, Raster, is_single, read_raster, write_ascii_grid
from snowshed.io.release_raster import areas_of_depth
from snowshed.methods.slide import SlideSettings
from snowshed.scene.builders.hillside import hillside
from snowshed.scene.builders.terrain_checks import (
    check_apart,
    check_place,
    check_terrain,
    common_system,
)
from snowshed.scene.components import Area, Events, Hole, ResistanceArea, Terrain
from snowshed.scene.scene import Scene

MAX_TIME = 400.0  # s, as AvaFrame has it
THINNEST = 0.01  # m, of snow that is worth a slide
#: What names the layer of a file on the command line.
LAYER_OPTIONS = {
    "release": "--layer",
    "entrainment": "--entrainment-layer",
    "resistance": "--resistance-layer",
}


def slide_scene(
    raster: PathLike,
    release: Optional[PathLike] = None,
    *,
    thickness: Optional[float] = None,
    thickness_raster: Optional[PathLike] = None,
    entrainment: Optional[PathLike] = None,
    entrained_thickness: Optional[float] = None,
    resistance: Optional[PathLike] = None,
    layers: Optional[Mapping[str, str]] = None,
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
        Polygons of the areas that break loose; a field "thickness" holds that of the snow, m. None:
        all cells where `thickness_raster` holds snow.
    thickness
        Thickness of the snow, normal to the ground [m], in place of the file's.
    thickness_raster
        The same in the cells of a raster, m; it must say it everywhere in the release.
    entrainment, resistance
        Polygons of areas where snow is taken up, and of forest.
    entrained_thickness
        Thickness of the snow that can be taken up [m], in place of the file's.
    layers
        Layers of GeoPackages that hold several, by what they are read for: "release",
        "entrainment", "resistance".
    settings
        Settings of the method; None: its defaults.
    ascii_copy
        Where a GeoTIFF's copy as an ASCII grid goes, which the scene names; that of a raster of
        thickness goes beside it.
    title
        What this scene is.

    Raises
    ------
    InputError
        If a file is not what it should be, coordinate systems differ, elevations or cells are none
        in metres, areas lie beside the terrain or on each other, or the thickness is missing.
    OSError
        If a file cannot be read, or the copy not be written.
    """
    terrain = read_raster(raster)
    check_terrain(terrain)
    depth = read_raster(thickness_raster) if thickness_raster is not None else None
    polygons = _Polygons(layers)
    areas = _release_areas(release, thickness, depth, polygons)
    eroded = polygons.areas(entrainment, "entrainment")
    held = polygons.areas(resistance, "resistance")
    check_place(terrain, areas)
    check_apart(areas)
    files = [(str(raster), terrain.crs), *((area.file, area.crs) for area in areas + eroded + held)]
    if depth is not None:
        files.append((depth.name, depth.crs))
    crs = common_system(files)
    rings = [_snow_area(area, thickness, depth) for area in areas]
    file = _as_text(Path(raster), terrain, ascii_copy)
    map_file = None
    if depth is not None:
        beside = Path(ascii_copy) if ascii_copy is not None else None
        copy = beside.with_name(f"{beside.stem}-thickness.asc") if beside is not None else None
        map_file = str(_as_text(Path(depth.name), depth, copy).resolve())
    return Scene(
        method="slide",
        dimension=3,
        title=title,
        terrain=Terrain(
            file=file.resolve(),
            crs=crs,
            # GeoTIFF keeps double precision, AvaFrame reads text in single.
            single_precision=None if file == Path(raster) or is_single(terrain) else False,
            thickness_file=map_file,
            release=rings,
            entrainment=[_snow_area(area, entrained_thickness) for area in eroded] or None,
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


def _as_text(file: Path, raster: Raster, copy: Optional[PathLike]) -> Path:
    """Return an ASCII grid of a raster: itself, or its copy."""
    if file.suffix.lower() not in GEOTIFF:
        return file
    if copy is None:
        raise InputError(f"{file}: say where its copy as an ASCII grid shall go (ascii_copy)")
    write_ascii_grid(copy, raster, exact=True)
    return Path(copy)


class _Polygons:
    """Reads files of polygons, of each the layer that is named for it."""

    def __init__(self, layers: Optional[Mapping[str, str]]) -> None:
        self.layers = layers or {}
        for part in self.layers:
            if part not in LAYER_OPTIONS:
                raise InputError(f"layers: {part!r} is none of {', '.join(LAYER_OPTIONS)}")

    def areas(self, file: Optional[PathLike], part: str) -> list[MapArea]:
        """Return the areas of a file; none without one. Forest has no thickness."""
        if file is None:
            return []
        return read_areas(
            file,
            self.layers.get(part),
            option=LAYER_OPTIONS[part],
            with_thickness=part != "resistance",
        )


def _release_areas(
    release: Optional[PathLike],
    thickness: Optional[float],
    depth: Optional[Raster],
    polygons: _Polygons,
) -> list[MapArea]:
    if depth is not None:
        if thickness is not None:
            raise InputError("give one of a thickness and a raster of thickness")
        if not (depth.heights > 0).any():
            raise InputError(f"{depth.name}: holds no thickness above 0")
        return areas_of_depth(depth) if release is None else polygons.areas(release, "release")
    if release is None:
        raise InputError("give the release: polygons or a raster of thickness")
    return polygons.areas(release, "release")


def _snow_area(area: MapArea, thickness: Optional[float], depth: Optional[Raster] = None) -> Area:
    snow = thickness if thickness is not None else area.thickness
    if depth is not None:  # the scene's raster goes before it
        snow = float(np.nanmax(depth.heights))
    if snow is None:
        raise InputError(f"{area.name}: the file gives no thickness; give one (--thickness)")
    if snow < THINNEST:
        raise InputError(f"{area.name}: {snow:g} m of snow; at least {THINNEST:g} m are needed")
    return Area(name=area.name, outline=area.outline, holes=_holes(area), thickness=snow)


def _holes(area: MapArea) -> Optional[list[Hole]]:
    return [Hole(outline=ring) for ring in area.holes] or None
