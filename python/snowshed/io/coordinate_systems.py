"""Coordinate systems of maps: read, compared, and handed on beside ASCII grids.

They are kept in words, such as "EPSG:31287" or WKT. What needs to know more than the words asks
rasterio, of the extra snowshed[terrain].
"""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any, Optional

from snowshed._core import InputError
from snowshed.io.atomic import write_text
from snowshed.io.input_file import read_input
from snowshed.io.limits import COORDINATE_SYSTEM

DEGREES = ("EPSG:4326", "OGC:CRS84")


def read_prj(raster: Path) -> str:
    """Return the coordinate system of the .prj beside a raster, in words; empty without one.

    Raises
    ------
    InputError
        If the file is no coordinate system, or one in degrees.
    """
    file = next((f for f in map(raster.with_suffix, (".prj", ".PRJ")) if f.is_file()), None)
    if file is None:
        return ""
    text = read_input(file, COORDINATE_SYSTEM).decode("utf-8", errors="replace").strip()
    if not text:
        return ""
    system = _system(text)
    if system is None and _rasterio() is not None:
        raise InputError(f"{file}: not a coordinate system")
    words = text if system is None else _words(system)
    if is_in_degrees(words):
        raise InputError(f"{file}: its map is in degrees ({words}); project it to metres first")
    return words


def write_prj(raster: Path, words: str) -> None:
    """Write the .prj of a raster; nothing where its coordinate system is not known."""
    if not words:
        return
    system = _system(words)
    if system is not None:
        text = str(system.to_wkt(version="WKT1_ESRI"))
    elif words.lstrip().upper().startswith(("PROJCS", "PROJCRS", "COMPD")):
        text = words
    else:
        return  # a name that only rasterio can put into WKT
    write_text(raster.with_suffix(".prj"), text + "\n")


def are_same(one: str, other: str) -> bool:
    """Return whether two names are of the same coordinate system.

    Examples
    --------
    >>> are_same("EPSG:31287", "epsg:31287"), are_same("EPSG:31287", "EPSG:2056")
    (True, False)
    """
    if one.casefold() == other.casefold():
        return True
    first, second = _system(one), _system(other)
    if first is None or second is None:
        return False
    return bool(first == second) or _words(first) == _words(second)


def is_in_degrees(words: str) -> bool:
    """Return whether a coordinate system is known to be in degrees.

    Examples
    --------
    >>> is_in_degrees("EPSG:4326")
    True
    """
    if words.upper() in DEGREES or words.lstrip().upper().startswith(("GEOGCS", "GEOGCRS")):
        return True
    system = _system(words) if words else None
    return system is not None and bool(system.is_geographic)


def is_in_feet(words: str) -> bool:
    """Return whether a coordinate system is known to be in feet."""
    system = _system(words) if words else None
    if system is None or system.is_geographic:
        return False
    return "foot" in str(system.linear_units).lower() or "feet" in str(system.linear_units).lower()


def _rasterio() -> Optional[Any]:
    try:
        return importlib.import_module("rasterio")
    except ImportError:
        return None


def _system(words: str) -> Optional[Any]:
    """Return rasterio's view of a coordinate system; None if it is not there or knows none."""
    rasterio = _rasterio()
    if rasterio is None:
        return None
    try:
        return rasterio.crs.CRS.from_user_input(words)
    except rasterio.errors.CRSError:
        return None


def _words(system: Any) -> str:
    code = system.to_epsg()
    return f"EPSG:{code}" if code else str(system.to_wkt())
