"""Sections of the report, one for each case, with tables of texts and figures."""

from __future__ import annotations

import re
from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from snowshed.base import formatting
from snowshed.plot.html_page import HtmlTable, Picture
from snowshed.snow.accuracy import setting_labels
from snowshed.snow.accuracy.measurements import CaseSettings, MeasuredSolution
from snowshed.snow.accuracy.solutions import Solution, rows_of, settings_key, solutions
from validation.framework import figures
from validation.framework.case import Case, Quantity, alternatives
from validation.framework.cheapest import QuickestSettings, by_problem
from validation.framework.convergence import Convergence, convergences
from validation.framework.criteria import Criterion
from validation.framework.schemes import problem_of, varying

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

#: Texts for the costs of a measurement.
COSTS: Mapping[str, Callable[[MeasuredSolution], str]] = {
    "time": lambda measurement: formatting.duration(measurement.wall_s),
    "particles": lambda measurement: formatting.count(measurement.particles or None),
    "steps": lambda measurement: formatting.count(measurement.steps or None),
    "10⁶ updates/s": lambda measurement: formatting.number(measurement.updates_per_s / 1e6),
    "memory, MB": lambda measurement: formatting.number(measurement.peak_memory_mb),
}
#: Mark in a cell that repeats the text of the cell to the left.
SAME_AS_LEFT = "←"
CONVERGENCE = "Dashed: the slope of the order named. Red line, if any: the largest allowed error."
WORK_PRECISION = (
    "Points on the left are fast, points at the bottom are accurate. No other settings for the "
    "same problem beat the points with letters. Red line, if any: the largest allowed error."
)


@dataclass(frozen=True)
class Section:
    """Section of the report on a case.

    Attributes
    ----------
    common
        Settings that all measurements share.
    results, orders, extremes
        Tables of all measurements, of orders of convergence, and of smallest and largest errors.
    """

    case: Case
    paragraphs: Sequence[str]
    remarks: Sequence[str]
    common: str
    results: HtmlTable
    orders: HtmlTable
    extremes: HtmlTable
    pictures: Sequence[Picture]


def section(case: Case, measurements: Sequence[MeasuredSolution], table: pd.DataFrame) -> Section:
    """Return the section of the report on a case.

    Parameters
    ----------
    case
        The case.
    measurements
        Measurements of this case.
    table
        The same measurements as a table.
    """
    solution_lists = {
        quantity.name: solutions(rows_of(table, case.name, quantity.name))
        for quantity in case.quantities
    }
    series = {
        quantity.name: convergences(solution_lists[quantity.name], quantity.order_in)
        for quantity in case.quantities
        if quantity.order_in is not None
    }
    choices = [measurement.settings for measurement in measurements]
    shared = {k: v for k, v in (choices or [{}])[0].items() if k not in varying(choices)}
    return Section(
        case=case,
        paragraphs=_paragraphs(case.description),
        remarks=_paragraphs(case.remarks),
        common=setting_labels.settings_label(shared),
        results=results_grid(case, measurements),
        orders=orders_grid(case, series),
        extremes=extremes_grid(case, solution_lists),
        pictures=_pictures(case, solution_lists, series),
    )


def results_grid(case: Case, measurements: Sequence[MeasuredSolution]) -> HtmlTable:
    """Return a table of all measurements: settings that vary, quantities, and costs."""
    solved = [measurement for measurement in measurements if not measurement.failure]
    names = varying([measurement.settings for measurement in measurements])
    given = {m.quantity for measurement in solved for m in measurement.measured}
    quantities = [
        _Columns.of(quantity, solved) for quantity in case.quantities if quantity.name in given
    ]
    costs = {name: [words(measurement) for measurement in solved] for name, words in COSTS.items()}
    costs = {name: texts for name, texts in costs.items() if set(texts) != {formatting.MISSING}}
    rows = [
        [
            *(_cell(measurement.settings, name) for name in names),
            *(text for columns in quantities for text in columns.texts(measurement)),
            *(texts[i] for texts in costs.values()),
        ]
        for i, measurement in enumerate(solved)
    ]
    groups = [("", len(names)), *((c.heading, len(c.head)) for c in quantities), ("", len(costs))]
    head = [
        *(name.replace("_", " ") for name in names),
        *(title for columns in quantities for title in columns.head),
        *costs,
    ]
    align = "l" * len(names) + "r" * (len(head) - len(names))
    return HtmlTable(head, rows, align, [group for group in groups if group[1]])


