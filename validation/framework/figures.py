"""Figures of the report: convergence, and error against run time."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Collection, Hashable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import cycle
from string import ascii_uppercase
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Tuple

import matplotlib
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from snowshed.base import formatting
from snowshed.plot.figure_style import BODY, COLOURS, FAINT, INK, STYLE, blank_figure
from snowshed.snow.accuracy import setting_labels
from snowshed.snow.accuracy.measurements import CaseSettings, Value
from snowshed.snow.accuracy.solutions import Solution, settings_key
from validation.framework.case import Quantity
from validation.framework.cheapest import pareto_front
from validation.framework.convergence import Convergence
from validation.framework.schemes import varying

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure

#: Styles of a setting's values, by the name of the setting.
StylesOfValues = Mapping[str, Mapping[Optional[Value], Any]]

#: Settings that define a problem, and its solutions.
Problem = Tuple[CaseSettings, Sequence[Solution]]

MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
DASHES = ("-", (0, (5, 2)), (0, (1, 1.4)), (0, (6, 1.5, 1, 1.5)), (0, (9, 3)))
#: Settings with colours; others have markers and dashes.
COLOURED_SETTINGS = ("transfer", "law", "between", "dimension", "events", "basis", "precision")
#: Smallest relative distance at which two points on a Pareto front both get a letter.
MIN_POINT_DISTANCE = 0.1
#: Largest number of problems of a quantity with a Pareto front.
MAX_FRONTS = 3
#: Shown time of solutions that are too short to be measured, s.
MIN_TIME = 1e-6
#: Shown error of exact answers, whose zero a logarithmic axis cannot show.
MIN_SHOWN_ERROR = 1e-17


class KeyLine(NamedTuple):
    """A line of a diagram's key: a point's letter and text; without a letter, a heading."""

    letter: str
    cost: str
    settings: str


@dataclass(frozen=True)
class LineStyles:
    """Styles that distinguish settings: one by colour, one by marker, one by dashes.

    Attributes
    ----------
    colours, markers, dashes
        Styles of a setting's values, by the name of the setting; empty if no setting is left.
    """

    colours: StylesOfValues
    markers: StylesOfValues
    dashes: StylesOfValues

    @classmethod
    def of(
        cls,
        choices: Sequence[CaseSettings],
        drawn: Sequence[CaseSettings],
        along: Collection[str] = (),
    ) -> LineStyles:
        """Return the styles of the lines.

        Parameters
        ----------
        choices
            All choices of settings; a value looks the same in every figure of the case.
        drawn
            Choices that are drawn; styles show the settings in which these choices differ.
        along
            Settings that distinguish lines. Without such settings, dashes have no meaning.
        """
        names = [name for name in varying(drawn) if name not in along]
        names.sort(
            key=lambda n: (
                COLOURED_SETTINGS.index(n) if n in COLOURED_SETTINGS else len(COLOURED_SETTINGS)
            )
        )
        shapes = (COLOURS, MARKERS, DASHES) if along else (COLOURS, MARKERS)
        of_names: list[dict[str, dict[Optional[Value], Any]]] = [{}, {}, {}]
        for of_name, name, of_values in zip(of_names, names, shapes):
            values = dict.fromkeys(settings.get(name) for settings in choices)
            of_name[name] = dict(zip(values, cycle(of_values)))
        return cls(*of_names)

    def for_line(self, settings: CaseSettings) -> dict[str, Any]:
        """Return the arguments that draw the line of some settings."""
        return {
            "color": _pick(self.colours, settings, COLOURS[0]),
            "marker": _pick(self.markers, settings, MARKERS[0]),
            "linestyle": _pick(self.dashes, settings, DASHES[0]),
        }

    def key(self, drawn: Sequence[CaseSettings]) -> list[Line2D]:
        """Return the entries of a legend: every value that is drawn."""
        kinds = (("color", self.colours), ("marker", self.markers), ("linestyle", self.dashes))
        return [
            _entry(keyword, shape, setting_labels.setting_label(name, value))
            for keyword, styles in kinds
            for name, shapes in styles.items()
            for value, shape in shapes.items()
            if any(settings.get(name) == value for settings in drawn)
        ]


def convergence_figure(
    panels: Sequence[tuple[Quantity, Sequence[Convergence]]], choices: Sequence[CaseSettings]
) -> Figure:
    """Draw errors against the setting with which they fall, both on logarithmic axes.

    Parameters
    ----------
    panels
        Quantities, and the convergence of their errors.
    choices
        All choices of settings of the case.
    """
    drawn = [convergence.settings for _, series in panels for convergence in series]
    styles = LineStyles.of(choices, drawn, _orders_in(panels))
    with _figure(styles, drawn, rows=-(-len(panels) // 2)) as figure:
        for axes, (quantity, series) in zip(_pairs(figure, len(panels)), panels):
            _draw_convergence(axes, quantity, series, styles)
    return figure


def work_precision_figure(
    panels: Sequence[tuple[Quantity, Sequence[Problem]]], choices: Sequence[CaseSettings]
) -> Figure:
    """Draw errors against the time of the solution, and Pareto fronts with letters at their points.

    Parameters
    ----------
    panels
        Quantities, each with its solved problems. Only the `MAX_FRONTS` problems with the most
        solutions get a front.
    choices
        All choices of settings of the case.
    """
    drawn = [
        solution.settings
        for _, problems in panels
        for _, solutions in problems
        for solution in solutions
    ]
    styles = LineStyles.of(choices, drawn, _orders_in(panels))
    with _figure(styles, drawn, rows=len(panels)) as figure:
        grid = figure.subplots(len(panels), 2, squeeze=False, width_ratios=(1.25, 1))
        for (axes, beside), (quantity, problems) in zip(grid, panels):
            _write_key(beside, _draw_work_precision(axes, quantity, problems, styles))
    return figure


def _orders_in(panels: Sequence[tuple[Quantity, Any]]) -> list[str]:
    """Return the settings along which lines are drawn."""
    return [quantity.order_in for quantity, _ in panels if quantity.order_in is not None]


def _entry(keyword: str, shape: Any, label: str) -> Line2D:
    """Return an entry of a legend that shows a colour, a marker or dashes, and nothing else."""
    drawn: dict[str, Any] = {"color": INK, "marker": "o", "linestyle": "-"}
    if keyword == "marker":
        drawn["linestyle"] = ""
    if keyword == "linestyle":
        drawn["marker"] = ""
    return Line2D([], [], label=label, markersize=5, linewidth=1.4, **{**drawn, keyword: shape})


@contextmanager
def _figure(styles: LineStyles, drawn: Sequence[CaseSettings], *, rows: int) -> Iterator[Figure]:
    """Yield a figure for some rows of panels, with a legend of the styles that are drawn."""
    with matplotlib.rc_context(STYLE):
        figure = blank_figure(8.2, 2.9 * rows + 0.6)
        yield figure
        if key := styles.key(drawn):
            lines = -(-len(key) // 8)
            figure.legend(handles=key, loc="outside lower center", ncols=-(-len(key) // lines))


def _pairs(figure: Figure, count: int) -> list[Axes]:
    """Return panels in two columns."""
    panels = list(figure.subplots(-(-count // 2), 2, squeeze=False).flat)
    for unused in panels[count:]:
        unused.axis("off")
    return panels[:count]


def _draw_convergence(
    axes: Axes, quantity: Quantity, series: Sequence[Convergence], styles: LineStyles
) -> None:
    for convergence in series:
        errors = np.maximum(convergence.errors, MIN_SHOWN_ERROR)
        axes.plot(
            convergence.sizes,
            errors,
            markersize=4.5,
            linewidth=1.3,
            **styles.for_line(convergence.settings),
        )
    axes.set(xscale="log", yscale="log", title=_title(quantity))
    axes.set_xlabel((quantity.order_in or "").replace("_", " "))
    sizes = sorted({size for convergence in series for size in convergence.sizes})
    axes.set_xticks(sizes, [formatting.number(size) for size in sizes])
    axes.minorticks_off()
    _draw_slope(axes, series, quantity.min_order)
    _errors_on(axes, quantity)


def _draw_slope(axes: Axes, series: Sequence[Convergence], least: Optional[float]) -> None:
    """Draw a line with the demanded slope, or else with the nearest integer slope."""
    orders = [convergence.order for convergence in series if np.isfinite(convergence.order)]
    order = least or max(1.0, round(float(np.median(orders)))) if orders else 0.0
    if not order:
        return
    best = min(series, key=lambda convergence: convergence.errors[-1])
    ends = np.array([best.sizes.max(), best.sizes.min()])
    line = 0.6 * max(best.errors[0], MIN_SHOWN_ERROR) * (ends / ends[0]) ** order
    axes.plot(ends, line, color=FAINT, linewidth=1.2, linestyle=(0, (2, 2)), zorder=1)
    middle = np.sqrt(ends.prod()), np.sqrt(line.prod())
    place: dict[str, Any] = {"textcoords": "offset points", "va": "top", "fontsize": 8}
    axes.annotate(f"order {order:g}", middle, (5, -3), color=FAINT, **place)


def _draw_work_precision(
    axes: Axes, quantity: Quantity, problems: Sequence[Problem], styles: LineStyles
) -> list[KeyLine]:
    """Draw one diagram and return the lines of text about its fronts."""
    for _, solutions in problems:
        _draw_points(axes, solutions, quantity.order_in, styles)
    axes.set(xscale="log", yscale="log", title=_title(quantity), xlabel="time of the solution")
    axes.margins(0.1)
    axes.set_xlim(_widened(*axes.get_xlim()))
    _label(axes.xaxis, formatting.duration)
    _errors_on(axes, quantity)
    names, letters = varying(problem for problem, _ in problems), iter(ascii_uppercase)
    lines: list[KeyLine] = []
    for problem, solutions in _with_fronts(problems):
        if names:
            lines.append(KeyLine("", setting_labels.settings_label(problem, names), ""))
        lines += _draw_front(axes, quantity, solutions, letters)
    return lines


def _with_fronts(problems: Sequence[Problem]) -> list[Problem]:
    """Return the problems with the most solutions, without problems that have a single one."""
    several = [problem for problem in problems if len(problem[1]) > 1]
    return sorted(several, key=lambda problem: -len(problem[1]))[:MAX_FRONTS]


def _draw_points(
    axes: Axes, solutions: Sequence[Solution], order_in: Optional[str], styles: LineStyles
) -> None:
    for line in _lines(solutions, order_in):
        points = [_time(solutions[i]) for i in line], [_size(solutions[i]) for i in line]
        drawn = styles.for_line(solutions[line[0]].settings)
        axes.plot(*points, markersize=5, linewidth=0.9, alpha=0.8, markeredgewidth=0, **drawn)


def _draw_front(
    axes: Axes, quantity: Quantity, solutions: Sequence[Solution], letters: Iterator[str]
) -> list[KeyLine]:
    """Draw the Pareto front of one problem, and label its points with letters."""
    times, errors = (
        [_time(solution) for solution in solutions],
        [_size(solution) for solution in solutions],
    )
    on_front = pareto_front(times, errors)
    front = [int(i) for i in np.argsort(times) if on_front[i]]
    corners = np.array([(times[i], errors[i]) for i in front]).T
    axes.step(*corners, where="post", color=FAINT, linewidth=3.5, alpha=0.45, zorder=1)
    names = varying(solution.settings for solution in solutions)
    lines = []
    for i, letter in zip(worth_naming(front, times, errors), letters):
        _name_point(axes, letter, times[i], errors[i])
        error = quantity.error_text(errors[i])
        cost = f"{formatting.duration(times[i])}, {error}"
        lines.append(
            KeyLine(letter, cost, setting_labels.settings_label(solutions[i].settings, names))
        )
    return lines


def _time(solution: Solution) -> float:
    return max(solution.wall_s, MIN_TIME)


def _size(solution: Solution) -> float:
    return max(abs(solution.error), MIN_SHOWN_ERROR)


def worth_naming(
    front: Sequence[int], times: Sequence[float], errors: Sequence[float]
) -> list[int]:
    """Return the points of a Pareto front that differ clearly from each other.

    A point is left out if a more accurate one costs hardly more, or if a cheaper one is hardly less
    accurate.

    Parameters
    ----------
    front
        Indices, from the quickest to the most accurate.
    times, errors
        Run times and errors of all points.

    Examples
    --------
    >>> worth_naming([0, 1, 2, 3], [1.0, 1.05, 4.0, 8.0], [0.4, 0.2, 0.19, 0.1])
    [1, 3]
    """
    named: list[int] = []
    for i, following in zip(front, [*front[1:], None]):
        if following is not None and times[following] < (1 + MIN_POINT_DISTANCE) * times[i]:
            continue
        if not named or errors[i] < (1 - MIN_POINT_DISTANCE) * errors[named[-1]]:
            named.append(i)
    return named


def _lines(solutions: Sequence[Solution], order_in: Optional[str]) -> list[list[int]]:
    """Return the groups of solutions that differ in `order_in` alone; a line joins each group."""
    if order_in is None:
        return [[i] for i in range(len(solutions))]
    groups: dict[Hashable, list[int]] = {}
    for i, solution in enumerate(solutions):
        groups.setdefault(settings_key(solution.settings, without=[order_in]), []).append(i)
    return [
        sorted(group, key=lambda i: solutions[i].settings.get(order_in, 0))
        for group in groups.values()
    ]


def _name_point(axes: Axes, letter: str, time: float, error: float) -> None:
    offset: dict[str, Any] = {
        "textcoords": "offset points",
        "ha": "right",
        "va": "top",
        "zorder": 5,
    }
    axes.annotate(letter, (time, error), (-4, -3), color=INK, fontsize=9, weight="bold", **offset)


def _write_key(axes: Axes, lines: Sequence[KeyLine]) -> None:
    """Write a list of the points on the Pareto fronts."""
    axes.axis("off")
    if not lines:
        return
    axes.set_title("on the Pareto front", fontsize=9, color=FAINT)
    two = len(lines) < 8  # room for two lines each
    step = 0.98 / max(len(lines), 7 if two else 13)
    place: dict[str, Any] = {"transform": axes.transAxes, "va": "top", "color": INK, "fontsize": 8}
    for row, line in enumerate(lines):
        y = 0.98 - row * step
        axes.text(0.0, y, line.letter, weight="bold", **place)
        texts = [text for text in (line.cost, line.settings) if text]
        where = 0.06 if line.letter else 0.0
        axes.text(where, y, ("\n" if two else ": ").join(texts), **place)


def _errors_on(axes: Axes, quantity: Quantity) -> None:
    """Label the axis of the errors, and draw the limit."""
    axes.set_ylabel("error, relative" if quantity.relative else "error")
    low, high = _widened(*axes.get_ylim())
    axes.set_ylim(low, high)
    in_percent = quantity.relative and low > formatting.MIN_PERCENT_SHARE
    _label(axes.yaxis, formatting.percent if in_percent else formatting.number)
    if quantity.limit is not None:
        axes.axhline(quantity.limit, color=BODY, linewidth=1.0, linestyle=(0, (6, 3)), zorder=1)


def _label(axis: Axis, words: Callable[[float], str]) -> None:
    """Label the decades, and twice and five times each decade if there are few decades."""
    low, high = axis.get_view_interval()
    steps = (1.0,) if high > 200 * low else (1.0, 2.0, 5.0)
    axis.set_major_locator(LogLocator(subs=steps, numticks=9))
    axis.set_major_formatter(FuncFormatter(lambda value, _: words(value)))
    axis.set_minor_formatter(NullFormatter())


def _title(quantity: Quantity) -> str:
    return textwrap.fill(quantity.title, 46)


def _widened(low: float, high: float) -> tuple[float, float]:
    """Return limits of a logarithmic axis that span at least 1.5 decades, enough for its labels."""
    factor = max(1.0, np.sqrt(30.0 * low / high))
    return low / factor, high * factor


def _pick(styles: StylesOfValues, settings: CaseSettings, plain: Any) -> Any:
    for name, shapes in styles.items():
        return shapes.get(settings.get(name), plain)
    return plain
