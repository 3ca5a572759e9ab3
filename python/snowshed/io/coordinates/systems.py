"""Coordinate systems of maps: read, compared, and written beside ASCII grids.

A system is kept as text, such as "EPSG:31287" or WKT. Questions beyond the text go to rasterio, of
the extra snowshed[terrain], which receives plain descriptions only
(`snowshed.io.coordinates.plain_systems`).
"""

from __future__ import annotations

import importlib
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Optional

from snowshed._core import InputError
from snowshed.base.limits import MAX_COORDINATE_SYSTEM_BYTES
from snowshed.io.atomic import write_text
from snowshed.io.coordinates.plain_systems import first_part, plain_system
from snowshed.io.input_file import read_input

DEGREES = ("EPSG:4326", "OGC:CRS84")
OF_ETRS89 = re.compile(r'DATUM\["(ETRS89|ETRF|European_Terrestrial_Reference_System_1989)')
ALLOWED = "allowed: WKT, a code such as EPSG:31287, a proj string without files"
#: Semi-major axis, m, and squared eccentricity of the ellipsoid WGS 84. Other ellipsoids of the
#: Earth give the same scales to a tenth of a per mille.
EARTH_RADIUS, ECCENTRICITY_SQUARED = 6378137.0, 0.00669438
SCALE_STEP = 50.0  # m, half the distance over which the scale of a map is measured


def read_prj(raster: Path) -> str:
    """Return the coordinate system in the .prj beside a raster, as text; empty without a .prj.

    Raises
    ------
    InputError
        If the file is not a coordinate system, or its unit is the degree.
    """
    file = next((f for f in map(raster.with_suffix, (".prj", ".PRJ")) if f.is_file()), None)
    text = "" if file is None else read_system(file)
    if not text:
        return ""
    system = system_of(text)
    if system is None and _rasterio() is not None:
        raise InputError(f"{file}: not a coordinate system; {ALLOWED}")
    description = text if system is None else _description(system)
    if is_in_degrees(description):
        raise InputError(
            f"{file}: its map is in degrees ({description}); project it to metres first"
        )
    return description


def read_system(file: Path) -> str:
    """Return the description in a .prj; empty if the file is empty.

    Raises
    ------
    InputError
        If it holds anything else, such as an address or the name of a file.
    """
    text = (
        read_input(file, MAX_COORDINATE_SYSTEM_BYTES).decode("utf-8-sig", errors="replace").strip()
    )
    if text and not plain_system(text):
        raise InputError(f"{file}: not a coordinate system; {ALLOWED}")
    return text


def write_prj(raster: Path, description: str) -> None:
    """Write the .prj of a raster; nothing if its coordinate system is unknown."""
    system = horizontal_system(description)
    if system is not None:
        text = str(system.to_wkt(version="WKT1_ESRI"))
    elif plain_system(description).upper().startswith(("PROJCS", "PROJCRS", "COMPD")):
        text = first_part(description)
    else:
        return  # only rasterio could turn this name into WKT
    write_text(raster.with_suffix(".prj"), text + "\n")


def are_same(left: str, other: str) -> bool:
    """Return whether two descriptions mean the same coordinate system on the map.

    Compound systems are compared without their heights. National realisations of ETRS89 count as
    the same system: they lie within centimetres, and compound systems of a country often name one.

    Examples
    --------
    >>> are_same("EPSG:31287", "epsg:31287"), are_same("EPSG:31287", "EPSG:2056")
    (True, False)
    """
    if left.casefold() == other.casefold():
        return True
    first, second = horizontal_system(left), horizontal_system(other)
    if first is None or second is None:
        return False
    if first == second or _description(first) == _description(second):
        return True
    return _is_of_etrs89(first) and _is_of_etrs89(second) and first.to_proj4() == second.to_proj4()


