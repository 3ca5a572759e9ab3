"""The command lines of snowshed that the algorithms run; needs no QGIS."""

from __future__ import annotations

import shlex
from typing import NamedTuple, Optional

#: Maps that are loaded: files in the results folder, style, and title of the layer.
MAPS = (
    ("peaks/pft.tif", "thickness.qml", "peak thickness (m)"),
    ("peaks/ppr.tif", "pressure.qml", "peak pressure (kPa)"),
    ("peaks/pfv.tif", "speed.qml", "peak speed (m/s)"),
)


class Polygons(NamedTuple):
    """A file of polygons, and its layer if it has several."""

    file: str
    layer: str = ""


def slide_command(
    terrain: str,
    release: Polygons,
    folder: str,
    *,
    thickness: Optional[float] = None,
    friction: Optional[float] = None,
    turbulence: Optional[float] = None,
    resistance: Optional[Polygons] = None,
    further: str = "",
    program: str = "snowshed",
) -> list[str]:
    """Return the command line of a slide whose maps are GeoTIFF.

    Parameters
    ----------
    terrain, release, resistance
        Files of elevations, of release areas, and of forest.
    folder
        The results folder.
    thickness
        Thickness of the snow, m; None: that of the polygons.
    friction, turbulence
        Voellmy's coefficients, the second in m/s2; None: the defaults.
    further
        More options, as in a shell.
    program
        Name or path of the program.
    """
    return [
        program,
        "slide",
        *("--terrain", terrain),
        *_polygons("--release", "--layer", release),
        *_polygons("--resistance-areas", "--resistance-layer", resistance),
        *_numbers({"--thickness": thickness, "--friction": friction, "--turbulence": turbulence}),
        *("--map-format", "geotiff"),
        *shlex.split(further),
        *("-o", folder),
    ]


def release_areas_command(
    terrain: str,
    file: str,
    *,
    slopes: tuple[float, float],
    smallest: float,
    gap: float,
    sectors: int,
    thickness: Optional[float] = None,
    forest: Optional[Polygons] = None,
    further: str = "",
    program: str = "snowshed",
) -> list[str]:
    """Return the command line that finds candidate release areas.

    Parameters
    ----------
    terrain, forest
        Files of elevations and of forest.
    file
        File of the candidates, .gpkg, .geojson or .shp.
    slopes
        Smallest and largest slope, degrees.
    smallest, gap
        Smallest area, and largest gap that is filled, m2.
    sectors
        Number of sectors by which slopes are split.
    thickness
        Thickness of the snow, m.
    further, program
        As for `slide_command`.
    """
    low, high = slopes
    return [
        program,
        "release-areas",
        terrain,
        *("--slope", f"{low:g}:{high:g}"),
        *_numbers({"--min-area": smallest, "--max-gap": gap, "--thickness": thickness}),
        *("--sectors", str(sectors)),
        *_polygons("--forest", "--forest-layer", forest),
        *shlex.split(further),
        *("-o", file),
    ]


def _numbers(values: dict[str, Optional[float]]) -> list[str]:
    return [
        word
        for option, value in values.items()
        if value is not None
        for word in (option, f"{value:.12g}")
    ]


def _polygons(option: str, layer_option: str, polygons: Optional[Polygons]) -> list[str]:
    if polygons is None:
        return []
    layer = [layer_option, polygons.layer] if polygons.layer else []
    return [option, polygons.file, *layer]
