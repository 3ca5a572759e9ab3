"""Figures of the clearance answer: probability of burial over height, required height, causes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from snowshed.base.arrays import Floats
from snowshed.plot.figure_style import BODY, COLOURS, FAINT, INK, NOISE, STACK, STYLE, blank_figure

Band = tuple[float, float]


def burial_figure(required: Floats, levels: Sequence[tuple[float, float, float, float]]) -> Figure:
    """Draw the probability that a winter's snow reaches the lower edge, over the edge's height.

    Parameters
    ----------
    required : (n,)
        The height that each case needs, m.
    levels
        Probability of staying clear, and the height with its lower and upper bound, m.
    """
    with rc_context(STYLE):
        figure = blank_figure(6.4, 3.6)
        axes = figure.subplots()
        order = np.sort(required)
        steps = 100.0 * (1.0 - np.arange(1, len(order) + 1) / len(order))
        axes.step(
            np.append(0.0, order), np.append(100.0, steps), where="post", color=STACK, linewidth=2
        )
        for probability, height, low, high in levels:
            buried = 100.0 * (1.0 - probability)
            axes.plot([low, high], [buried] * 2, color=BODY, linewidth=1.5, alpha=0.7)
            axes.plot(height, buried, "o", color=BODY)
            axes.annotate(
                f"{100 * probability:g} % clear: {height:.2f} m",
                (high, buried),
                (6, 0),
                textcoords="offset points",
                va="center",
                fontsize=8.5,
                color=INK,
            )
        most = max(order[-1], *(level[3] for level in levels))
        axes.set(xlim=(0.0, 1.35 * most), ylim=(0.0, 100.0))
        axes.set_xlabel("height of the lower edge above the ground, m")
        axes.set_title("Probability that a winter's snow reaches the edge, %")
        return figure


def design_figure(
    designs: Sequence[tuple[float, float, float, Band]], probability: float
) -> Figure:
    """Draw the required height against slope length, a line for each tilt.

    Parameters
    ----------
    designs
        Slope length, m, tilt, degrees, required height, m, and its lower and upper bound.
    probability
        Share of winters in which the edge stays clear.
    """
    with rc_context(STYLE):
        figure = blank_figure(6.4, 3.6)
        axes = figure.subplots()
        for colour, tilt in zip(COLOURS * 9, sorted({design[1] for design in designs})):
            own = sorted(design for design in designs if design[1] == tilt)
            lengths, heights = (
                [design[0] for design in own],
                np.array([design[2] for design in own]),
            )
            bounds = np.array([design[3] for design in own]).T
            errors = np.abs(bounds - heights)
            axes.errorbar(
                lengths, heights, errors, fmt="o-", color=colour, capsize=3, label=f"tilt {tilt:g}°"
            )
        axes.set_ylim(bottom=0.0)
        axes.set_xlabel("slope length, m")
        axes.set_title(f"Height of the lower edge that stays clear in {100 * probability:g} %, m")
        axes.legend()
        return figure


def causes_figure(shares: Mapping[str, float]) -> Figure:
    """Draw the share of each cause in the variance of the required height.

    Parameters
    ----------
    shares
        Shares from 0 to 1 by the label of the cause.
    """
    with rc_context(STYLE):
        figure = blank_figure(6.4, 0.9 + 0.34 * len(shares))
        axes = figure.subplots()
        names = list(shares)[::-1]
        parts = [100.0 * shares[name] for name in names]
        colours = [NOISE if name.startswith("chance") else STACK for name in names]
        axes.barh(names, parts, color=colours, height=0.65)
        for place, part in enumerate(parts):
            axes.annotate(
                f"{part:.0f} %", (part, place), (4, 0), textcoords="offset points", va="center"
            )
        axes.set_xlim(0.0, 1.15 * max(parts))
        axes.grid(False)
        axes.spines["left"].set_color(FAINT)
        axes.set_title("Causes of the variance of the required height, %")
        return figure
