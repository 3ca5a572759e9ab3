"""Maps of terrain: hillshade, contours, overlays, and the part to show."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.colors import LightSource

from snowshed.base.arguments import checked
from snowshed.base.arrays import Booleans, Floats
from snowshed.io.raster.raster import Raster

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.image import AxesImage

Outline = Sequence[Sequence[float]]
Extent = tuple[float, float, float, float]

RELEASE = "#1f4e79"
MARGIN = 0.18  # margin on either side, relative to the shown part
CONTOURS = 12  # at most
HILLSHADE = ((315.0, 0.6), (225.0, 0.25), (45.0, 0.15))  # azimuths of the light, degrees, and share


def extent(ground: Raster) -> Extent:
    """Return the map coordinates of the outer edges of the cells: west, east, south, north, m."""
    rows, columns = ground.heights.shape
    half = 0.5 * ground.cell
    return (
        ground.east - half,
        ground.east + columns * ground.cell - half,
        ground.north - half,
        ground.north + rows * ground.cell - half,
    )


def coordinates(ground: Raster) -> tuple[Floats, Floats]:
    """Return the map coordinates of columns and rows, m."""
    rows, columns = ground.heights.shape
    east: Floats = ground.east + ground.cell * np.arange(columns, dtype=np.float64)
    north: Floats = ground.north + ground.cell * np.arange(rows, dtype=np.float64)
    return east, north


@checked
def focus(ground: Raster, shown: Booleans, outlines: Sequence[Outline]) -> Extent:
    """Return the part of a terrain around a shown area and outlines, with a margin."""
    west, east, south, north = extent(ground)
    rows, columns = np.nonzero(shown)
    x = np.concatenate([ground.east + columns * ground.cell, *(_column(o, 0) for o in outlines)])
    y = np.concatenate([ground.north + rows * ground.cell, *(_column(o, 1) for o in outlines)])
    if not x.size:
        return west, east, south, north
    margin = MARGIN * max(float(np.ptp(x)), float(np.ptp(y))) + ground.cell
    return (
        max(west, x.min() - margin),
        min(east, x.max() + margin),
        max(south, y.min() - margin),
        min(north, y.max() + margin),
    )


def panel_size(part: Extent, area: float = 45.0) -> tuple[float, float]:
    """Return width and height of a map in inches, of about this many square inches."""
    ratio = (part[1] - part[0]) / (part[3] - part[2])
    width = float(np.clip(np.sqrt(area * ratio), 4.0, 11.0))
    return width, width / ratio


@checked
def draw_terrain(axes: Axes, ground: Raster, part: Extent, *, labels: bool = True) -> None:
    """Draw a light hillshade, on which colours stay readable, and contours."""
    ground = _cropped(ground, part)
    shade = sum(
        share * LightSource(azimuth, 40.0).hillshade(
            ground.heights[::-1], vert_exag=1.0, dx=ground.cell, dy=ground.cell
        )
        for azimuth, share in HILLSHADE
    )  # fmt: skip
    axes.imshow(
        0.55 + 0.45 * np.asarray(shade)[::-1], origin="lower", extent=extent(ground), cmap="gray",
        vmin=0.0, vmax=1.0, interpolation="bilinear",
    )  # fmt: skip
    interval, levels = _levels(ground)
    strong = np.isclose(levels % (5.0 * interval), 0.0)
    lines = axes.contour(
        *coordinates(ground), ground.heights, levels=levels, colors=["#5b6b78"],
        linewidths=np.where(strong, 1.0, 0.5).tolist(), zorder=2,
    )  # fmt: skip
    if labels:
        axes.clabel(lines, fmt="%.0f", fontsize=9, colors=["#3c4a55"])
    axes.set(xlim=part[:2], ylim=part[2:], aspect="equal")
    axes.grid(False)


def draw_values(axes: Axes, ground: Raster, values: Floats, **look: Any) -> AxesImage:
    """Draw values over the terrain except cells of NaN; `look` is passed on to imshow."""
    drawn: dict[str, Any] = {"alpha": 0.86, "zorder": 3, "interpolation": "nearest", **look}
    return axes.imshow(values, origin="lower", extent=extent(ground), **drawn)


@checked
def draw_outlines(axes: Axes, outlines: Sequence[Outline], label: str = "release") -> None:
    """Draw the outlines of areas."""
    for number, outline in enumerate(outlines):
        ring = np.array([*outline, outline[0]])
        name = label if number == 0 else None
        axes.plot(ring[:, 0], ring[:, 1], color="white", lw=3.0, zorder=5, alpha=0.7)
        axes.plot(ring[:, 0], ring[:, 1], color=RELEASE, lw=1.6, zorder=6, label=name)


def _column(outline: Outline, axis: int) -> Floats:
    column: Floats = np.asarray(outline, dtype=np.float64)[:, axis]
    return column


def _cropped(ground: Raster, part: Extent) -> Raster:
    """Return a part of a terrain with a border of one cell, if the terrain extends so far."""
    rows, columns = ground.heights.shape
    left = max(0, int((part[0] - ground.east) / ground.cell) - 1)
    bottom = max(0, int((part[2] - ground.north) / ground.cell) - 1)
    right = min(columns, int((part[1] - ground.east) / ground.cell) + 3)
    top = min(rows, int((part[3] - ground.north) / ground.cell) + 3)
    return replace(
        ground,
        heights=ground.heights[bottom:top, left:right],
        east=ground.east + left * ground.cell,
        north=ground.north + bottom * ground.cell,
    )


def _levels(ground: Raster) -> tuple[float, Floats]:
    """Return a round interval and the contours at it that a terrain shows."""
    elevations = ground.heights[~np.isnan(ground.heights)]
    low, high = float(elevations.min()), float(elevations.max())
    rounded = (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0)
    interval = next((step for step in rounded if (high - low) / step <= CONTOURS), 1000.0)
    return interval, interval * np.arange(np.ceil(low / interval), np.floor(high / interval) + 1)
