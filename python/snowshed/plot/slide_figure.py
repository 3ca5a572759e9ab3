"""The map of a slide."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from snowshed.methods.slide.maps import SlideMaps
from snowshed.plot.figure_style import INK, STYLE, blank_figure
from snowshed.plot.slide_objects import SlopeObject, draw_objects
from snowshed.plot.terrain_map import (
    Outline,
    coordinates,
    draw_outlines,
    draw_terrain,
    draw_values,
    focus,
    panel_size,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MIN_SHOWN_THICKNESS = 0.01  # m of snow
#: Available maps: name, label, colours.
PEAKS = {
    "peak_speed": ("peak speed, m/s", "YlOrRd"),
    "peak_thickness": ("peak thickness, m", "YlGnBu"),
    "peak_pressure": ("peak pressure, kPa", "PuRd"),
}


def slide_figure(
    maps: SlideMaps,
    outlines: Sequence[Outline],
    quantity: str = "peak_speed",
    area: float = 45.0,
    objects: Sequence[SlopeObject] = (),
) -> Figure:
    """Return the map of a slide: hillshade, contours, a peak value, and the release areas.

    Parameters
    ----------
    maps
        The maps (`snowshed.methods.slide.maps.slide_maps`).
    outlines
        Corners of the release areas, in map coordinates, m.
    quantity
        Name in `PEAKS`.
    area
        Area of the figure's map, square inches.
    objects
        Areas of later snow, forest and dams on the slope.
    """
    from matplotlib import rc_context

    label, colours = PEAKS[quantity]
    ground = maps.raster(maps.terrain)
    snow = maps.peak_thickness > MIN_SHOWN_THICKNESS
    part = focus(ground, snow, [*outlines, *(each.corners for each in objects)])
    width, height = panel_size(part, area)
    with rc_context(STYLE):
        figure = blank_figure(width + 1.5, height + 0.9)
        axes = figure.subplots()
        draw_terrain(axes, ground, part)
        values = np.where(snow, getattr(maps, quantity), np.nan)
        drawn = draw_values(axes, ground, values, cmap=colours, vmin=0.0)
        draw_outlines(axes, outlines)
        draw_objects(axes, objects)
        axes.contour(
            *coordinates(ground), maps.thickness, levels=[MIN_SHOWN_THICKNESS], colors=[INK],
            linewidths=1.2, linestyles="--", zorder=5,
        )  # fmt: skip
        axes.plot([], [], "--", color=INK, lw=1.2, label="snow at the end")
        figure.colorbar(drawn, ax=axes, label=label, shrink=0.9, pad=0.01)
        axes.set(xlabel="east, m", ylabel="north, m")
        axes.set_title(f"{label.partition(',')[0].capitalize()} of the slide", pad=8)
        axes.legend(loc="upper left", frameon=True, framealpha=0.9, edgecolor="none")
    return figure
