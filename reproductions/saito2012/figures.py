"""Pictures: the snow of several cases at the same times beside each other, and fronts over time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np

from reproductions.saito2012.measures import MOVING_KIND, CaseHistory
from snowshed.plot.figure_style import blank_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DEPOSIT_SHADE = "0.6"


def side_views(histories: Sequence[CaseHistory], times: Sequence[float]) -> Figure:
    """Return the snow from the side, a row for each time, a column for each case."""
    return _views(
        histories, times, lambda history, snow: snow[:, [0, 2]], _ground, "x (m)", "z (m)"
    )


def top_views(histories: Sequence[CaseHistory], times: Sequence[float]) -> Figure:
    """Return the snow from above, over the distance along the ground."""

    def plan(history: CaseHistory, positions: np.ndarray) -> np.ndarray:
        return np.stack([history.case.profile.along(positions), positions[:, 1]], axis=1)

    return _views(histories, times, plan, _obstacle_line, "distance along the ground (m)", "y (m)")


def _views(
    histories: Sequence[CaseHistory],
    times: Sequence[float],
    project: Callable[[CaseHistory, np.ndarray], np.ndarray],
    decorate: Callable[[Axes, CaseHistory], None],
    across: str,
    up: str,
) -> Figure:
    figure = blank_figure(3.4 * len(histories), 0.6 + 1.5 * len(times))
    one_profile = len({tuple(history.case.profile.corners) for history in histories}) == 1
    share: Literal["all", "col"] = "all" if one_profile else "col"
    axes = figure.subplots(len(times), len(histories), sharex=share, sharey=share, squeeze=False)
    fastest = max(
        float(np.linalg.norm(history.at(t).velocities, axis=1).max())
        for history in histories
        for t in times
    )
    shown = None
    for column, history in zip(axes.T, histories):
        for axis, time in zip(column, times):
            snow = history.at(time)
            points = project(history, snow.positions.astype(float))
            speed = np.linalg.norm(snow.velocities, axis=1)
            rests = snow.kinds != MOVING_KIND
            decorate(axis, history)
            axis.plot(*points[rests].T, ".", color=DEPOSIT_SHADE, markersize=1.5)
            shown = axis.scatter(
                *points[~rests].T, c=speed[~rests], s=2, vmin=0, vmax=fastest, cmap="viridis"
            )
            axis.set_ylabel(f"{time:g} s\n{up}")
        column[0].set_title(history.case.name)
        column[-1].set_xlabel(across)
    if shown is not None:
        figure.colorbar(
            shown, ax=axes, label="speed (m/s); grey: deposited or erodible", shrink=0.7
        )
    return figure


def fronts(histories: Sequence[CaseHistory]) -> Figure:
    """Return the position of the front over time."""
    figure = blank_figure(5.5, 3.6)
    axis = figure.subplots()
    for history in histories:
        axis.plot(history.times, history.fronts(), label=history.case.name)
    axis.set_xlabel("time (s)")
    axis.set_ylabel("front along the ground (m)")
    axis.legend()
    return figure


def _ground(axis: Axes, history: CaseHistory) -> None:
    corners = np.array([*history.case.profile.corners, (_end(history), 0.0)])
    axis.plot(*corners.T, color="k", linewidth=0.8)


def _obstacle_line(axis: Axes, history: CaseHistory) -> None:
    if history.case.obstacle is not None:
        axis.axvline(history.case.obstacle, color="k", linewidth=0.8)


def _end(history: CaseHistory) -> float:
    return max(1.0, max(float(state.positions[:, 0].max()) for state in history.snow))
