"""Figures that no other command draws: growth in the laboratory, and stacks over panels."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from snowshed.plot.figure_style import (
    COLOURS,
    FIRST_SHADE,
    LAST_SHADE,
    STYLE,
    blank_figure,
    headline,
)

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

GROWTH_LABELS = {
    "head": "head, m from the panel's centre",
    "tail": "tail, m from the panel's centre",
    "length": "length, m",
    "height": "height, m",
}
INPUT_LABELS = {
    "panel_length": "panel length, m",
    "panel_height": "panel height, m",
    "panel_tilt": "panel tilt, °",
}
TARGET_LABELS = {"ratio": "H/L", "height": "stack height, m", "length": "stack length, m"}


def growth_figure(rows: pd.DataFrame) -> Figure:
    """Draw head, tail, length and height against the event: Figures 2.4.1 to 2.4.4.

    Parameters
    ----------
    rows
        ``dimension``, ``tilt``, ``friction``, ``seed``, ``event`` and the measures, m. Bars are
        the deviation between seedings.
    """
    keys = ["dimension", "tilt", "friction"]
    styles = {group: _line_style(group, rows) for group in rows.groupby(keys).groups}
    with matplotlib.rc_context(STYLE):
        figure = blank_figure(8.4, 6.4)
        headline(figure, "The laboratory's stacks, simulated")
        for axes, (column, label) in zip(
            figure.subplots(2, 2, sharex=True).flat, GROWTH_LABELS.items()
        ):
            for group, runs in rows.groupby(keys):
                at = runs.groupby("event")[column].agg(["mean", "std"])
                axes.errorbar(
                    at.index, at["mean"], at["std"], capsize=2, markersize=4, **styles[group]
                )
            axes.set(ylabel=label, ylim=(0, 1.08 * rows[column].max()))
            axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        for axes in figure.axes[2:]:
            axes.set_xlabel("event")
        handles = [Line2D([], [], **style) for style in styles.values()]
        figure.legend(handles=handles, loc="outside lower center", ncols=4)
    return figure


def _line_style(group: Any, rows: pd.DataFrame) -> dict[str, Any]:
    """Return colour by tilt, line by dimension, marker by friction, and the words for them."""
    dimension, tilt, friction = group
    tilts, frictions = sorted(rows["tilt"].unique()), sorted(rows["friction"].unique())
    text = f"{dimension:g}D, {tilt:g}°"
    text += f", friction {friction:g}" if len(frictions) > 1 else ""
    return {
        "color": COLOURS[tilts.index(tilt)],
        "linestyle": "-" if dimension == 3 else "--",
        "marker": "os^vD"[frictions.index(friction) % 5],
        "markerfacecolor": COLOURS[tilts.index(tilt)] if dimension == 3 else "white",
        "label": text,
    }


def geometry_figure(table: pd.DataFrame) -> Figure:
    """Draw the stack against each input of the panel, the others at the reference: Figure 5.1.1.

    Parameters
    ----------
    table
        See `reproductions.frischholz2023.claims.geometry`; the reference is the panel nearest to
        2 m, 2 m and 40 degrees.
    """
    reference = _reference(table)
    events = sorted(table["event"].unique())
    shades = matplotlib.colormaps["viridis"](np.linspace(FIRST_SHADE, LAST_SHADE, len(events)))
    with matplotlib.rc_context(STYLE):
        figure = blank_figure(9.2, 7.4)
        headline(
            figure,
            f"Stacks while one input of the panel varies; the others: {_size_text(reference)}",
        )
        grid = figure.subplots(3, 3, sharex="row", squeeze=False)
        for row, (varied, label) in zip(grid, INPUT_LABELS.items()):
            rows = _at(table, {name: reference[name] for name in INPUT_LABELS if name != varied})
            for axes, (target, name) in zip(row, TARGET_LABELS.items()):
                _draw(axes, rows, varied, target, events, shades)
                axes.set(xlabel=label, ylabel=name, ylim=(0, 1.08 * rows[target].max()))
        keys = [
            Line2D([], [], color=shade, marker="o", markersize=4, label=f"event {event:g}")
            for shade, event in zip(shades, events)
        ]
        figure.legend(handles=keys, loc="outside lower center", ncols=len(keys))
    return figure


def _draw(
    axes: Axes, rows: pd.DataFrame, varied: str, target: str, events: list[Any], shades: Any
) -> None:
    for event, shade in zip(events, shades):
        means = rows[rows["event"] == event].groupby(varied)[target].mean()
        axes.plot(means.index, means, "o-", color=shade, markersize=3.5, linewidth=1.2)


def _reference(table: pd.DataFrame) -> dict[str, float]:
    wanted = {"panel_length": 2.0, "panel_height": 2.0, "panel_tilt": 40.0}
    panels = table[list(wanted)].drop_duplicates()
    target = np.array(list(wanted.values()))
    distances = ((panels.to_numpy(float) / target - 1) ** 2).sum(axis=1)
    nearest = panels.iloc[int(np.argmin(distances))]
    return {name: float(nearest[name]) for name in wanted}


def _size_text(reference: dict[str, float]) -> str:
    length, height, tilt = (reference[name] for name in INPUT_LABELS)
    return f"length {length:g} m, height {height:g} m, tilt {tilt:g}°"


def _at(table: pd.DataFrame, values: dict[str, float]) -> pd.DataFrame:
    for name, value in values.items():
        table = table[np.isclose(table[name], value)]
    return table
