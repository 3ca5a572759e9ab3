"""Terrain on other cells, by GDAL's cubic resampling. It needs the extra snowshed[terrain]."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from snowshed._core import InputError
from snowshed.base.extras import require
from snowshed.base.limits import MAX_RASTER_CELLS
from snowshed.base.paths import PathLike
from snowshed.io.raster.raster import Raster, read_raster

#: Any map in metres, because GDAL needs one for resampling.
SOME_MAP = "EPSG:31287"


def resampled_raster(path: PathLike, cell: float) -> Raster:
    """Return a file of elevations on other cells, as AvaFrame 2.1 resamples them.

    The new grid has the same south-west node and does not exceed the grid of the file. If the new
    cells are larger, GDAL's cubic resampling widens its kernel, so that it averages.

    Parameters
    ----------
    path
        An ESRI ASCII grid or a GeoTIFF.
    cell
        Size of the new cells [m].

    Raises
    ------
    InputError
        If the file is not such a raster, rasterio is missing, or the new grid has too many cells.
    """
    # GDAL reads numbers of text files in single precision; so does AvaFrame with resampled ones.
    single = Path(path).suffix.lower() not in (".tif", ".tiff")
    return resampled(read_raster(path), cell, single=single)


def resampled(old: Raster, cell: float, *, single: bool = False) -> Raster:
    """Return a raster on other cells, as `resampled_raster` does.

    Parameters
    ----------
    old
        The raster.
    cell
        Size of the new cells [m].
    single
        Whether the values are in single precision.

    Raises
    ------
    InputError
        If the size is not above 0, rasterio is missing, or the new grid has too many cells.
    """
    if not 0.0 < cell < math.inf:
        raise InputError(f"cell: {cell:g} m; allowed: finite numbers above 0")
    rows, columns = old.heights.shape
    new_rows, new_columns = (
        int(min((size - 1) * old.cell / cell, MAX_RASTER_CELLS) + 1) for size in (rows, columns)
    )
    if new_columns * new_rows > MAX_RASTER_CELLS:
        raise InputError(
            f"{old.name}: has more than {MAX_RASTER_CELLS} cells of {cell:g} m; crop it first"
        )
    rasterio: Any = require("rasterio", "terrain", "resampling terrain")
    warp: Any = require("rasterio.warp", "terrain", "resampling terrain")
    precision = np.float32 if single else np.float64
    values = np.full((new_rows, new_columns), np.nan)
    warp.reproject(
        source=old.heights[::-1].astype(precision),
        destination=values,
        src_transform=_transform(rasterio, old.east, old.north, rows, old.cell),
        dst_transform=_transform(rasterio, old.east, old.north, new_rows, cell),
        src_crs=SOME_MAP,
        dst_crs=SOME_MAP,
        src_nodata=np.nan,
        dst_nodata=np.nan,
        resampling=warp.Resampling.cubic,
    )
    values = values[::-1].astype(precision).astype(np.float64)
    return Raster(values, old.east, old.north, cell, old.name, old.crs)


def _transform(rasterio: Any, west: float, south: float, rows: int, cell: float) -> Any:
    north = south - cell / 2.0 + rows * cell
    return rasterio.transform.from_origin(west - cell / 2.0, north, cell, cell)
