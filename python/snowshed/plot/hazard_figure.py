"""Maps of the probability that snow reaches a place, and of its intensity."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.io.raster.raster import Raster
from snowshed.plot.figure_style import INK, STYLE, blank_figure
from snowshed.plot.terrain_map import (
    Extent,
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

ROW_WIDTH = 11.5  # width of maps side by side, inches
LEVELS = (0.05, 0.5, 0.95)  # probabilities whose lines are drawn
VALUES = {"thickness": "YlGnBu", "speed": "YlOrRd", "pressure": "PuRd"}


def part_shown(ground: Raster, probability: Floats, outlines: Sequence[Outline]) -> Extent:
    """Return the part of the terrain that snow may reach, with a margin."""
    return focus(ground, probability > 0.0, outlines)


def probability_figure(
    ground: Raster,
    probability: Floats,
    outlines: Sequence[Outline],
    part: Extent,
    *,
    label: str,
    area: float = 45.0,
) -> Figure:
    """Return the map of a probability, with the lines of `LEVELS`.

    Parameters
    ----------
    ground
        The terrain.
    probability : (rows, columns)
        0 to 1, on the terrain's grid.
    outlines
        Corners of the release areas, in map coordinates, m.
    part
        The part to show (`part_shown`).
    label
        Description of the event whose probability is shown.
    area
        Area of the figure's map, square inches.
    """
    from matplotlib import rc_context

    width, height = panel_size(part, area)
    with rc_context(STYLE):
        figure = blank_figure(width + 1.5, height + 0.9)
        axes = figure.subplots()
        draw_terrain(axes, ground, part)
        shown = np.where(probability > 0.0, probability, np.nan)
        drawn = draw_values(axes, ground, shown, cmap="plasma_r", vmin=0.0, vmax=1.0)
        levels = [level for level in LEVELS if probability.max() >= level > probability.min()]
        if levels:
            lines = axes.contour(
                *coordinates(ground), probability, levels=levels, colors=[INK],
                linewidths=1.0, zorder=4,
            )  # fmt: skip
            axes.clabel(lines, fmt=lambda level: f"{100 * level:.0f} %", fontsize=9)
        draw_outlines(axes, outlines)
        figure.colorbar(drawn, ax=axes, label="probability", shrink=0.9, pad=0.01)
        axes.set(xlabel="east, m", ylabel="north, m")
        axes.set_title(f"Probability of {label}", pad=8)
        axes.legend(loc="upper left", frameon=True, framealpha=0.9, edgecolor="none")
    return figure


def percentiles_figure(
    ground: Raster,
    values: Mapping[str, Floats],
    outlines: Sequence[Outline],
    part: Extent,
    *,
    titles: Mapping[str, str],
) -> Figure:
    """Return small maps side by side, one for each quantity; cells without snow stay empty.

    Parameters
    ----------
    ground, outlines, part
        As for `probability_figure`.
    values
        Maps by the names in `VALUES`.
    titles
        Title of each map, with its unit.
    """
    from matplotlib import rc_context

    ratio = (part[1] - part[0]) / (part[3] - part[2])
    width = (ROW_WIDTH - len(values)) / len(values)  # an inch for each bar of colours
    with rc_context(STYLE):
        figure = blank_figure(ROW_WIDTH, width / ratio + 0.5)
        panels = figure.subplots(1, len(values), squeeze=False).ravel()
        for axes, (quantity, raster) in zip(panels, values.items()):
            draw_terrain(axes, ground, part, labels=False)
            shown = np.where(raster > 0.0, raster, np.nan)
            drawn = draw_values(axes, ground, shown, cmap=VALUES[quantity], vmin=0.0)
            draw_outlines(axes, outlines)
            figure.colorbar(drawn, ax=axes, shrink=0.8, pad=0.02)
            axes.set_title(titles[quantity])
            axes.set(xticks=[], yticks=[])
    return figure
