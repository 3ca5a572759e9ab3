"""Pictures of a run: the stack from the side, and its growth from event to event."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Optional

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

import snowshed._core as _core
from snowshed.base.arrays import Booleans, Floats
from snowshed.base.core_simulation import AnySimulation, core_of
from snowshed.methods.registry import resolution_of
from snowshed.plot.caption import mean_damping_rate, scene_caption
from snowshed.plot.figure_style import (
    BODY,
    FAINT,
    FIRST_SHADE,
    GRID,
    INK,
    LAST_SHADE,
    STACK,
    blank_figure,
    describe,
    mute_frame,
)
from snowshed.snow.stack.measure import Extent, StackMeasure, levelled_positions
from snowshed.snow.stack.quantities import QUANTITIES

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

HELD = "#b8c0c8"  # snow that the panel or a structure holds
MAX_NAMED_EVENTS = 15  # events in a legend
ROWS = 8  # rows of a legend
MAX_PICTURED_PARTICLES = 100_000  # of more, every second, third, ... is drawn
WIDTH = 9.0  # inches, of the figure
VIEW_WIDTH = 8.1  # inches, of the views in it
MIN_VIEW_HEIGHT, MAX_VIEW_HEIGHT = 1.6, 5.0  # inches, of a view

Limits = tuple[float, float, float, float]  # left, right, bottom, top


def stack_figure(
    simulation: AnySimulation, stack: StackMeasure, scene: Mapping[str, Any]
) -> Figure:
    """Draw the stack from the side: above with the panel it came from, below enlarged.

    Particles are coloured by the event that brought them; the outline, the panel and the ground
    are lines. In either view both axes are to the same scale, in metres. Where chunks have rolled
    so far that the stack could not be seen, the largest connected body is shown and measured.

    Parameters
    ----------
    simulation
        A `snowshed.Simulation`.
    stack
        The measure of the simulation's stack.
    scene
        The data of the complete scene.
    """
    simulation = core_of(simulation)
    tilt, frame = simulation.ground_tilt_deg, simulation.panel_frame()
    level_ground = scene.get("ground") is not None
    views = [_filling(x) for x in (_scene_limits(stack, tilt, frame), _stack_limits(stack, tilt))]
    heights = [VIEW_WIDTH * _steepness(view) for view in views]
    figure = blank_figure(WIDTH, sum(heights) + 1.9)
    overview, enlarged = figure.subplots(2, 1, height_ratios=heights)
    for axes, view in zip((overview, enlarged), views):
        axes.set(xlim=view[:2], ylim=view[2:], aspect="equal", ylabel="z, m")
        mute_frame(axes)
        if level_ground:
            _draw_ground(axes, tilt)
        _draw_obstacles(axes, simulation)
        _draw_particles(axes, simulation, stack.members, _spacing(scene))
        _draw_scale(axes)
    if frame is not None:
        _draw_panel(overview, frame, tilt, measured=level_ground)
    _draw_measures(enlarged, stack, tilt)
    _name_events(overview, simulation, apart=not stack.members.all())
    enlarged.set_xlabel("x from the panel's centre, m" if frame is not None else "x, m")
    title = f"Stack after event {simulation.event}, from the side"
    if stack.mass == 0.0:
        title += ": no snow has come down"
    if _pictured_extent(stack) is stack.body:
        title += f": its largest body; 97 % of the snow lies within {stack.length:.2f} m"
    _caption(figure, scene, title, simulation.damping_rate_per_s)
    return figure


def named_events(count: int) -> list[int]:
    """Return the events that a legend names: all, or of many some with the first and the last.

    Examples
    --------
    >>> named_events(3), named_events(100)[:2], named_events(100)[-1]
    ([1, 2, 3], [1, 8], 100)
    """
    return sorted({round(i) for i in np.linspace(1, count, min(count, MAX_NAMED_EVENTS))})


def growth_figure(table: pd.DataFrame, scene: Mapping[str, Any]) -> Figure:
    """Draw height, length, head and tail against the event; dashed: the largest connected body.

    Parameters
    ----------
    table
        The table of events, as in ``events.csv``.
    scene
        The data of the complete scene, for the caption.
    """
    figure = blank_figure(WIDTH, 6.6)
    for axes, name in zip(np.ravel(figure.subplots(2, 2, sharex=True)), QUANTITIES):
        stack, body = table[f"{name}_m"], table[f"body_{name}_m"]
        axes.plot(table["event"], stack, "o-", color=STACK, linewidth=2, label="stack (97 %)")
        axes.plot(table["event"], body, "s--", color=BODY, markersize=4, label="largest body")
        where = ", from the panel's centre" if name in ("head", "tail") else ""
        axes.set_title(f"{name}, m{where}", loc="left", color=INK, fontsize=11)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.margins(y=0.12)
        if name in ("height", "length"):
            axes.set_ylim(0.0, 1.15 * max(stack.max(), body.max()) or 1.0)
        else:
            axes.set_xlabel("event")
        axes.grid(color=GRID, linewidth=0.8)
        mute_frame(axes)
    figure.axes[0].legend(frameon=False, fontsize=9, loc="lower right")
    _caption(figure, scene, "Growth of the stack", mean_damping_rate(table))
    return figure


def _caption(
    figure: Figure, scene: Mapping[str, Any], title: str, damping_rate: Optional[float]
) -> None:
    describe(figure, f"{title}\n{scene_caption(scene, damping_rate)}")


def _shades(count: int) -> list[Any]:
    return list(colormaps["viridis"](np.linspace(FIRST_SHADE, LAST_SHADE, count)))


def _draw_particles(
    axes: Axes, simulation: _core.Simulation, stack: Booleans, spacing: float
) -> None:
    """Draw particles in their size, the nearest in front.

    Particles that something holds do not belong to the stack and are grey.
    """
    positions, events = simulation.positions(), simulation.events()
    if len(positions) == 0:
        return
    every = 1 + len(positions) // MAX_PICTURED_PARTICLES
    shown = np.arange(0, len(positions), every)
    shown = shown[np.argsort(-positions[shown, 1], kind="stable")]
    count = int(events.max())
    colours = np.array(_shades(count))[np.clip(events[shown], 1, count) - 1]
    colours[~stack[shown]] = to_rgba(HELD)
    diameter = _points_per_metre(axes) * spacing
    size = float(np.clip(every * (0.8 * diameter) ** 2, 0.6, 60.0))
    x, _, z = positions[shown].T
    axes.scatter(x, z, s=size, c=colours, linewidths=0, rasterized=True, zorder=3)


def _spacing(scene: Mapping[str, Any]) -> float:
    """Return the mean distance of particles after seeding, m."""
    count: float = scene.get("seeding", {}).get("particles_per_voxel", 1.0)
    return float(resolution_of(scene) / count ** (1 / scene["dimension"]))


def _points_per_metre(axes: Axes) -> float:
    """Return the approximate scale of a view, points per metre."""
    left, right = axes.get_xlim()
    return VIEW_WIDTH * 72 / (right - left)


def _name_events(axes: Axes, simulation: _core.Simulation, *, apart: bool) -> None:
    """Draw a legend of the events in free space, at the upper right."""
    count = max(simulation.event, 1)
    shades = _shades(count)
    named = [(f"event {i}", shades[i - 1]) for i in named_events(count)]
    if apart:
        named.append(("not in the stack", HELD))
    axes.legend(
        handles=[
            Line2D([], [], marker="o", linestyle="", color=colour, label=name)
            for name, colour in named
        ],
        frameon=False,
        fontsize=9,
        loc="upper right",
        ncols=1 + (len(named) - 1) // ROWS,
    )


def _draw_ground(axes: Axes, tilt: float) -> None:
    left, right = axes.get_xlim()
    span = right - left
    x = np.array([left - span, right + span])
    z = -x * np.tan(np.radians(tilt))
    view = axes.axis()
    axes.plot(x, z, color=FAINT, linewidth=1.2, zorder=1)
    axes.fill_between(x, z, z.min() - span, color="#eef1f4", linewidth=0, zorder=0)
    axes.axis(view)


def _draw_obstacles(axes: Axes, simulation: _core.Simulation) -> None:
    """Draw the section of the scene's obstacles at y = 0."""
    x = np.linspace(*axes.get_xlim(), 600)
    z = np.linspace(*axes.get_ylim(), 400)
    points = np.stack(np.meshgrid(x, 0.0, z, indexing="ij"), axis=-1).reshape(-1, 3)
    distance = simulation.obstacle_distance(points).reshape(len(x), len(z)).T
    if distance.min() < 0 < distance.max() < np.inf:
        axes.contourf(x, z, distance, [-np.inf, 0.0], colors=["#c9d1d8"], zorder=1)
        axes.contour(x, z, distance, [0.0], colors=[FAINT], linewidths=1.2, zorder=2)


