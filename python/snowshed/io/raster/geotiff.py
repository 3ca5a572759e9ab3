"""Rasters from GeoTIFF, read by GDAL's rules. They need the extra snowshed[terrain].

GDAL sees the file and the named files beside it as copies in memory: other files in the folder are
not opened, and no other format is tried.
"""

from __future__ import annotations

import math
import sys
import uuid
import warnings
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, NamedTuple, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.base.arrays import Booleans, Floats
from snowshed.base.callers import argument
from snowshed.base.extras import require
from snowshed.base.limits import MAX_RASTER_BLOCK_BYTES, MAX_RASTER_CELLS
from snowshed.base.messages import quoted
from snowshed.base.notes import InputNote, issue_note
from snowshed.io.coordinates.gdal_fence import fenced_rasterio
from snowshed.io.input_file import read_regular
from snowshed.io.raster.sidecars import sidecar, small_file
from snowshed.io.raster.vertical_units import metres_of, split_system

#: Files beside a GeoTIFF that GDAL may see: metadata, and world files with its position.
FACTS = "a.tif.aux.xml"
WORLD_FILES = (".tfw", ".tifw", ".tiffw", ".wld")


class BandFacts(NamedTuple):
    """Metadata of a band from GDAL."""

    scale: float
    offset: float
    unit: str
    nodata: Optional[float]
    place: tuple[float, ...]
    system: str


class PlacedHeights(NamedTuple):
    """Heights (rows, columns) in m, the southernmost row first, and their position on the map."""

    heights: Floats
    east: float
    north: float
    cell: float
    system: str
    numbers: str  # their type in the file, such as "int16"


def read_geotiff(path: Path, band: Optional[int] = None) -> PlacedHeights:
    """Return a band of a GeoTIFF in metres, with its scale, unit and missing values applied.

    Parameters
    ----------
    path
        The file.
    band
        Band of the file, from 1; needed if there are several.

    Raises
    ------
    InputError
        If it is not a GeoTIFF, has several bands or images, is rotated, or is too large.
    OSError
        If it cannot be read.
    """
    content = read_regular(path)
    extra = _sidecars(path)
    with _open_geotiff(path, content, extra) as source:
        number = _checked_band(source, path, band)
        _check_size(source, path, number)
        facts = _facts(source, number)
        _note_on_sidecar(path, content, extra, number, facts)
        values, missing = source.read(number), _missing(source, number)
        system, metres_per_unit = ("", None)
        if source.crs is not None:
            if source.crs.is_geographic:
                raise InputError(
                    f"{path}: its map is in degrees ({source.crs}); project it to metres first"
                )
            system, metres_per_unit = split_system(source.crs, str(path))
        transform, has_points = source.transform, bool(source.gcps[0])
    heights = _in_metres(values, facts, _factor(facts, metres_per_unit, path), path)
    heights[missing] = np.nan
    return _place_on_map(heights, transform, system, values.dtype.name, path, has_points)


@contextmanager
def _open_geotiff(path: Path, content: bytes, extra: dict[str, bytes]) -> Iterator[Any]:
    """Open the bytes of a GeoTIFF and of files beside it, by their suffixes."""
    rasterio: Any = require("rasterio", "terrain", "reading a GeoTIFF")

    # rasterio does not translate all errors of GDAL
    gdal: Any = require("rasterio._err", "terrain", "reading a GeoTIFF")
    if not content:
        raise InputError(f"{path}: not a GeoTIFF: it is empty")
    folder = str(uuid.uuid4())
    with fenced_rasterio(), ExitStack() as stack:
        try:
            stack.enter_context(_without_words_of_gdal())
            stack.enter_context(warnings.catch_warnings())
            # The caller refuses a raster without a position on the map.
            warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
            for name, data in extra.items():
                stack.enter_context(rasterio.MemoryFile(data, dirname=folder, filename=name))
            file = stack.enter_context(
                rasterio.MemoryFile(content, dirname=folder, filename="a.tif")
            )
            yield stack.enter_context(file.open(driver="GTiff"))
        except (rasterio.errors.RasterioError, gdal.CPLE_BaseError, UnicodeDecodeError) as error:
            reason = str(error).replace(f"/vsimem/{folder}/", "")
            raise InputError(f"{path}: not a GeoTIFF: {reason}") from None


