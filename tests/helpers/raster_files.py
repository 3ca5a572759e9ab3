"""Rasters for tests: GeoTIFFs and ESRI ASCII grids of a slope."""

import numpy as np

SIDE, CELL = 12, 5.0
WEST, NORTH = 500_000.0, 6_700_060.0
#: Elevations, m, northernmost row first: a slope of 16.7 degrees that falls to the east.
SLOPE = 900.0 - 0.3 * CELL * np.arange(SIDE)[None, :] - 0.02 * np.arange(SIDE)[:, None]


def write_geotiff(path, bands=SLOPE, dtype="float64", change=None, **options):
    """Write a GeoTIFF of one or several bands; `change` gets the open file."""
    import rasterio

    bands = np.asarray(bands)
    bands = bands if bands.ndim == 3 else bands[None]
    profile = {
        "driver": "GTiff", "count": len(bands), "height": bands.shape[1], "width": bands.shape[2],
        "dtype": dtype, "crs": "EPSG:25833",
        "transform": rasterio.Affine(CELL, 0, WEST, 0, -CELL, NORTH),
    }  # fmt: skip
    with rasterio.open(path, "w", **{**profile, **options}) as file:
        file.write(bands.astype(dtype))
        if change is not None:
            change(file)
    return path


def scaled(scale, offset=0.0):
    """Return a change that declares a scale and an offset."""

    def declare(file):
        file.scales, file.offsets = (scale,) * file.count, (offset,) * file.count

    return declare


def in_unit(unit):
    """Return a change that declares a unit of all bands."""

    def declare(file):
        file.units = (unit,) * file.count

    return declare


def grid_text(values=SLOPE, header="", **changed):
    """Return an ESRI ASCII grid as text; `changed` replaces entries of the header."""
    entries = {
        "ncols": values.shape[1], "nrows": values.shape[0], "xllcorner": WEST,
        "yllcorner": NORTH - CELL * values.shape[0], "cellsize": CELL, **changed,
    }  # fmt: skip
    lines = [f"{key} {value}" for key, value in entries.items() if value is not None]
    lines += [header] if header else []
    return "\n".join([*lines, *(" ".join(f"{z:.3f}" for z in row) for row in values)]) + "\n"