def orders_grid(case: Case, series: Mapping[str, Sequence[Convergence]]) -> HtmlTable:
    """Return a table of the observed orders of convergence."""
    titles = {quantity.name: quantity.title for quantity in case.quantities}
    settings_in = {quantity.name: quantity.order_in or "" for quantity in case.quantities}
    rows = [
        [
            titles[name],
            setting_labels.settings_label(
                convergence.settings, varying([other.settings for other in group])
            )
            or "all",
            settings_in[name].replace("_", " "),
            " … ".join(formatting.number(convergence.sizes[i]) for i in (0, -1)),
            ", ".join(_order(slope) for slope in convergence.pairwise),
            _order(convergence.order),
        ]
        for name, group in series.items()
        for convergence in group
    ]
    head = ("quantity", "settings", "in", "from … to", "between neighbours", "order")
    return HtmlTable(head, rows, "lllllr")


def extremes_grid(case: Case, solution_lists: Mapping[str, Sequence[Solution]]) -> HtmlTable:
    """Return a table of smallest, median and largest errors of all quantities, with settings."""
    rows = []
    for quantity in case.quantities:
        by_error = sorted(solution_lists[quantity.name], key=lambda solution: abs(solution.error))
        if not by_error:
            continue
        names = varying([solution.settings for solution in by_error])
        middle = float(np.median([abs(solution.error) for solution in by_error]))
        ends = [
            (
                quantity.error_text(abs(solution.error)),
                setting_labels.settings_label(solution.settings, names),
            )
            for solution in (by_error[0], by_error[-1])
        ]
        median = quantity.error_text(middle)
        rows.append([quantity.title, *ends[0], median, *ends[1]])
    head = ("quantity", "smallest error", "with", "median", "largest error", "with")
    return HtmlTable(head, rows, "lrlrrl")


def criteria_grid(criteria: Sequence[Criterion], cases: Sequence[Case]) -> HtmlTable:
    """Return a table of the criteria and their results; criteria that do not hold come first."""
    titles = {case.name: case.title for case in cases}
    rank = {False: 0, True: 1, None: 2}
    rows = [
        [
            {True: "holds", False: "does not hold", None: "not measured"}[criterion.holds],
            titles[criterion.case],
            criterion.quantity.title,
            settings_text(criterion),
            limit_text(criterion),
            worst_error(criterion),
            setting_labels.settings_label(criterion.settings),
        ]
        for criterion in sorted(criteria, key=lambda criterion: rank[criterion.holds])
    ]
    head = ("", "case", "quantity", "for", "demanded", "worst", "with")
    return HtmlTable(head, rows, "llllrrl")


def settings_text(criterion: Criterion) -> str:
    """Return the text for the settings to which a criterion applies."""
    wanted = [
        " or ".join(
            setting_labels.setting_label(name, alternative) for alternative in alternatives(value)
        )
        for name, value in criterion.applies_to.items()
    ]
    return ", ".join(wanted) or "all settings"


def limit_text(criterion: Criterion) -> str:
    """Return the text for the limit of a criterion."""
    if criterion.kind == "order":
        return f"order ≥ {criterion.demanded:g} in {criterion.quantity.order_in}".replace("_", " ")
    return f"≤ {criterion.quantity.error_text(criterion.demanded)}"


def worst_error(criterion: Criterion) -> str:
    """Return the text for the worst result."""
    if criterion.worst is None:
        return formatting.MISSING
    if np.isnan(criterion.worst):
        return "failed"
    if criterion.kind == "order":
        return _order(criterion.worst)
    return criterion.quantity.error_text(criterion.worst)


def cheapest_grid(
    answers: Sequence[QuickestSettings],
    cases: Sequence[Case],
    measurements: Sequence[MeasuredSolution],
) -> HtmlTable:
    """Return a table of the quickest settings for each accuracy, with a row for each problem."""
    wanted = sorted({answer.wanted for answer in answers}, reverse=True)
    head = ("case", "quantity", "problem", *(formatting.percent(share) for share in wanted))
    rows = [row for case in cases for row in _cheapest_rows(case, answers, measurements)]
    return HtmlTable(head, rows, "l" * len(head))


def frame_grid(frame: pd.DataFrame) -> HtmlTable:
    """Return a table of numbers and words as a table of texts."""
    from pandas.api.types import is_numeric_dtype

    rows = [[_text(value) for value in row] for row in frame.itertuples(index=False)]
    align = "".join("r" if is_numeric_dtype(frame[name]) else "l" for name in frame)
    return HtmlTable([str(name).replace("_", " ") for name in frame], rows, align)


