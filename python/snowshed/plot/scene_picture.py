"""A picture of a scene before it is run: its structures and its snow, from the side."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure

from snowshed._core import Simulation
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats
from snowshed.methods.registry import resolution_of
from snowshed.plot.caption import scene_caption
from snowshed.plot.figure_style import FAINT, INK, STACK, blank_figure, describe, mute_frame
from snowshed.scene.scene import SceneLike, resolve_scene

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Limits = tuple[float, float, float, float]  # left, right, bottom, top

WIDTH = 9.0  # inches
SAMPLES = (900, 500)  # of the obstacles, along x and z


@checked
def scene_figure(scene: SceneLike) -> Figure:
    """Draw a scene in the plane y = 0, with the snow of its first event in place.

    Parameters
    ----------
    scene
        Any scene that can run.

    Raises
    ------
    InputError
        If the scene is wrong.
    """
    resolved = resolve_scene(scene)
    simulation = Simulation(resolved.core, resolved.base_dir)
    simulation.begin_event()
    data = resolved.data
    left, right, bottom, top = _limits(simulation, data)
    figure = blank_figure(WIDTH, min(1.2 + (WIDTH - 1) * (top - bottom) / (right - left), 9.0))
    axes = figure.subplots()
    axes.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
    _draw_obstacles(axes, simulation)
    _draw_ground(axes, data, simulation.ground_tilt_deg)
    x, _, z = _near_section(simulation.positions(), data).T
    axes.scatter(
        x,
        z,
        s=_dot(data, right - left),
        color=STACK,
        linewidths=0,
        rasterized=True,
        zorder=3,
        label="snow",
    )
    _draw_panel(axes, simulation)
    axes.legend(frameon=False, fontsize=9, loc="upper right", markerscale=3)
    mute_frame(axes)
    axes.set_xlabel("x, m", color=INK, fontsize=9)
    axes.set_ylabel("z, m", color=INK, fontsize=9)
    describe(figure, scene_caption(data))
    return figure


def _limits(simulation: Simulation, scene: Mapping[str, Any]) -> Limits:
    """Return a view of the snow and its supports, with half their size as margin at the sides."""
    snow = simulation.positions()[:, [0, 2]]
    low, high = snow.min(axis=0), snow.max(axis=0)
    floor = min(float(low[1]), 0.0)
    room = 0.5 * max(float(high[0] - low[0]), float(high[1]) - floor)
    fall = np.tan(np.radians(simulation.ground_tilt_deg)) * (float(high[0]) + room)
    return (
        float(low[0]) - room,
        float(high[0]) + room,
        min(floor, -fall) - 0.2 * room - resolution_of(scene),
        float(high[1]) + 0.5 * room,
    )


def _draw_obstacles(axes: Axes, simulation: Simulation) -> None:
    x = np.linspace(*axes.get_xlim(), SAMPLES[0])
    z = np.linspace(*axes.get_ylim(), SAMPLES[1])
    points = np.stack(np.meshgrid(x, 0.0, z, indexing="ij"), axis=-1).reshape(-1, 3)
    distance = simulation.obstacle_distance(points).reshape(len(x), len(z)).T
    if distance.min() < 0 < distance.max() < np.inf:
        axes.contourf(x, z, distance, [-np.inf, 0.0], colors=["#c9d1d8"], zorder=1)
        axes.contour(x, z, distance, [0.0], colors=[FAINT], linewidths=1.2, zorder=2)


def _draw_panel(axes: Axes, simulation: Simulation) -> None:
    """Draw the panel's face, and the board below it in the core's thickness."""
    frame = simulation.panel_frame()
    if frame is None:
        return
    half = 0.5 * frame["length"] * np.asarray(frame["slope"])
    face = np.array([frame["center"] - half, frame["center"] + half])
    back = face[::-1] - frame["board_thickness"] * np.asarray(frame["normal"])
    axes.fill(*np.concatenate([face, back])[:, [0, 2]].T, color="#c9d1d8", linewidth=0, zorder=1)
    axes.plot(*face[:, [0, 2]].T, color=INK, linewidth=3.5, zorder=4, label="panel")


def _draw_ground(axes: Axes, scene: Mapping[str, Any], tilt: float) -> None:
    if not scene.get("ground"):
        return
    x = np.array(axes.get_xlim())
    z = -x * np.tan(np.radians(tilt))
    axes.fill_between(x, z, axes.get_ylim()[0], color="#eef1f4", linewidth=0, zorder=0)
    axes.plot(x, z, color=FAINT, linewidth=1.2, zorder=1)


def _near_section(positions: Floats, scene: Mapping[str, Any]) -> Floats:
    """Return the particles that lie within a cell of y = 0; in 2D all of them."""
    near: Floats = positions[np.abs(positions[:, 1]) <= resolution_of(scene)]
    return near


def _dot(scene: Mapping[str, Any], width: float) -> float:
    """Return the area of a particle's dot, points squared, so that dots nearly touch."""
    count = scene.get("seeding", {}).get("particles_per_voxel", 1.0)
    spacing = resolution_of(scene) / count ** (1.0 / scene["dimension"])
    return float(np.clip((0.9 * spacing * 72.0 * (WIDTH - 1.0) / width) ** 2, 1.0, 60.0))
