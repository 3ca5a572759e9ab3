"""Report of a validation: ``validation.html``, which needs no other file, figures and tables.

==================== ========================================================================
validation.html      the report
results.csv          one row per measured quantity, from `to_table`
results.json         the same, with orders of convergence, cheapest settings and criteria
stress.csv           one row per run of the stress suite, if it ran
figures/             the figures of the report (.png)
==================== ========================================================================
"""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

from snowshed.base import formatting
from snowshed.io.atomic import write_text
from snowshed.io.csv_table import write_csv
from snowshed.plot.html_page import template, write_pictures
from snowshed.snow.accuracy import setting_labels
from snowshed.snow.accuracy.measurements import MeasuredSolution, to_table
from snowshed.snow.accuracy.solutions import rows_of, solutions
from validation.framework import sections
from validation.framework.case import Case
from validation.framework.cheapest import QuickestSettings, cheapest
from validation.framework.convergence import convergences
from validation.framework.criteria import Criterion, compare

if TYPE_CHECKING:
    import pandas as pd

    from validation.stress import SummaryTable

TEMPLATE = "validation.html.j2"


@dataclass(frozen=True)
class Stress:
    """Results of the stress suite: one row per run, and summary tables."""

    runs: pd.DataFrame
    tables: Sequence[SummaryTable]

    @property
    def failed(self) -> int:
        """Number of runs with the outcome "failed"."""
        return int((self.runs["outcome"] == "failed").sum())


@dataclass(frozen=True)
class Validation:
    """Cases and their measurements.

    Attributes
    ----------
    cases, measurements
        The cases, and all of their measurements.
    full
        Whether the full matrices were measured.
    stress
        The stress suite's results, if it ran.
    """

    cases: Sequence[Case]
    measurements: Sequence[MeasuredSolution]
    full: bool
    stress: Optional[Stress] = None

    def facts(self) -> dict[str, str]:
        """Return the suite, version, machine, date, number and duration of the measurements."""
        failed = sum(1 for measurement in self.measurements if measurement.failure)
        return {
            "suite": "full" if self.full else "quick",
            "version": _all({measurement.version for measurement in self.measurements}),
            "machine": _all({measurement.machine for measurement in self.measurements}),
            "date": _all({measurement.date for measurement in self.measurements}),
            "measurements": f"{len(self.measurements)}, {failed} failed",
            "duration": formatting.duration(
                math.fsum(measurement.elapsed_s for measurement in self.measurements)
            ),
        }


def write_report(validation: Validation, folder: Path) -> list[Criterion]:
    """Write the report's files into a folder; return the criteria and their results."""
    table = to_table(validation.measurements)
    criteria = compare(table, validation.cases)
    answers = cheapest(table, validation.cases)
    about_cases = [
        sections.section(case, [m for m in validation.measurements if m.case == case.name], table)
        for case in validation.cases
    ]
    pictures = [picture for about in about_cases for picture in about.pictures]
    write_pictures(pictures, folder / "figures")
    write_csv(table, folder / "results.csv", float_format="%.9g")
    write_text(folder / "results.json", json_text(validation, table, criteria, answers))
    if validation.stress is not None:
        write_csv(validation.stress.runs, folder / "stress.csv", float_format="%.9g")
    page = render(validation, criteria, answers, about_cases)
    write_text(folder / "validation.html", page)
    return criteria


def problems(validation: Validation, criteria: Sequence[Criterion]) -> list[str]:
    """Return a line for every failure."""
    titles = {case.name: case.title for case in validation.cases}
    lines = [
        f"{titles[criterion.case]}, {criterion.quantity.title}: "
        f"demanded {sections.limit_text(criterion)}, worst {sections.worst_error(criterion)}, "
        f"{setting_labels.settings_label(criterion.settings)}"
        for criterion in criteria
        if criterion.holds is False
    ]
    lines += [
        f"{titles[measurement.case]}, {setting_labels.settings_label(measurement.settings)}: "
        f"{measurement.failure}"
        for measurement in validation.measurements
        if measurement.failure
    ]
    if validation.stress is not None and validation.stress.failed:
        lines.append(f"stress suite: {validation.stress.failed} runs failed")
    return lines


def render(
    validation: Validation,
    criteria: Sequence[Criterion],
    answers: Sequence[QuickestSettings],
    about_cases: Sequence[sections.Section],
) -> str:
    """Return the report as HTML."""
    return template("validation.framework", TEMPLATE).render(
        facts=validation.facts(),
        counts=Counter(criterion.holds for criterion in criteria),
        problems=problems(validation, criteria),
        criteria=sections.criteria_grid(criteria, validation.cases),
        cheapest=sections.cheapest_grid(answers, validation.cases, validation.measurements),
        sections=about_cases,
        stress=validation.stress,
        grid_of=sections.frame_grid,
    )


def json_text(
    validation: Validation,
    table: pd.DataFrame,
    criteria: Sequence[Criterion],
    answers: Sequence[QuickestSettings],
) -> str:
    """Return the results as JSON; numbers that are not finite are null."""
    data = {
        "about": validation.facts(),
        "criteria": [
            {**asdict(criterion), "quantity": criterion.quantity.name, "holds": criterion.holds}
            for criterion in criteria
        ],
        "cheapest": [asdict(answer) for answer in answers],
        "orders": _orders(validation, table),
        "measurements": [measurement.to_json() for measurement in validation.measurements],
    }
    return json.dumps(_plain(data), indent=1, allow_nan=False) + "\n"


def _orders(validation: Validation, table: pd.DataFrame) -> list[dict[str, Any]]:
    return [
        {
            "case": case.name,
            "quantity": quantity.name,
            "in": quantity.order_in,
            **asdict(convergence),
        }
        for case in validation.cases
        for quantity in case.quantities
        if quantity.order_in is not None
        for convergence in convergences(
            solutions(rows_of(table, case.name, quantity.name)),
            quantity.order_in,
        )
    ]


def _plain(value: Any) -> Any:
    """Return data with the types of JSON; numbers that are not finite become None."""
    if isinstance(value, Mapping):
        return {str(name): _plain(inner) for name, inner in value.items()}
    if isinstance(value, (str, bool, int)) or value is None:
        return value
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    return [_plain(inner) for inner in value]


def _all(values: set[str]) -> str:
    return ", ".join(sorted(values)) or formatting.MISSING