def is_in_degrees(description: str) -> bool:
    """Return whether a coordinate system is known to be in degrees.

    Examples
    --------
    >>> is_in_degrees("EPSG:4326")
    True
    """
    plain = first_part(plain_system(description)).upper()
    if plain in DEGREES or plain.startswith(("GEOGCS", "GEOGCRS")):
        return True
    system = horizontal_system(description)
    return system is not None and bool(system.is_geographic)


def is_in_feet(description: str) -> bool:
    """Return whether the map of a coordinate system is known to be in feet."""
    system = horizontal_system(description)
    if system is None or system.is_geographic:
        return False
    return "foot" in str(system.linear_units).lower() or "feet" in str(system.linear_units).lower()


def map_scale(description: str, x: float, y: float) -> Optional[tuple[float, float]]:
    """Return how many metres of the map are one metre on the ground, eastwards and northwards.

    None if the system is unknown, is not one of the Earth, or if the point does not lie on its map.

    Parameters
    ----------
    description
        Coordinate system of a map in metres.
    x, y
        A point of the map, m.
    """
    rasterio, system = _rasterio(), horizontal_system(description)
    if rasterio is None or system is None or system.is_geographic:
        return None
    step = SCALE_STEP
    try:
        warp = importlib.import_module("rasterio.warp")
        longitudes, latitudes = warp.transform(
            system, "EPSG:4326", [x - step, x + step, x, x], [y, y, y - step, y + step]
        )
    except (rasterio.errors.RasterioError, _cpl_error()):
        return None
    points = [*longitudes, *latitudes]
    if not all(math.isfinite(value) for value in points) or max(map(abs, latitudes)) >= 90.0:
        return None
    east = _distance(longitudes[:2], latitudes[:2])
    north = _distance(longitudes[2:], latitudes[2:])
    if min(east, north) == 0.0:
        return None
    return 2.0 * step / east, 2.0 * step / north


def _distance(longitudes: Sequence[float], latitudes: Sequence[float]) -> float:
    """Return the distance of two near points on the ground, m."""
    middle = math.radians(sum(latitudes) / 2.0)
    flattened = 1.0 - ECCENTRICITY_SQUARED * math.sin(middle) ** 2
    across = EARTH_RADIUS / math.sqrt(flattened) * math.cos(middle)
    along = EARTH_RADIUS * (1.0 - ECCENTRICITY_SQUARED) / flattened**1.5
    turn = (longitudes[1] - longitudes[0] + 180.0) % 360.0 - 180.0
    return math.hypot(
        across * math.radians(turn), along * math.radians(latitudes[1] - latitudes[0])
    )


def horizontal_system(description: str) -> Optional[Any]:
    """Return a coordinate system without its heights as rasterio's object; see `system_of`."""
    system = system_of(description)
    if system is None:
        return None
    wkt = str(system.to_wkt())
    horizontal = first_part(wkt)
    return system if horizontal == wkt else system_of(horizontal)


def system_of(description: str) -> Optional[Any]:
    """Return rasterio's object for a coordinate system; None if rasterio is missing or knows none.

    Descriptions that are not plain are refused (`snowshed.io.coordinates.plain_systems`).
    """
    rasterio = _rasterio()
    plain = plain_system(description)
    if rasterio is None or not plain:
        return None
    try:
        return rasterio.crs.CRS.from_user_input(plain)
    except rasterio.errors.CRSError:
        return None


def _is_of_etrs89(system: Any) -> bool:
    return OF_ETRS89.search(str(system.to_wkt())) is not None


def _rasterio() -> Optional[Any]:
    try:
        return importlib.import_module("rasterio")
    except ImportError:
        return None


def _cpl_error() -> type[Exception]:
    """Return the errors of GDAL and PROJ that rasterio passes on."""
    error: type[Exception] = importlib.import_module("rasterio._err").CPLE_BaseError
    return error


def _description(system: Any) -> str:
    code = system.to_epsg()
    return f"EPSG:{code}" if code else str(system.to_wkt())
