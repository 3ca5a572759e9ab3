"""Pictures: the snow of several cases at the same times beside each other, and fronts over time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Literal

import numpy as np

from reproductions.saito2012.measures import MOVING_KIND, Course
from snowshed.plot.figure_style import blank_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

DEPOSIT_SHADE = "0.6"


def side_views(courses: Sequence[Course], times: Sequence[float]) -> Figure:
    """Return the snow from the side, a row for each time, a column for each case."""
    return _views(courses, times, lambda course, snow: snow[:, [0, 2]], _ground, "x (m)", "z (m)")


def top_views(courses: Sequence[Course], times: Sequence[float]) -> Figure:
    """Return the snow from above, over the distance along the ground."""

    def plan(course: Course, positions: np.ndarray) -> np.ndarray:
        return np.stack([course.case.path.along(positions), positions[:, 1]], axis=1)

    return _views(courses, times, plan, _obstacle_line, "distance along the ground (m)", "y (m)")


def _views(
    courses: Sequence[Course],
    times: Sequence[float],
    project: Callable[[Course, np.ndarray], np.ndarray],
    decorate: Callable[[Axes, Course], None],
    across: str,
    up: str,
) -> Figure:
    figure = blank_figure(3.4 * len(courses), 0.6 + 1.5 * len(times))
    one_path = len({tuple(course.case.path.corners) for course in courses}) == 1
    share: Literal["all", "col"] = "all" if one_path else "col"
    axes = figure.subplots(len(times), len(courses), sharex=share, sharey=share, squeeze=False)
    fastest = max(
        float(np.linalg.norm(course.at(t).velocities, axis=1).max())
        for course in courses
        for t in times
    )
    shown = None
    for column, course in zip(axes.T, courses):
        for axis, time in zip(column, times):
            snow = course.at(time)
            points = project(course, snow.positions.astype(float))
            speed = np.linalg.norm(snow.velocities, axis=1)
            rests = snow.kinds != MOVING_KIND
            decorate(axis, course)
            axis.plot(*points[rests].T, ".", color=DEPOSIT_SHADE, markersize=1.5)
            shown = axis.scatter(
                *points[~rests].T, c=speed[~rests], s=2, vmin=0, vmax=fastest, cmap="viridis"
            )
            axis.set_ylabel(f"{time:g} s\n{up}")
        column[0].set_title(course.case.name)
        column[-1].set_xlabel(across)
    if shown is not None:
        figure.colorbar(
            shown, ax=axes, label="speed (m/s); grey: deposited or erodible", shrink=0.7
        )
    return figure


def fronts(courses: Sequence[Course]) -> Figure:
    """Return the position of the front over time."""
    figure = blank_figure(5.5, 3.6)
    axis = figure.subplots()
    for course in courses:
        axis.plot(course.times, course.fronts(), label=course.case.name)
    axis.set_xlabel("time (s)")
    axis.set_ylabel("front along the ground (m)")
    axis.legend()
    return figure


def _ground(axis: Axes, course: Course) -> None:
    corners = np.array([*course.case.path.corners, (_end(course), 0.0)])
    axis.plot(*corners.T, color="k", linewidth=0.8)


def _obstacle_line(axis: Axes, course: Course) -> None:
    if course.case.obstacle is not None:
        axis.axvline(course.case.obstacle, color="k", linewidth=0.8)


def _end(course: Course) -> float:
    return max(1.0, max(float(state.positions[:, 0].max()) for state in course.snow))
