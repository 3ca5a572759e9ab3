"""Pictures of a run: the stack from the side, and its growth from event to event."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import colormaps
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from snowshed import _core
from snowshed.arrays import Floats
from snowshed.atomic import replacing
from snowshed.stack import StackMeasure, level

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

PICTURED_PARTICLES = 100_000  # at most; a regular choice of them beyond
INK, FAINT, STACK, BODY = "#22303c", "#8a97a3", "#2b6a8f", "#c8553d"
MEASURES = ("height", "length", "head", "tail")
FIRST, LAST = 0.08, 0.86  # part of the colour map that reads well on white


def save(figure: Figure, path: Path, *, dpi: int = 160) -> None:
    """Write a figure to a file, whole or not at all."""
    with replacing(path) as beside:
        figure.savefig(beside, dpi=dpi)


def stack_figure(simulation: _core.Simulation, stack: StackMeasure) -> Figure:
    """Draw the stack from the side.

    Particles are coloured by the event that brought them; the outline, the panel and the ground
    are lines. Both axes are to the same scale, in metres.

    Parameters
    ----------
    simulation
        Gives the particles, the panel and the tilt of the ground.
    stack
        The measure of the same particles.
    """
    tilt = simulation.ground_tilt_deg
    frame = simulation.panel_frame()
    limits = _limits(stack, tilt, frame)
    shape = (limits[3] - limits[2]) / (limits[1] - limits[0])
    figure, axes = _blank_figure(9.0, float(np.clip(8.0 * shape + 0.8, 3.0, 9.0)))
    _draw_ground(axes, limits[0], limits[1], tilt)
    if frame is not None:
        start, end = _panel_ends(frame)
        axes.plot(*zip(start, end), color=INK, linewidth=3.5, solid_capstyle="round", zorder=4)
    _draw_particles(axes, simulation)
    _draw_measures(axes, stack, tilt)
    axes.set(xlim=limits[:2], ylim=limits[2:], aspect="equal")
    axes.set(xlabel="x from the panel's centre, m", ylabel="z, m")
    _draw_scale(axes)
    return figure


def growth_figure(table: pd.DataFrame) -> Figure:
    """Draw height, length, head and tail against the event; dashed: the largest connected body.

    Parameters
    ----------
    table
        The table of events, as in ``events.csv``.
    """
    figure = Figure(figsize=(9.0, 6.0), layout="constrained")
    FigureCanvasAgg(figure)
    for axes, name in zip(np.ravel(figure.subplots(2, 2, sharex=True)), MEASURES):
        stack, body = table[f"{name}_m"], table[f"body_{name}_m"]
        axes.plot(table["event"], stack, "o-", color=STACK, linewidth=2, label="stack (97 %)")
        axes.plot(table["event"], body, "s--", color=BODY, markersize=4, label="largest body")
        axes.set_title(f"{name}, m", loc="left", color=INK, fontsize=11)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.margins(y=0.12)
        if name in ("height", "length"):
            axes.update_datalim([(table["event"].iloc[0], 0.0)])
            axes.autoscale_view()
            axes.set_ylim(bottom=0.0)
        else:
            axes.set_xlabel("event")
        axes.grid(color="#e6eaee", linewidth=0.8)
        _quiet(axes)
    figure.axes[0].legend(frameon=False, fontsize=9)
    return figure


def _blank_figure(width: float, height: float) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    _quiet(axes)
    return figure, axes


def _quiet(axes: Axes) -> None:
    axes.spines[["top", "right"]].set_visible(False)
    axes.spines[["left", "bottom"]].set_color(FAINT)
    axes.tick_params(colors=INK, labelsize=9)
    axes.set_axisbelow(True)


def _shades(count: int) -> list[Any]:
    return list(colormaps["viridis"](np.linspace(FIRST, LAST, count)))


def _draw_particles(axes: Axes, simulation: _core.Simulation) -> None:
    """Draw every particle, those that lie nearest in front, and name the events."""
    positions, events = simulation.positions(), simulation.events()
    if len(positions) == 0:
        return
    shown = np.arange(0, len(positions), 1 + len(positions) // PICTURED_PARTICLES)
    shown = shown[np.argsort(-positions[shown, 1], kind="stable")]
    count = int(events.max())
    shades = np.array(_shades(count))
    x, _, z = positions[shown].T
    size = float(np.clip(4e4 / len(shown), 1.0, 14.0))
    colours = shades[np.clip(events[shown], 1, count) - 1]
    axes.scatter(x, z, s=size, c=colours, linewidths=0, rasterized=True, zorder=3)
    every = range(1, count + 1, 1 + (count - 1) // 8)
    axes.legend(
        handles=[
            Line2D([], [], marker="o", linestyle="", color=shades[i - 1], label=f"event {i}")
            for i in every
        ],
        frameon=False,
        fontsize=9,
        loc="upper right",
    )


def _draw_ground(axes: Axes, left: float, right: float, tilt: float) -> None:
    x = np.array([left, right])
    z = -x * np.tan(np.radians(tilt))
    axes.plot(x, z, color=FAINT, linewidth=1.2, zorder=1)
    axes.fill_between(x, z, z - (right - left), color="#eef1f4", linewidth=0, zorder=0)


def _draw_measures(axes: Axes, stack: StackMeasure, tilt: float) -> None:
    """Draw the outline, and height and length as dimension lines along the ground."""
    if len(stack.outline) == 0:
        return
    axes.plot(*_tilted(stack.outline, tilt).T, color=INK, linewidth=1.3, zorder=5)
    _dimension_line(axes, _length_ends(stack), tilt, f"length {stack.length:.3f} m", above=False)
    crest = np.array([[stack.crest, 0.0], [stack.crest, stack.height]])
    _dimension_line(axes, crest, tilt, f"height {stack.height:.3f} m", above=True)


def _length_ends(stack: StackMeasure) -> Floats:
    """Return where the dimension line of the length goes, on levelled ground."""
    below = -0.045 * max(stack.length, 4 * stack.height)
    return np.array([[stack.head, below], [stack.tail, below]])


def _dimension_line(axes: Axes, ends: Floats, tilt: float, label: str, *, above: bool) -> None:
    start, end = _tilted(ends, tilt)
    arrow = {"arrowstyle": "<->", "color": BODY, "shrinkA": 0, "shrinkB": 0, "linewidth": 1.3}
    axes.annotate("", end, start, arrowprops=arrow, zorder=6)
    anchor = end if above else (start + end) / 2
    axes.annotate(
        label,
        anchor,
        (0, 6 if above else -6),
        textcoords="offset points",
        ha="center",
        va="bottom" if above else "top",
        color=BODY,
        fontsize=10,
        zorder=7,
    )


def _draw_scale(axes: Axes) -> None:
    """Draw a bar of a round length, about a sixth of the width, at the lower left."""
    left, right = axes.get_xlim()
    bottom, top = axes.get_ylim()
    length = _round_down((right - left) / 6)
    x, z = left + 0.03 * (right - left), bottom + 0.05 * (top - bottom)
    axes.plot([x, x + length], [z, z], color=INK, linewidth=3, solid_capstyle="butt", zorder=6)
    label = f"{length:g} m" if length >= 1 else f"{100 * length:g} cm"
    axes.text(x + length / 2, z, label + "\n", ha="center", va="center", fontsize=9, color=INK)


def _round_down(value: float) -> float:
    """Return the largest of 1, 2 or 5 times a power of ten that is not above `value`."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(max(m * power for m in (1, 2, 5) if m * power <= value * (1 + 1e-9)))


def _tilted(points: Floats, tilt: float) -> Floats:
    """Turn (x, z) from levelled ground back to where it is."""
    x, z = points.T
    return level(np.column_stack([x, 0 * x, z]), -tilt)[:, [0, 2]]


def _panel_ends(frame: dict[str, Any]) -> tuple[Floats, Floats]:
    center, slope = np.asarray(frame["center"]), np.asarray(frame["slope"])
    half = 0.5 * frame["length"] * slope
    return (center - half)[[0, 2]], (center + half)[[0, 2]]


def _limits(
    stack: StackMeasure, tilt: float, frame: dict[str, Any] | None
) -> tuple[float, float, float, float]:
    """Return what is shown, left to right and bottom to top: the panel and the stack."""
    points = [np.zeros((1, 2))]
    if len(stack.outline):
        points += [_tilted(stack.outline, tilt), _tilted(_length_ends(stack), tilt)]
    if frame is not None:
        points.append(np.array(_panel_ends(frame)))
    low, high = np.concatenate(points).min(axis=0), np.concatenate(points).max(axis=0)
    margin = 0.1 * float(max(high - low)) or 0.1
    return low[0] - margin, high[0] + margin, low[1] - 0.8 * margin, high[1] + margin