@contextmanager
def _without_words_of_gdal() -> Iterator[None]:
    """Prevent tracebacks of rasterio if GDAL quotes bytes that are not text."""
    unraisable, uncaught = sys.unraisablehook, sys.excepthook

    def drop_or_report(event: Any) -> None:
        if not isinstance(event.exc_value, UnicodeDecodeError):
            unraisable(event)

    def drop_or_print(kind: Any, value: Any, trace: Any) -> None:
        if not isinstance(value, UnicodeDecodeError):
            uncaught(kind, value, trace)

    sys.unraisablehook, sys.excepthook = drop_or_report, drop_or_print
    try:
        yield
    finally:
        sys.unraisablehook, sys.excepthook = unraisable, uncaught


def _sidecars(path: Path) -> dict[str, bytes]:
    """Return the files that GDAL may see beside a GeoTIFF: its .aux.xml and its world file."""
    mask = path.with_name(f"{path.name}.msk")
    if mask.exists():
        raise InputError(
            f"{mask}: a mask beside a raster is not read; put it into the raster, by "
            f"gdal_translate, or remove it"
        )
    facts = sidecar(path)
    companions = {FACTS: facts} if facts else {}
    for file in (path.with_suffix(ending) for ending in WORLD_FILES):
        if file.exists() and "a.tfw" not in companions and (content := small_file(file)):
            companions["a.tfw"] = content
    return companions


def _checked_band(source: Any, path: Path, band: Optional[int]) -> int:
    """Return the band to read; without `band`, the only band."""
    if source.subdatasets:
        raise InputError(
            f"{path}: holds {len(source.subdatasets)} images; take one out of it, for example "
            f"gdal_translate GTIFF_DIR:1:{path.name} one.tif"
        )
    alpha = [kind.name == "alpha" for kind in source.colorinterp]
    bands = [number for number, is_alpha in enumerate(alpha, 1) if not is_alpha]
    if band is not None and band not in bands:
        raise InputError(f"{path}: has no band {band}; allowed: {', '.join(map(str, bands))}")
    if band is None and len(bands) != 1:
        raise InputError(
            f"{path}: has {len(bands)} bands ({_band_names(source, bands)}); say which to read "
            f"({argument('band')}; for a raster of thickness {argument('thickness_band')})"
        )
    chosen = bands[0] if band is None else band
    if source.colorinterp[chosen - 1].name == "palette":
        raise InputError(f"{path}: its values are palette colours: an image, not a raster")
    if np.dtype(source.dtypes[chosen - 1]).kind not in "iuf":
        raise InputError(f"{path}: holds {source.dtypes[chosen - 1]} values, which are not heights")
    if len(bands) > 1:
        title = _band_names(source, [chosen])
        issue_note(f"{path.name}: band {chosen} of {len(bands)} is read ({title})", InputNote)
    return chosen


def _band_names(source: Any, bands: list[int]) -> str:
    names = [
        f"{number}: {source.descriptions[number - 1] or source.dtypes[number - 1]}"
        for number in bands[:8]
    ]
    return quoted(", ".join(names))


def _check_size(source: Any, path: Path, band: int) -> None:
    """Refuse rasters that would fill the memory, before reading them."""
    if source.width * source.height > MAX_RASTER_CELLS:
        raise InputError(
            f"{path}: {source.width} columns and {source.height} rows; at most {MAX_RASTER_CELLS} "
            "cells are allowed; crop it first"
        )
    rows, columns = source.block_shapes[band - 1]
    together = source.count if source.interleaving.name == "pixel" else 1
    if (
        rows * columns * together * np.dtype(source.dtypes[band - 1]).itemsize
        > MAX_RASTER_BLOCK_BYTES
    ):
        raise InputError(
            f"{path}: blocks of {columns} columns, {rows} rows and {together} bands take more than "
            f"{MAX_RASTER_BLOCK_BYTES >> 20} MB; convert it: gdal_translate -co TILED=YES"
        )


