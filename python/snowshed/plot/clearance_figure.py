"""Figures of the clearance answer: probability of burial over height, required height, causes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure

from snowshed.base.arrays import Floats
from snowshed.plot.figure_style import BODY, COLOURS, FAINT, INK, NOISE, STACK, STYLE, blank_figure

Band = tuple[float, float]
#: Label and colour of the parts of a height, from the ground up.
PARTS = {
    "cover": ("natural snow cover", COLOURS[5]),
    "pile": ("shed snow", COLOURS[4]),
    "margin": ("margin", NOISE),
}


def burial_figure(
    heights: Floats,
    buried: Floats,
    winters: Floats,
    levels: Sequence[tuple[float, float, float, float]],
) -> Figure:
    """Draw the probability that a winter's snow reaches the lower edge, over the edge's height.

    Parameters
    ----------
    heights : (n,)
        Heights of the edge, m.
    buried : (n, 3)
        Probability at each height, and its lower and upper bound.
    winters : (w,)
        The height that each winter of the record needed, m.
    levels
        Probability of staying clear, and the height with its lower and upper bound, m.
    """
    with rc_context(STYLE):
        figure = blank_figure(6.4, 3.6)
        axes = figure.subplots()
        middle, low, high = 100.0 * buried.T
        axes.fill_between(heights, low, high, color=STACK, alpha=0.15, linewidth=0.0)
        axes.plot(heights, middle, color=STACK, linewidth=2)
        ranks = np.arange(len(winters), 0, -1) / (len(winters) + 1.0)
        axes.plot(np.sort(winters), 100.0 * ranks, "o", color=INK, markersize=4)
        for probability, height, _, _ in levels:
            exceeded = 100.0 * (1.0 - probability)
            axes.plot(height, exceeded, "o", color=BODY)
            axes.annotate(
                f"{100 * probability:g} % clear: {height:.2f} m",
                (height, exceeded),
                (8, 5),
                textcoords="offset points",
                va="bottom",
                fontsize=9,
                color=INK,
            )
        axes.set(xlim=(0.0, heights[-1]), ylim=(0.0, 100.0))
        axes.set_xlabel("height of the lower edge above the ground, m")
        axes.set_title("Probability that a winter's snow reaches the edge, %")
        return figure


def parts_figure(bars: Mapping[str, Mapping[str, float]]) -> Figure:
    """Draw the parts of the height that a season needs.

    Parameters
    ----------
    bars
        For each season, by its label: depth of the natural "cover", height of the shed "pile" on
        it, and the "margin" to the edge, m.
    """
    with rc_context(STYLE):
        figure = blank_figure(6.4, 1.3 + 0.5 * len(bars))
        axes = figure.subplots()
        names = list(bars)[::-1]
        start = np.zeros(len(names))
        for part, (label, colour) in PARTS.items():
            lengths = np.array([bars[name][part] for name in names])
            axes.barh(names, lengths, left=start, color=colour, height=0.6, label=label)
            for place, (left, length) in enumerate(zip(start, lengths)):
                if length > 0.08 * max(sum(bar.values()) for bar in bars.values()):
                    axes.text(left + 0.5 * length, place, f"{length:.2f}", ha="center", va="center")
            start += lengths
        for place, total in enumerate(start):
            axes.annotate(
                f"{total:.2f} m", (total, place), (5, 0), textcoords="offset points", va="center"
            )
        axes.set_xlim(0.0, 1.15 * start.max())
        axes.grid(False)
        axes.set_xlabel("height above the ground, m")
        axes.set_title("Parts of the required height")
        figure.legend(loc="outside lower left", ncols=len(PARTS))
        return figure


def design_figure(
    designs: Sequence[tuple[float, float, float, Band]], probability: float
) -> Figure:
    """Draw the required height against slope length, a line for each tilt.

    If all panels have one slope length, their heights are drawn against the tilt.

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
        across, line = (1, 0) if len({design[0] for design in designs}) == 1 else (0, 1)
        labels = ("slope length {:g} m", "tilt {:g}°")
        for colour, value in zip(COLOURS * 9, sorted({design[line] for design in designs})):
            own = sorted(design for design in designs if design[line] == value)
            heights = np.array([design[2] for design in own])
            errors = np.abs(np.array([design[3] for design in own]).T - heights)
            axes.errorbar(
                [design[across] for design in own], heights, errors, fmt="o-", color=colour,
                capsize=3, label=labels[line].format(value),
            )  # fmt: skip
        axes.set_ylim(bottom=0.0)
        axes.set_xlabel(("slope length, m", "tilt, degrees")[across])
        axes.set_title(f"Height of the lower edge that stays clear in {100 * probability:g} %, m")
        axes.legend()
        return figure


def causes_figure(shares: Mapping[str, float]) -> Figure:
    """Draw the share of each cause in the uncertainty of the required height.

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
        axes.barh(names, parts, color=STACK, height=0.65)
        for place, part in enumerate(parts):
            axes.annotate(
                f"{part:.0f} %", (part, place), (4, 0), textcoords="offset points", va="center"
            )
        axes.set_xlim(0.0, 1.15 * max(parts))
        axes.grid(False)
        axes.spines["left"].set_color(FAINT)
        axes.set_title("Causes of the interval's width, %")
        return figure