def _draw_panel(axes: Axes, frame: dict[str, Any], tilt: float, *, measured: bool) -> None:
    """Draw the panel's face, and the height of its lower edge above the ground if `measured`."""
    upper, lower = _panel_ends(frame)
    axes.plot(*zip(upper, lower), color=INK, linewidth=3.5, solid_capstyle="round", zorder=2)
    if not measured:
        return
    foot = np.array([lower[0], -lower[0] * np.tan(np.radians(tilt))])
    axes.plot(*zip(lower, foot), color=FAINT, linewidth=1.0, linestyle=(0, (4, 3)), zorder=2)
    axes.annotate(
        f"{lower[1] - foot[1]:g} m",
        (lower + foot) / 2,
        (-5, 0),
        textcoords="offset points",
        ha="right",
        va="center",
        color=INK,
        fontsize=9,
    )


def _draw_measures(axes: Axes, stack: StackMeasure, tilt: float) -> None:
    """Draw the outline, and height and length as dimension lines along the ground."""
    if len(stack.outline) == 0:
        return
    shown = _pictured_extent(stack)
    axes.plot(*_tilted(_profile(shown), tilt).T, color=INK, linewidth=1.3, zorder=5)
    _dimension_line(axes, _length_ends(shown), tilt, f"length {shown.length:.3f} m", above=False)
    foot = _ground_at_crest(shown)
    crest = np.array([[shown.crest, foot], [shown.crest, foot + shown.height]])
    _dimension_line(axes, crest, tilt, f"height {shown.height:.3f} m", above=True)


