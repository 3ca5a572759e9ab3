"""Figures of section 5.3: selection, hyper-parameters, quantiles, predictions; and the cost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

from snowshed.analysis.regression.fold_result import FoldResult
from snowshed.analysis.regression.model_file import Member
from snowshed.analysis.regression.rows import INPUTS, TARGETS, StackRows
from snowshed.analysis.regression.scaling import Scaling
from snowshed.base.arrays import Floats
from snowshed.plot import figure_style
from snowshed.plot.figure_style import FAINT, INK, STYLE, blank_figure, headline
from snowshed.scene.labels import label

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes

Elected = Mapping[str, Sequence[FoldResult]]
Titles = Mapping[str, str]

#: Colour of each kind of model.
COLOURS = dict(
    zip(("rbf", "linear", "gaussian-process", "gradient-boosting"), figure_style.COLOURS)
)
REFERENCE_PANEL = (2.0, 2.0, 40.0)  # height and length in m, tilt in degrees; Table 5.1.1
MAX_BARS = 12  # values of a hyper-parameter that get a bar each
CURVE_POINTS = 80  # points of a predicted curve


def selection_figure(elected: Elected, titles: Titles, target: str) -> Figure:
    """Draw the scores of the elected models over the rounds, as Figure 5.3.1."""
    with matplotlib.rc_context(STYLE):
        figure = blank_figure(7.5, 4.2)
        axes = figure.subplots()
        for shift, (kind, results) in enumerate(elected.items()):
            validation = _by_round(results, "validation_score")
            development = _by_round(results, "development_score")
            x = np.arange(1, len(validation) + 1) + 0.06 * (shift - 0.5 * (len(elected) - 1))
            look: dict[str, Any] = {"color": COLOURS[kind], "capsize": 2, "markersize": 4}
            for scores, line, marker in ((validation, "-", "o"), (development, ":", "s")):
                axes.errorbar(
                    x, scores.mean(axis=1), scores.std(axis=1), fmt=f"{marker}{line}", **look
                )
        axes.set(xlabel="round", ylabel=f"median absolute error of {_quantity(target)}")
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        axes.set_xlim(0.5, len(validation) + 0.5)
        axes.set_ylim(bottom=0)
        axes.set_title("Scores of the elected models: mean and standard deviation over the folds")
        keys = [Line2D([], [], color=COLOURS[kind], label=titles[kind]) for kind in elected]
        keys += [
            Line2D([], [], color=INK, marker="o", label="on the validation fold"),
            Line2D([], [], color=INK, marker="s", linestyle=":", label="on the development set"),
        ]
        figure.legend(handles=keys, loc="outside lower center", ncols=3)
    return figure


def hyperparameter_figure(
    elected: Elected, titles: Titles, target: str, inputs: Sequence[str] = INPUTS
) -> Figure:
    """Draw how often the search chose each value of each hyper-parameter, as Figure 5.3.2."""
    names = {kind: list(results[0].parameters) for kind, results in elected.items()}
    columns = max(len(listed) for listed in names.values())
    with matplotlib.rc_context(STYLE):
        figure = blank_figure(1.2 + 1.9 * columns, 0.6 + 1.75 * len(names))
        grid = figure.subplots(len(names), columns, squeeze=False)
        for row, (kind, results) in zip(grid, elected.items()):
            for axes, name in zip(row, names[kind]):
                values = np.array([result.parameters[name] for result in results])
                _draw_histogram(axes, values, COLOURS[kind])
                axes.set_title(_parameter_word(name, inputs), fontsize=9)
            for axes in row[len(names[kind]) :]:
                axes.set_visible(False)
            row[0].set_ylabel(f"{titles[kind]}\nmodels")
        headline(figure, f"Hyper-parameters that the search chose, {target}")
    return figure


def quantile_figure(elected: Elected, titles: Titles, values: Floats, target: str) -> Figure:
    """Draw sorted mean predictions over sorted data, with the models' deviation: Figure 5.3.3."""
    with matplotlib.rc_context(STYLE):
        figure = blank_figure(1 + 2.6 * len(elected), 3.4)
        grid = figure.subplots(1, len(elected), sharex=True, sharey=True, squeeze=False)[0]
        for axes, (kind, results) in zip(grid, elected.items()):
            everything = np.array([result.predictions for result in results])
            mean, deviation = everything.mean(axis=0), everything.std(axis=0)
            order = np.argsort(mean)
            axes.errorbar(
                np.sort(values),
                mean[order],
                deviation[order],
                fmt=".",
                color=COLOURS[kind],
                ecolor=FAINT,
                markersize=3,
                elinewidth=0.8,
            )
            ends = [values.min(), values.max()]
            axes.plot(ends, ends, color=INK, linewidth=1, linestyle="--")
            axes.set_title(titles[kind])
            axes.set_xlabel(f"data, {_quantity(target)}")
        grid[0].set_ylabel("mean prediction\n(bars: deviation of the models)")
    return figure


