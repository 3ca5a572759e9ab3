"""Rasters of results: ESRI ASCII grids, or compressed GeoTIFF."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

import numpy as np

from snowshed.base.arguments import checked
from snowshed.base.extras import require
from snowshed.base.paths import PathLike
from snowshed.io.atomic import replacing
from snowshed.io.coordinates.systems import system_of, write_prj
from snowshed.io.raster.raster import Raster, write_ascii_grid

#: Formats of the maps of results.
MapFormat = Literal["ascii", "geotiff"]
#: Endings of their files.
ENDINGS: Mapping[str, str] = {"ascii": ".asc", "geotiff": ".tif"}
TILE = 256  # cells along the sides of the tiles of a GeoTIFF; smaller rasters have strips


@checked
def write_raster(path: PathLike, raster: Raster) -> None:
    """Write a raster with its coordinate system, as GeoTIFF or ASCII grid by the name's suffix.

    A GeoTIFF is compressed without loss (deflate), in double precision, with NaN as NODATA. An
    ASCII grid has nine digits, and its coordinate system in a .prj beside it.

    Raises
    ------
    InputError
        If a GeoTIFF is requested and rasterio is missing.
    OSError
        If a file cannot be written.
    """
    file = Path(path)
    if file.suffix.lower() in (".tif", ".tiff"):
        _write_geotiff(file, raster)
        return
    write_ascii_grid(file, raster)
    write_prj(file, raster.crs)


def _write_geotiff(file: Path, raster: Raster) -> None:
    rasterio: Any = require("rasterio", "terrain", "writing a GeoTIFF")
    rows, columns = raster.heights.shape
    north = raster.north + (rows - 0.5) * raster.cell
    transform = rasterio.transform.from_origin(
        raster.east - 0.5 * raster.cell, north, raster.cell, raster.cell
    )
    options: dict[str, Any] = {
        "height": rows,
        "width": columns,
        "count": 1,
        "dtype": "float64",
        "crs": system_of(raster.crs),
        "transform": transform,
        "nodata": np.nan,
        "compress": "deflate",
        "predictor": 3,  # bytes of floating-point numbers, sorted by their place
    }
    if min(rows, columns) >= TILE:
        options.update(tiled=True, blockxsize=TILE, blockysize=TILE)
    with replacing(file) as beside, rasterio.open(beside, "w", driver="GTiff", **options) as target:
        target.write(raster.heights[::-1], 1)