def _pictured_extent(stack: StackMeasure) -> Extent:
    """Return the stack, or its largest body if that would be too small to see."""
    return stack.body if stack.length > 2 * stack.body.length > 0 else stack


def _length_ends(shown: Extent) -> Floats:
    """Return the ends of the dimension line of the length, on levelled ground."""
    below = shown.ground.min(initial=0.0) - 0.03 * max(shown.length, 4 * shown.height)
    return np.array([[shown.head, below], [shown.tail, below]])


def _frame(shown: Extent) -> Floats:
    """Return the points that the plot of the stack must show, on levelled ground."""
    top = _ground_at_crest(shown) + shown.height
    return np.vstack([_length_ends(shown), [[shown.crest, top]], _profile(shown)])


def _profile(shown: Extent) -> Floats:
    """Return the surface of the snow (k, 2), on levelled ground."""
    profile: Floats = shown.outline + np.column_stack([0.0 * shown.ground, shown.ground])
    return profile


def _ground_at_crest(shown: Extent) -> float:
    """Return z of the ground below the highest snow, on levelled ground."""
    return float(np.interp(shown.crest, shown.outline[:, 0], shown.ground))


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
    """Draw a bar of a round length, about an eighth of the width, at the lower left."""
    left, right = axes.get_xlim()
    length = _round_down((right - left) / 8)
    across = axes.get_xaxis_transform()  # x in metres, z as a share of the height
    start, level = left + 0.02 * (right - left), 0.05
    bar: dict[str, Any] = {"color": INK, "linewidth": 3, "solid_capstyle": "butt", "zorder": 6}
    axes.plot([start, start + length], [level] * 2, transform=across, scalex=False, **bar)
    label = f"{length:g} m" if length >= 1 else f"{100 * length:g} cm"
    axes.annotate(
        label,
        (start + length, level),
        (5, 0),
        xycoords=across,
        textcoords="offset points",
        va="center",
        fontsize=9,
        color=INK,
    )


def _round_down(value: float) -> float:
    """Return the largest of 1, 2 or 5 times a power of ten that is not above `value`."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(max(m * power for m in (1, 2, 5) if m * power <= value * (1 + 1e-9)))


def _tilted(points: Floats, tilt: float) -> Floats:
    """Turn points (x, z) from levelled ground back to the tilted ground."""
    x, z = points.T
    return levelled_positions(np.column_stack([x, 0 * x, z]), -tilt)[:, [0, 2]]


def _panel_ends(frame: dict[str, Any]) -> tuple[Floats, Floats]:
    center, slope = np.asarray(frame["center"]), np.asarray(frame["slope"])
    half = 0.5 * frame["length"] * slope
    return (center - half)[[0, 2]], (center + half)[[0, 2]]


def _steepness(limits: Limits) -> float:
    left, right, bottom, top = limits
    return (top - bottom) / (right - left)


def _filling(limits: Limits) -> Limits:
    """Widen limits to the right and upward until they fill a view."""
    left, right, bottom, top = limits
    right = left + max(right - left, (top - bottom) * VIEW_WIDTH / MAX_VIEW_HEIGHT)
    top = bottom + max(top - bottom, (right - left) * MIN_VIEW_HEIGHT / VIEW_WIDTH)
    return left, right, bottom, top


def _stack_limits(stack: StackMeasure, tilt: float) -> Limits:
    """Return a close view of the stack and its dimension lines."""
    if len(stack.outline) == 0:
        return 0.0, 1.0, -0.1, 0.3
    return _around(_tilted(_frame(_pictured_extent(stack)), tilt), 0.1)


def _scene_limits(stack: StackMeasure, tilt: float, frame: dict[str, Any] | None) -> Limits:
    """Return a view of the panel, the ground below it and the stack."""
    points = [np.zeros((1, 2))]
    if len(stack.outline):
        points.append(_tilted(_frame(_pictured_extent(stack)), tilt))
    if frame is not None:
        ends = np.array(_panel_ends(frame))
        points += [ends, ends * [1, 0] - ends[:, :1] * [0, np.tan(np.radians(tilt))]]
    return _around(np.concatenate(points), 0.1)


def _around(points: Floats, margin: float) -> Limits:
    """Return limits around points, with a share of their larger extent as margin."""
    low, high = points.min(axis=0), points.max(axis=0)
    gap = margin * float(max(high - low)) or margin
    return low[0] - gap, high[0] + gap, low[1] - gap, high[1] + gap