def prediction_figure(
    members: Mapping[str, Member], titles: Titles, rows: StackRows, target: str
) -> Optional[Figure]:
    """Draw predictions and data while one input varies, the others at the reference: Figure 5.3.4.

    Returns None if there is nothing to draw.
    """
    reference = reference_panel(rows)
    numbers = range(1, len(rows.names))
    varying = [number for number in numbers if np.ptp(rows.inputs[:, number]) > 0]
    if not members or not varying:
        return None
    events = np.unique(rows.inputs[:, 0])
    with matplotlib.rc_context(STYLE):
        figure = blank_figure(1 + 2.9 * len(varying), 1.0 + 2.6 * len(members))
        grid = figure.subplots(len(members), len(varying), sharey=True, sharex="col", squeeze=False)
        for row, (kind, member) in zip(grid, members.items()):
            for axes, number in zip(row, varying):
                for shade, event in zip(_shades(len(events)), events):
                    _draw_curve(axes, member, rows, target, reference, number, event, shade)
            row[0].set_ylabel(f"{titles[kind]}\n{_quantity(target)}")
        for axes, number in zip(grid[-1], varying):
            axes.set_xlabel(label(rows.names[number]).axis)
        for axes, number in zip(grid[0], varying):
            others = [other for other in numbers if other != number]
            at = [_setting_text(rows.names[other], reference[other - 1]) for other in others]
            axes.set_title(",\n".join(map(", ".join, _in_threes(at))), fontsize=9)
        keys = [
            Line2D([], [], color=shade, marker="o", markersize=4, label=f"event {event:g}")
            for shade, event in zip(_shades(len(events)), events)
        ]
        keys.append(Line2D([], [], color=INK, marker="o", linestyle="", label="data"))
        keys.append(Line2D([], [], color=INK, label="prediction (band: deviation of the models)"))
        figure.legend(handles=keys, loc="outside lower center", ncols=4)
    return figure


def cost_figure(errors: pd.DataFrame, titles: Titles, target: str) -> Figure:
    """Draw the error on rows and panels that were not trained on, over fitting time."""
    with matplotlib.rc_context(STYLE):
        figure = blank_figure(6.5, 4.0)
        axes = figure.subplots()
        axes.set(xscale="log", yscale="log")
        for kind, row in errors.iterrows():
            colour = COLOURS[str(kind)]
            axes.plot(row["cpu_s"], row["held_out_error"], "o", color=colour)
            axes.plot(row["cpu_s"], row["unseen_panel_error"], "^", color=colour)
            axes.annotate(
                f"{titles[str(kind)]}, {row['fits']:,.0f} fits",
                (row["cpu_s"], row["held_out_error"]),
                (7, 0),
                textcoords="offset points",
                va="center",
                color=colour,
                fontsize=9,
            )
        axes.set(xlabel="processor time of search and training, s")
        axes.set_ylabel(f"mean absolute error of {_quantity(target)}")
        axes.margins(x=0.3, y=0.25)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axis.set_major_formatter("{x:g}")
            axis.set_minor_formatter(NullFormatter())
        keys = [
            Line2D([], [], color=INK, marker="o", linestyle="", label="rows not trained on"),
            Line2D([], [], color=INK, marker="^", linestyle="", label="panels not trained on"),
        ]
        figure.legend(handles=keys, loc="outside lower center", ncols=2)
    return figure


