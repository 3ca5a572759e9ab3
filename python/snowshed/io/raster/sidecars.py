"""Metadata files beside rasters: NAME.aux.xml, from GDAL and ArcGIS."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Optional

from snowshed._core import InputError
from snowshed.base.arrays import Floats
from snowshed.base.formatting import number_in
from snowshed.base.limits import MAX_SIDECAR_BYTES
from snowshed.base.messages import quoted
from snowshed.io.input_file import read_regular
from snowshed.io.raster.vertical_units import metres_of

ENDING = ".aux.xml"


def sidecar(raster: Path, ending: str = ENDING) -> Optional[bytes]:
    """Return the content of a small file beside a raster, if it exists.

    Raises
    ------
    InputError
        If it is not a regular file, or too large.
    OSError
        If it cannot be read.
    """
    file = raster.with_name(f"{raster.name}{ending}")
    return small_file(file) if file.exists() else None


def small_file(file: Path) -> bytes:
    """Return the content of a metadata file; errors are those of `sidecar`."""
    content = read_regular(file)
    if len(content) > MAX_SIDECAR_BYTES:
        raise InputError(f"{file}: {len(content)} bytes; at most {MAX_SIDECAR_BYTES} are read")
    return content


def refuse_other_facts(grid: Path, values: Floats) -> None:
    """Refuse a file beside an ESRI ASCII grid that would change the values for GDAL.

    The core, which reads the grid again when a scene runs, ignores such files. Statistics in them
    are harmless.

    Parameters
    ----------
    grid
        The ASCII grid.
    values
        Values of the raster.
    """
    content = sidecar(grid)
    if content is None:
        return
    for fact, value in _facts(content.decode("utf-8", errors="replace")):
        if _changes(fact, value, values, str(grid)):
            raise InputError(
                f"{grid}{ENDING}: gives {fact} {quoted(value)}, which an ASCII grid cannot have; "
                f"make a GeoTIFF of both: gdal_translate {grid.name} {grid.stem}.tif"
            )


def _facts(text: str) -> Iterator[tuple[str, str]]:
    for fact in ("Scale", "Offset", "UnitType", "NoDataValue"):
        for match in re.finditer(rf"<{fact}[^<>]*>([^<]*)<", text):
            yield fact, match[1].strip()


def _changes(fact: str, value: str, values: Floats, name: str) -> bool:
    """Return whether a fact would change the values of a file."""
    if fact == "UnitType":
        return value != "" and metres_of(value, name) != 1.0
    if fact == "NoDataValue":
        return bool((values == number_in(value)).any())
    return number_in(value) != {"Scale": 1.0, "Offset": 0.0}[fact]
