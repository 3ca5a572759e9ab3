"""The figure of a comparison of loading tests."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np

from snowshed.analysis.grains.ratios import STRESSES
from snowshed.analysis.grains.variants import BASE
from snowshed.plot.figure_style import COLOURS, FAINT, INK, NOISE, STYLE, blank_figure, headline

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MAX_RATIO = 1e4  # largest ratio that is drawn


def sensitivity_figure(comparison: pd.DataFrame, title: str = "") -> Figure:
    """Draw the stresses of each variant over those of the base, with their 95 % intervals.

    Parameters
    ----------
    comparison
        From `compare_variants`.
    title
        Title of the snow.
    """
    names = [name for name in dict.fromkeys(comparison["variant"]) if name != BASE]
    varied = list(dict.fromkeys(comparison["varied"]))
    base = comparison[comparison["variant"] == BASE].set_index("stress")
    reached = set(base.index[np.isfinite(base["value_pa"])])  # before the tests end
    stresses = [name for name in STRESSES if name in reached]
    with matplotlib.rc_context(STYLE):
        figure = blank_figure(11.0, 1.6 + 0.3 * max(len(names), 4))
        headline(
            figure,
            (f"{title}: " if title else "")
            + "ratio of the stress to the base; bars: 95 % interval from the scatter between "
            "samples; hollow: may be no effect",
        )
        grid = figure.subplots(1, len(stresses), sharey=True, squeeze=False)[0]
        for axes, stress in zip(grid, stresses):
            rows = comparison[comparison["stress"] == stress].set_index("variant")
            for place, name in enumerate(names):
                colour = COLOURS[varied.index(rows.loc[name, "varied"]) % len(COLOURS)]
                _draw(axes, place, rows.loc[name], colour)
            _finish(axes, base.loc[stress], f"{STRESSES[stress]}")
        grid[0].set_yticks(range(len(names)), names)
        grid[0].set_ylim(len(names) - 0.4, -0.6)
    return figure


def _draw(axes: Axes, place: int, row: Any, colour: str) -> None:
    ratio = float(row["ratio"])
    if not np.isfinite(ratio):
        axes.text(1.0, place, " no stress", va="center", fontsize=9, color=FAINT)
        return
    low, high = float(row["low"]), float(row["high"])
    if np.isfinite(low):
        axes.plot(
            [max(low, 1 / MAX_RATIO), min(high, MAX_RATIO)], [place] * 2, color=colour, lw=1.6
        )
    filled = colour if row["distinct"] is not False else "white"
    axes.plot([ratio], [place], "o", color=colour, markerfacecolor=filled, markersize=5)


def _finish(axes: Axes, base: Any, title: str) -> None:
    scatter = float(base["scatter"])
    if np.isfinite(scatter):
        axes.axvspan(np.exp(-scatter), np.exp(scatter), color=NOISE, alpha=0.5, lw=0, zorder=0)
    axes.axvline(1.0, color=INK, lw=0.8)
    axes.set_xscale("log")
    low, high = axes.get_xlim()
    axes.set_xlim(max(min(low, 0.4), 1 / MAX_RATIO), min(max(high, 2.5), MAX_RATIO))
    value = float(base["value_pa"])
    unit, size = ("MPa", 1e6) if value >= 1e6 else ("kPa", 1e3)
    axes.set_title(f"{title}\nbase {value / size:.3g} {unit}")
    axes.set_xlabel("ratio (grey: scatter between samples)")
