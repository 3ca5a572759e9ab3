"""The map of a slide."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.colors import LightSource

from snowshed.io.arrays import Floats
from snowshed.methods.slide_maps import SlideMaps
from snowshed.plot.figure_style import INK, STYLE, blank

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LEAST_SHOWN = 0.01  # m of snow


def slide_figure(maps: SlideMaps, outlines: Sequence[Sequence[Sequence[float]]]) -> Figure:
    """Return the map of a slide: hillshade, contours, peak speed, and what was released.

    Parameters
    ----------
    maps
        The maps (`snowshed.run.slides.slide_maps`).
    outlines
        Corners of the release areas, in map coordinates, m.
    """
    from matplotlib import rc_context

    rows, columns = maps.terrain.shape
    width, length = (columns - 1) * maps.cell, (rows - 1) * maps.cell
    shown_width = float(np.clip(7.5 * np.sqrt(width / length), 4.5, 10.0))
    with rc_context(STYLE):
        figure = blank(shown_width + 1.6, shown_width * length / width + 0.9)
        axes = figure.subplots()
        _draw_terrain(axes, maps)
        speed = np.where(maps.peak_thickness > LEAST_SHOWN, maps.peak_speed, np.nan)
        drawn = axes.imshow(
            speed,
            origin="lower",
            extent=_extent(maps),
            cmap="YlOrRd",
            alpha=0.85,
            vmin=0.0,
            zorder=3,
        )
        for number, outline in enumerate(outlines):
            ring = np.array([*outline, outline[0]])
            label = "release" if number == 0 else None
            axes.plot(ring[:, 0], ring[:, 1], color="#1f4e79", lw=1.6, zorder=5, label=label)
        axes.contour(
            *_coordinates(maps), maps.thickness, levels=[LEAST_SHOWN], colors=[INK],
            linewidths=1.2, linestyles="--", zorder=5,
        )  # fmt: skip
        axes.plot([], [], "--", color=INK, lw=1.2, label="snow at the end")
        figure.colorbar(drawn, ax=axes, label="peak speed, m/s", shrink=0.9, pad=0.01)
        axes.set(xlabel="east, m", ylabel="north, m", aspect="equal")
        axes.set_title("Peak speed of the slide", pad=8)
        axes.legend(loc="upper left", frameon=True, framealpha=0.9, edgecolor="none")
        axes.grid(False)
    return figure


def _extent(maps: SlideMaps) -> tuple[float, float, float, float]:
    rows, columns = maps.terrain.shape
    half = 0.5 * maps.cell
    return (
        maps.west - half,
        maps.west + columns * maps.cell - half,
        maps.south - half,
        maps.south + rows * maps.cell - half,
    )


def _coordinates(maps: SlideMaps) -> tuple[Floats, Floats]:
    rows, columns = maps.terrain.shape
    east: Floats = maps.west + maps.cell * np.arange(columns, dtype=np.float64)
    north: Floats = maps.south + maps.cell * np.arange(rows, dtype=np.float64)
    return east, north


def _draw_terrain(axes: Axes, maps: SlideMaps) -> None:
    """Draw a light hillshade, on which colours stay readable, and labelled contours."""
    shade = LightSource(azdeg=315, altdeg=45).hillshade(
        maps.terrain[::-1], vert_exag=1.0, dx=maps.cell, dy=maps.cell
    )[::-1]
    axes.imshow(
        0.72 + 0.28 * shade, origin="lower", extent=_extent(maps), cmap="gray", vmin=0.0, vmax=1.0
    )
    known = maps.terrain[~np.isnan(maps.terrain)]
    interval = _contour_interval(float(known.max() - known.min()))
    levels = np.arange(np.ceil(known.min() / interval), np.floor(known.max() / interval) + 1)
    lines = axes.contour(
        *_coordinates(maps), maps.terrain, levels=levels * interval, colors=["#5b6b78"],
        linewidths=0.6, zorder=2,
    )  # fmt: skip
    axes.clabel(lines, fmt="%.0f", fontsize=7, colors=["#3c4a55"])


def _contour_interval(drop: float) -> float:
    """Return a round interval that gives about ten contours, m."""
    for interval in (0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0):
        if drop / interval <= 12.0:
            return interval
    return 500.0
