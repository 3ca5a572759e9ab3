"""Figures of chapter 3: bars of S, fixation lines with envelopes, Sobol bars, Morris's plane."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib import colormaps
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from snowshed.analysis.sensitivity.single_parameter import STANDARD_ERRORS_95
from snowshed.analysis.sensitivity.stored import TARGETS
from snowshed.base.arrays import Floats
from snowshed.plot.figure_style import COLOURS, FAINT, INK, STYLE, blank_figure, headline
from snowshed.scene.labels import label
from snowshed.study.factors import SEED

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

BARS_SHARE = 0.8  # share of a group's width that its bars fill
FIRST_SHADE, LAST_SHADE = 0.3, 0.85  # part of the colour map that is legible on white


def local_index_figure(table: pd.DataFrame) -> Figure:
    """Draw S per parameter, one bar per event, as Figure 3.3.1, with the noise of the seeding.

    Parameters
    ----------
    table
        From `local_index`.
    """
    events, parameters = _unique(table, "event"), _unique(table, "parameter")
    has_errors = bool(table["standard_error"].notna().any())
    with matplotlib.rc_context(STYLE):
        figure = blank_figure(8.4, 6.2)
        headline(figure, "Single-parameter sensitivity index S")
        for axes, target in zip(figure.subplots(2, 1, sharex=True), TARGETS):
            for number, (event, colour) in enumerate(zip(events, _shades(len(events)))):
                rows = _select(table, parameters, target=target, event=event)
                _draw_indices(axes, rows, number, len(events), colour)
            axes.axhline(0, color=INK, linewidth=0.8)
            axes.grid(axis="x", visible=False)
            axes.set(title=f"stack {target}", ylabel="S")
            axes.set_xticks(range(len(parameters)), [_pair_label(table, p) for p in parameters])
        keys: list[Any] = [
            Patch(color=colour, label=f"event {event}")
            for event, colour in zip(events, _shades(len(events)))
        ]
        keys += [Line2D([], [], color=INK, label="95 % by seeding noise")] if has_errors else []
        keys += [Patch(fill=False, ec=FAINT, label="not distinct from 0")] if has_errors else []
        figure.legend(handles=keys, loc="outside lower center", ncols=len(keys))
    return figure


def _draw_indices(axes: Axes, rows: pd.DataFrame, number: int, events: int, colour: Any) -> None:
    """Draw the bars of one event, the `number`-th of `events`; hollow if noise could cause them."""
    width = BARS_SHARE / events
    positions = _bar_positions(len(rows), events, number)
    for position, (_, row) in zip(positions, rows.iterrows()):
        doubtful = row["distinct"] is not None and not row["distinct"]
        fill = "white" if doubtful else colour
        axes.bar(position, row["s"], width, color=fill, edgecolor=colour, linewidth=1.2)
        if np.isfinite(row["standard_error"]):
            half = STANDARD_ERRORS_95 * row["standard_error"]
            axes.errorbar(position, row["s"], half, color=INK, linewidth=1, capsize=2)


def _pair_label(table: pd.DataFrame, parameter: str) -> str:
    row = table[table["parameter"] == parameter].iloc[0]
    parameter_label = label(parameter)
    return f"{parameter_label.symbol}\n{parameter_label.change(row['nominal'], row['altered'])}"


def fixation_figure(table: pd.DataFrame, group: str) -> Figure:
    """Draw mean and envelope of the rescaled stack against each parameter: Figures 3.4.1 to 3.4.4.

    Parameters
    ----------
    table
        From `fixation_table`.
    group
        The group of parameters to draw.
    """
    table = table[table["group"] == group]
    parameters, events = _unique(table, "parameter"), _unique(table, "event")
    with matplotlib.rc_context(STYLE):
        figure = blank_figure(1.4 + 2.7 * len(parameters), 6.2)
        headline(figure, f"Single-parameter fixation, {group} parameters")
        grid = figure.subplots(2, len(parameters), sharey="row", sharex="col", squeeze=False)
        for row, target in zip(grid, TARGETS):
            for axes, parameter in zip(row, parameters):
                lines = table[(table["target"] == target) & (table["parameter"] == parameter)]
                _draw_lines(axes, lines, events)
            row[0].set_ylabel(f"{target}, rescaled")
        for axes, parameter in zip(grid[-1], parameters):
            axes.set_xlabel(label(parameter).axis)
        colours = _shades(len(events))
        keys: list[Any] = [
            Line2D([], [], color=colour, marker="o", label=f"event {event}")
            for event, colour in zip(events, colours)
        ]
        keys.append(Patch(color=FAINT, alpha=0.25, label="± 1 standard deviation"))
        if table["noise"].notna().any():
            keys.append(Line2D([], [], color=INK, marker="_", label="± seeding noise of one point"))
        figure.legend(handles=keys, loc="outside lower center", ncols=-(-len(keys) // 2))
    return figure


def _draw_lines(axes: Axes, lines: pd.DataFrame, events: Sequence[int]) -> None:
    """Draw a line with its envelope for each event, and the noise beside its end."""
    for event, colour in zip(events, _shades(len(events))):
        rows = lines[lines["event"] == event].sort_values("value")
        x = rows["value"].to_numpy(float) / label(str(rows["parameter"].iloc[0])).scale
        mean, deviation = rows["mean"].to_numpy(float), rows["deviation"].to_numpy(float)
        axes.fill_between(x, mean - deviation, mean + deviation, color=colour, alpha=0.2, lw=0)
        axes.plot(x, mean, "o-", color=colour, markersize=4, linewidth=1.6)
        axes.errorbar(
            x, mean, rows["noise"].to_numpy(float), fmt="none", ecolor=INK, elinewidth=1, capsize=3
        )
    axes.margins(x=0.06)


def sobol_figure(table: pd.DataFrame) -> Figure:
    """Draw first-order and total Sobol indices; the line is the share of the seeding.

    Parameters
    ----------
    table
        From `sobol_indices`.
    """
    events, parameters = _unique(table, "event"), _unique(table, "parameter")
    with matplotlib.rc_context(STYLE):
        figure = blank_figure(1.4 + 2.6 * len(events), 6.0)
        headline(figure, "Sobol indices: shares of the variance of the stack")
        grid = figure.subplots(2, len(events), sharey=True, sharex=True, squeeze=False)
        for row, target in zip(grid, TARGETS):
            for axes, event in zip(row, events):
                rows = _select(table, parameters, target=target, event=event)
                _draw_shares(axes, rows, parameters)
                axes.set_title(f"{target}, event {event}")
            row[0].set_ylabel("index")
        keys: list[Any] = [
            Patch(color=COLOURS[0], label="first order (alone)"),
            Patch(color=COLOURS[1], label="total (with interactions)"),
            Line2D([], [], color=INK, label="95 % by bootstrap"),
        ]
        keys += [_noise_key()] if SEED in parameters else []
        figure.legend(handles=keys, loc="outside lower center", ncols=2)
    return figure


def _draw_shares(axes: Axes, rows: pd.DataFrame, parameters: Sequence[str]) -> None:
    for number, (kind, colour) in enumerate(zip(("first", "total"), COLOURS)):
        positions = _bar_positions(len(parameters), 2, number)
        axes.bar(positions, rows[kind], BARS_SHARE / 2, color=colour)
        interval = rows[f"{kind}_interval"]
        axes.errorbar(
            positions, rows[kind], interval, fmt="none", ecolor=INK, linewidth=1, capsize=2
        )
    if SEED in parameters:
        axes.axhline(float(rows["total"].iloc[parameters.index(SEED)]), **_noise_look())
    axes.axhline(0, color=INK, linewidth=0.8)
    low, high = axes.get_ylim()
    axes.set_ylim(max(low, -0.5), min(max(high, 1.0), 2.0))
    axes.grid(axis="x", visible=False)
    axes.set_xticks(range(len(parameters)), [label(path).symbol for path in parameters])


def morris_figure(table: pd.DataFrame) -> Figure:
    """Draw the strength of effects and their spread; the line is the effect of the seeding.

    Parameters
    ----------
    table
        From `morris_effects`.
    """
    events, parameters = _unique(table, "event"), _unique(table, "parameter")
    with matplotlib.rc_context(STYLE):
        figure = blank_figure(1.4 + 2.6 * len(events), 6.2)
        headline(figure, "Elementary effects, relative to the mean stack, per range of a parameter")
        grid = figure.subplots(2, len(events), sharey="row", sharex="row", squeeze=False)
        for row, target in zip(grid, TARGETS):
            for axes, event in zip(row, events):
                rows = _select(table, parameters, target=target, event=event)
                _draw_effects(axes, rows, parameters)
                axes.set_title(f"{target}, event {event}")
                axes.set_xlabel("mean strength μ*")
            row[0].set_ylabel("spread (standard deviation)")
            row[0].set(xlim=(0, None), ylim=(0, None))  # now that all of the row is drawn
        keys: list[Any] = [
            Line2D([], [], color=_colour(number, path), marker="o", ls="", label=label(path).symbol)
            for number, path in enumerate(parameters)
        ]
        keys.append(Line2D([], [], color=INK, label="95 % by bootstrap"))
        keys += [_noise_key()] if SEED in parameters else []
        figure.legend(handles=keys, loc="outside lower center", ncols=-(-len(keys) // 2))
    return figure


def _draw_effects(axes: Axes, rows: pd.DataFrame, parameters: Sequence[str]) -> None:
    for number, (path, (_, row)) in enumerate(zip(parameters, rows.iterrows())):
        axes.errorbar(
            row["strength"],
            row["spread"],
            xerr=row["strength_interval"],
            fmt="o",
            color=_colour(number, path),
            ecolor=INK,
            elinewidth=0.8,
            markersize=6,
        )
    if SEED in parameters:
        axes.axvline(float(rows["strength"].iloc[parameters.index(SEED)]), **_noise_look())


def _colour(number: int, path: str) -> str:
    return FAINT if path == SEED else COLOURS[number % len(COLOURS)]


def _noise_look() -> dict[str, Any]:
    return {"color": FAINT, "linewidth": 1.2, "linestyle": (0, (5, 3)), "zorder": 0}


def _noise_key() -> Line2D:
    look = _noise_look()
    return Line2D([], [], **look, label="seeding noise: smaller values are not significant")


def _unique(table: pd.DataFrame, column: str) -> list[Any]:
    return list(dict.fromkeys(table[column]))


def _select(
    table: pd.DataFrame, parameters: Sequence[str], *, target: str, event: int
) -> pd.DataFrame:
    rows = table[(table["target"] == target) & (table["event"] == event)]
    return rows.set_index("parameter").reindex(list(parameters))


def _bar_positions(groups: int, bars: int, number: int) -> Floats:
    """Return where the bars of one kind stand, in groups around 0, 1, 2, ..."""
    return np.asarray(np.arange(groups) + BARS_SHARE * ((number + 0.5) / bars - 0.5), dtype=float)


def _shades(count: int) -> list[Any]:
    return list(colormaps["viridis"](np.linspace(FIRST_SHADE, LAST_SHADE, count)))
