"""A hillside defined by formulas, for examples of slides."""

from __future__ import annotations

import math

import numpy as np

from snowshed.io.raster.raster import Raster


def hillside() -> Raster:
    """Return a hillside of up to 38 degrees that bends into a meadow of 6 degrees.

    It has a winding gully, spurs and hummocks, and falls towards the east.

    Examples
    --------
    >>> hillside().heights.shape
    (66, 106)
    """
    cell, columns, rows = 2.0, 106, 66
    x, y = np.meshgrid(np.arange(columns) * cell, np.arange(rows) * cell)
    steep, gentle = math.tan(math.radians(38.0)), math.tan(math.radians(6.0))
    begin, end = 70.0, 150.0  # ends of the bend between slope and meadow
    bend = np.clip(x, begin, end) - begin
    eased = (steep - gentle) * (np.minimum(x, begin) + bend - bend**2 / (2.0 * (end - begin)))
    upper = np.exp(-((np.maximum(x - 60.0, 0.0) / 70.0) ** 2))  # fades out towards the meadow
    middle = 62.0 + 9.0 * np.sin(x / 26.0) * np.clip(x / 80.0, 0.0, 1.0)
    gully = 4.5 * np.exp(-(((y - middle) / 15.0) ** 2)) * np.clip((x - 30.0) / 45.0, 0.0, 1.0)
    spurs = 2.2 * np.cos(y / 9.0 + 0.5 * np.sin(x / 30.0)) * np.clip(np.abs(y - 60.0) / 40.0, 0, 1)
    hummocks = (
        0.35 * np.sin(x / 5.1 + 0.8 * np.sin(y / 11.0))
        + 0.3 * np.sin(y / 4.3 + 1.1 * np.sin(x / 13.0))
        + 0.25 * np.sin((x + y) / 6.7) * np.cos((x - 2.0 * y) / 9.1)
    )
    height = 1450.0 - gentle * x - eased - upper * gully + upper * spurs + 0.7 * hummocks
    return Raster(height, 0.0, 0.0, cell)