@dataclass(frozen=True)
class _Columns:
    """Columns of one quantity: its value, its exact value if that varies, and its error."""

    quantity: Quantity
    heading: str
    head: Sequence[str]

    @classmethod
    def of(cls, quantity: Quantity, measurements: Iterable[MeasuredSolution]) -> _Columns:
        """Return the columns that measurements need."""
        measured = [
            m
            for measurement in measurements
            for m in measurement.measured
            if m.quantity == quantity.name
        ]
        exact = {m.exact for m in measured if not np.isnan(m.exact)}
        if exact == {0.0} and all(m.value == m.error for m in measured if not np.isnan(m.exact)):
            return cls(quantity, quantity.title, ("error",))
        if len(exact) == 1:
            heading = f"{quantity.title} (exact: {formatting.number(exact.pop(), 4)})"
            return cls(quantity, heading, ("value", "error"))
        return cls(quantity, quantity.title, ("value", "exact", "error"))

    def texts(self, measurement: MeasuredSolution) -> list[str]:
        """Return the cells of a measurement."""
        for measured in measurement.measured:
            if measured.quantity == self.quantity.name:
                cells = [formatting.number(measured.value, 4), formatting.number(measured.exact, 4)]
                error = self.quantity.error_text(measured.error)
                return [*cells[: len(self.head) - 1], error]
        return [formatting.MISSING] * len(self.head)


def _pictures(
    case: Case,
    solution_lists: Mapping[str, Sequence[Solution]],
    series: Mapping[str, Sequence[Convergence]],
) -> list[Picture]:
    choices = [solution.settings for group in solution_lists.values() for solution in group]
    quantities = {quantity.name: quantity for quantity in case.quantities}
    converging = [(quantities[name], group) for name, group in series.items() if group]
    solved = [(quantities[name], by_problem(case, group)) for name, group in solution_lists.items()]
    solved = [
        (quantity, problems) for quantity, problems in solved if _compared(quantity, problems)
    ]
    pictures = []
    if converging:
        figure = figures.convergence_figure(converging, choices)
        pictures.append(_picture(figure, case, "Convergence", CONVERGENCE))
    if solved:
        figure = figures.work_precision_figure(solved, choices)
        pictures.append(_picture(figure, case, "Error against run time", WORK_PRECISION))
    return pictures


def _compared(
    quantity: Quantity, problems: Sequence[tuple[CaseSettings, Sequence[Solution]]]
) -> bool:
    """Return whether errors of the quantity show which solution is better.

    For this, a problem needs several solutions, and the quantity a scale for its error.
    """
    measured_by = quantity.relative or quantity.order_in or quantity.limit is not None
    return bool(measured_by) and any(len(group) > 1 for _, group in problems)


def _picture(figure: Figure, case: Case, title: str, caption: str) -> Picture:
    name = f"{case.name}-{title.lower()}".replace(" ", "-")
    return Picture.drawn(figure, name, title, caption)


def _cheapest_rows(
    case: Case, answers: Sequence[QuickestSettings], measurements: Sequence[MeasuredSolution]
) -> list[list[str]]:
    """Return a row for each quantity and problem of a case, with the case's title in the first."""
    groups: dict[Hashable, list[QuickestSettings]] = {}
    for answer in answers:
        if answer.case == case.name:
            groups.setdefault((answer.quantity, settings_key(answer.problem)), []).append(answer)
    titles = {quantity.name: quantity.title for quantity in case.quantities}
    problems = varying(group[0].problem for group in groups.values())
    solution_settings = varying(
        {
            k: v
            for k, v in measurement.settings.items()
            if k not in problem_of(case, measurement.settings)
        }
        for measurement in measurements
        if measurement.case == case.name
    )
    rows: list[list[str]] = []
    for group in groups.values():
        texts = [
            _cheapest_cell(answer, solution_settings)
            for answer in sorted(group, key=lambda answer: -answer.wanted)
        ]
        rows.append(
            [
                "" if rows else case.title,
                titles[group[0].quantity],
                setting_labels.settings_label(group[0].problem, problems),
                *(
                    SAME_AS_LEFT if text == left else text
                    for left, text in zip(["", *texts], texts)
                ),
            ]
        )
    return rows


def _cheapest_cell(answer: QuickestSettings, solution_settings: Sequence[str]) -> str:
    if not answer.reached:
        return f"not reached; best {formatting.percent(answer.error)}"
    with_what = setting_labels.settings_label(answer.solution.settings, solution_settings)
    return f"{formatting.duration(answer.solution.wall_s)}: {with_what}".rstrip(": ")


def _cell(settings: CaseSettings, name: str) -> str:
    value: Optional[Any] = settings.get(name)
    if value is None:
        return setting_labels.missing_label(name)
    if isinstance(value, bool):
        return "yes" if value else "no"
    if name == "dimension":
        return setting_labels.setting_label(name, value)
    return value.replace("_", " ") if isinstance(value, str) else formatting.number(value, 4)


def _text(value: Any) -> str:
    if isinstance(value, (bool, str)):
        return str(value)
    if isinstance(value, (int, np.integer)):
        return formatting.count(int(value))
    return formatting.number(float(value)) if isinstance(value, float) else str(value)


def _order(slope: float) -> str:
    return f"{slope:.2f}" if np.isfinite(slope) else formatting.MISSING


def _paragraphs(text: str) -> list[str]:
    """Return the paragraphs of a text, each as one line."""
    return [" ".join(part.split()) for part in re.split(r"\n\s*\n", text) if part.strip()]