def reference_panel(rows: StackRows) -> Floats:
    """Return the panel about which inputs vary: the panel nearest to the thesis's.

    Returns
    -------
    numpy.ndarray
        Shape (k - 1,), the inputs without the event. Those that the thesis does not vary are near
        their mean.
    """
    panels = rows.inputs[:, 1:]
    scaling = Scaling.of(panels)
    of_thesis = dict(zip(INPUTS[1:], REFERENCE_PANEL))
    wanted = [of_thesis.get(name, mean) for name, mean in zip(rows.names[1:], panels.mean(axis=0))]
    away = scaling.scaled(panels) - scaling.scaled(np.array(wanted))
    return np.asarray(panels[int(np.argmin((away**2).sum(axis=1)))])


def _draw_curve(
    axes: Axes,
    member: Member,
    rows: StackRows,
    target: str,
    reference: Floats,
    number: int,
    event: float,
    shade: Any,
) -> None:
    """Draw data and predictions of one event along one input."""
    here = np.concatenate([[event], reference])
    others = [other for other in range(len(here)) if other != number]
    fits = (rows.inputs[:, others] == here[others]).all(axis=1)
    x = rows.inputs[fits, number]
    axes.plot(x, rows.targets[target][fits], "o", color=shade, markersize=3.5)
    if fits.sum() < 2:
        return
    questions = np.tile(here, (CURVE_POINTS, 1))
    questions[:, number] = np.linspace(x.min(), x.max(), CURVE_POINTS)
    scaled = Scaling.of(rows.inputs).scaled(questions)
    predicted = member.ensemble.predict(scaled) * member.deviation + member.mean
    mean, deviation = predicted.mean(axis=0), predicted.std(axis=0)
    axes.plot(questions[:, number], mean, color=shade, linewidth=1.3)
    band = (mean - deviation, mean + deviation)
    axes.fill_between(questions[:, number], *band, color=shade, alpha=0.2, linewidth=0)


def _draw_histogram(axes: Axes, values: Floats, colour: str) -> None:
    """Draw how often each value occurs; many different values are binned."""
    different, counts = np.unique(values, return_counts=True)
    if len(different) > min(MAX_BARS, 0.5 * len(values)):
        axes.hist(np.log10(values), bins=8, color=colour)
        axes.xaxis.set_major_locator(MaxNLocator(3))
        axes.xaxis.set_major_formatter(lambda power, _: f"{10**power:.3g}")
    else:
        axes.bar(np.arange(len(different)), counts, color=colour, width=0.7)
        axes.set_xticks(np.arange(len(different)), [_shortest_number(value) for value in different])
        axes.set_xlim(-0.8, max(len(different), 3) - 0.2)
    axes.grid(visible=False, axis="x")
    axes.yaxis.set_major_locator(MaxNLocator(4, integer=True))


def _shortest_number(value: float) -> str:
    """Return a number as briefly as it can be written."""
    return min(f"{value:.4g}", f"{value:.0e}".replace("e-0", "e-").replace("e+0", "e"), key=len)


def _by_round(results: Sequence[FoldResult], score: str) -> Floats:
    """Return a score, shape (rounds, folds): the folds of a round validate each row once."""
    rows = len(results[0].predictions)
    folds = int(np.argmax(np.cumsum([len(r.validation) for r in results]) >= rows)) + 1
    return np.array([getattr(result, score) for result in results]).reshape(-1, folds)


def _parameter_word(name: str, inputs: Sequence[str]) -> str:
    if name.startswith("length_"):
        return f"length scale,\n{label(inputs[int(name.removeprefix('length_')) - 1]).name}"
    return name


def _quantity(target: str) -> str:
    title = {"ratio": "height / length"}.get(target, target)
    return f"{title}, {TARGETS[target]}" if TARGETS[target] else title


def _setting_text(name: str, value: float) -> str:
    parameter = label(name)
    return f"{parameter.name.removeprefix('panel ')} {parameter.quantity(value)}"


def _in_threes(texts: Sequence[str]) -> list[Sequence[str]]:
    return [texts[i : i + 3] for i in range(0, len(texts), 3)]


def _shades(count: int) -> list[Any]:
    return list(matplotlib.colormaps["viridis"](np.linspace(0.08, 0.86, count)))