def _facts(source: Any, band: int) -> BandFacts:
    at = band - 1
    system = "" if source.crs is None else source.crs.to_wkt()
    return BandFacts(
        source.scales[at], source.offsets[at], source.units[at] or "", source.nodatavals[at],
        tuple(source.transform), system,
    )  # fmt: skip


def _note_on_sidecar(
    path: Path, content: bytes, extra: dict[str, bytes], band: int, facts: BandFacts
) -> None:
    """Print a note on facts about a band that come from the file .aux.xml beside it."""
    if FACTS not in extra:
        return
    without = {name: data for name, data in extra.items() if name != FACTS}
    with _open_geotiff(path, content, without) as source:
        alone = _facts(source, band)
    changed = [name for name, a, b in zip(BandFacts._fields, facts, alone) if repr(a) != repr(b)]
    if changed:
        shown = [f"{name} {getattr(facts, name)}" for name in changed if name != "system"]
        shown += ["coordinate system"] if "system" in changed else []
        issue_note(
            f"{path.name}.aux.xml, beside the raster, gives its {quoted(', '.join(shown))}",
            InputNote,
        )


def _missing(source: Any, band: int) -> Booleans:
    """Return the cells that NODATA, an internal mask or an alpha band exclude."""
    missing: Booleans = source.read_masks(band) == 0
    for number, kind in enumerate(source.colorinterp, 1):
        if kind.name == "alpha":  # GDAL takes an alpha band as a mask only if it has whole numbers
            missing |= source.read(number) == 0
    return missing


def _factor(facts: BandFacts, metres_per_unit: Optional[float], path: Path) -> float:
    """Return the length in m of a band's unit, or, without one, of the map's unit of height."""
    own = metres_of(facts.unit, str(path)) if facts.unit.strip() else None
    if (
        own is not None
        and metres_per_unit is not None
        and not math.isclose(own, metres_per_unit, rel_tol=1e-5)
    ):
        raise InputError(
            f"{path}: its band is in {quoted(facts.unit)}, the heights of its coordinate system in "
            f"units of {metres_per_unit:.6g} m; correct one of them (gdal_edit.py -units)"
        )
    return own or metres_per_unit or 1.0


def _in_metres(values: Any, facts: BandFacts, factor: float, path: Path) -> Floats:
    """Return a band's values in metres, from its numbers."""
    scale, offset = facts.scale, facts.offset
    if not (math.isfinite(scale) and math.isfinite(offset)) or scale == 0:
        raise InputError(
            f"{path}: a scale of {scale:g} and an offset of {offset:g} are not allowed"
        )
    heights: Floats = values.astype(np.float64)
    if (scale, offset) != (1.0, 0.0):
        heights *= scale
        heights += offset
        issue_note(f"{path.name}: its numbers were multiplied by {scale:.10g}"
             + (f", and {offset:.10g} added" if offset else ""),
    InputNote,
)  # fmt: skip
    if factor != 1.0:
        heights *= factor
        issue_note(
            f"{path.name}: its values were converted to metres; one unit is {factor:.10g} m",
            InputNote,
        )
    return heights


def _place_on_map(
    heights: Floats, transform: Any, system: str, numbers: str, path: Path, has_points: bool
) -> PlacedHeights:
    """Return heights with their position on the map, the southernmost row first."""
    if transform.is_identity:
        how = "; gdalwarp makes a map of its control points" if has_points else ""
        raise InputError(f"{path}: has no position on the map{how}")
    square = math.isclose(transform.a, abs(transform.e), rel_tol=1e-6)
    if transform.b or transform.d or transform.a <= 0 or not square:
        raise InputError(f"{path}: not on square cells with north up; resample it first (gdalwarp)")
    cell = float(transform.a)
    south = transform.f if transform.e > 0 else transform.f - len(heights) * cell
    rows = heights if transform.e > 0 else heights[::-1]
    _check_finite(rows, path)
    return PlacedHeights(rows, transform.c + 0.5 * cell, south + 0.5 * cell, cell, system, numbers)


def _check_finite(heights: Floats, path: Path) -> None:
    if np.isinf(heights).any():
        row, column = np.argwhere(np.isinf(heights))[0]
        raise InputError(
            f"{path}: a height that is not finite, {column} cells from the west and {row} from "
            "the south"
        )
