"""The forces on obstacles: over time, and the pressures on their faces."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib import rc_context
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from snowshed.plot.caption import scene_caption
from snowshed.plot.figure_style import COLOURS, FAINT, INK, STYLE, blank_figure, describe

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

WIDTH = 9.0  # inches
MAX_DIAGRAMS = 6
#: Obstacles whose largest force is a smaller share of the largest of all are not drawn.
MIN_SHARE = 1e-4
#: Pressures are drawn as the thickness of a band on the face, up to this share of the picture.
BAND = 0.12


def forces_figure(forces: xarray.Dataset, scene: Mapping[str, Any]) -> Figure:
    """Draw the force on each obstacle over time, in a diagram each: its components, and its norm.

    Parameters
    ----------
    forces
        As from `Results.forces`, of obstacles alone.
    scene
        Complete scene data, as in scene.json.
    """
    two = scene.get("dimension") == 2
    largest = {
        str(name): float(np.linalg.norm(forces.force.sel(obstacle=name), axis=-1).max(initial=0.0))
        for name in forces.obstacle.to_numpy()
    }
    most = max(largest.values(), default=0.0)
    drawn = [name for name, force in largest.items() if force > MIN_SHARE * most][:MAX_DIAGRAMS]
    scale, unit = (1e3, "kN") if most >= 1e3 else (1.0, "N")
    with rc_context(STYLE):
        figure = blank_figure(WIDTH, 1.1 + 1.9 * max(len(drawn), 1))
        diagrams = figure.subplots(max(len(drawn), 1), 1, sharex=True, squeeze=False)[:, 0]
        for axes, name in zip(diagrams, drawn):
            _draw_force(axes, forces, name, scale, two=two)
            axes.set_title(name)
            axes.set_ylabel(f"force, {unit}{'/m' if two else ''}")
        diagrams[0].legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
        diagrams[-1].set_xlabel("time through all events, s")
        duration = float(forces.duration.median()) if forces.duration.size else 0.0
        describe(
            figure,
            f"Forces of the snow on what it meets, means over {1000 * duration:.3g} ms\n"
            f"{scene_caption(dict(scene))}",
        )
    return figure


def _draw_force(axes: Axes, forces: xarray.Dataset, name: str, scale: float, *, two: bool) -> None:
    of_obstacle = forces.force.sel(obstacle=name)
    ends = forces.time.to_numpy()
    times = np.repeat(ends, 2)
    times[::2] -= forces.duration.to_numpy()
    components = {
        "down": -of_obstacle.sel(component="z"),
        "along x": of_obstacle.sel(component="x"),
    }
    if not two:
        components["along y"] = of_obstacle.sel(component="y")
    for colour, (label, values) in zip(COLOURS, components.items()):
        axes.plot(times, np.repeat(values.to_numpy() / scale, 2), color=colour, lw=1.3, label=label)
    events = forces.event.to_numpy()
    for begun in ends[1:][np.diff(events) > 0]:
        axes.axvline(begun, color=FAINT, lw=0.6, ls=":", zorder=0)


def pressures_figure(pressures: Mapping[str, Any], scene: Mapping[str, Any]) -> Figure:
    """Draw the pressures on faces in the plane y = 0: at their largest, and at rest.

    The band on a face is as thick as the pressure on it is large.

    Parameters
    ----------
    pressures
        As from `Results.pressures`, of a scene in 2D.
    scene
        Complete scene data, as in scene.json.
    """
    corners = np.asarray(pressures["corners"])[:, :, [0, 2]]
    kinds = {"Largest mean over 10 ms": "peak_pressure", "At rest": "rest_pressure"}
    with rc_context(STYLE):
        span = np.ptp(corners.reshape(-1, 2), axis=0) if len(corners) else np.ones(2)
        ratio = float(np.clip((span[1] + 0.2 * span[0]) / max(span[0], 1e-9), 0.25, 1.0))
        figure = blank_figure(WIDTH, 1.0 + 2 * (0.6 + ratio * (WIDTH - 1.5)) * 0.75)
        for axes, (title, name) in zip(figure.subplots(2, 1, sharex=True), kinds.items()):
            _draw_pressures(axes, corners, np.maximum(pressures[name], 0.0), float(max(span)))
            axes.set_title(title)
            axes.set_ylabel("z, m")
        axes.set_xlabel("x, m")
        describe(figure, f"Pressures of the snow on faces\n{scene_caption(dict(scene))}")
    return figure


def _draw_pressures(axes: Axes, corners: Any, values: Any, size: float) -> None:
    most = float(values.max(initial=0.0))
    axes.set_aspect("equal")
    axes.add_collection(LineCollection(list(corners), colors=INK, linewidths=1.0))
    along = corners[:, 1] - corners[:, 0]
    normal = np.stack([-along[:, 1], along[:, 0]], axis=1)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    normal *= np.where(normal[:, 1:] < 0.0, -1.0, 1.0)
    thickness = BAND * size * values / max(most, 1e-12)
    for (start, end), out, band in zip(corners, normal, thickness):
        if band > 0.0:
            axes.fill(
                *np.array([start, end, end + band * out, start + band * out]).T,
                color=COLOURS[0],
                alpha=0.75,
                linewidth=0,
            )
    axes.autoscale_view()
    axes.text(
        0.99,
        0.97,
        f"thickest band: {most / 1000:.3g} kPa",
        transform=axes.transAxes,
        ha="right",
        va="top",
        color=INK,
        fontsize=9,
    )
