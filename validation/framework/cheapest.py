"""The cost of accuracy: Pareto fronts, and the quickest settings for each accuracy."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from snowshed.base.arrays import Booleans
from snowshed.snow.accuracy.measurements import CaseSettings
from snowshed.snow.accuracy.solutions import (
    Solution,
    assured_errors,
    quickest,
    rows_of,
    settings_key,
    solutions,
)
from validation.framework.case import Case, Quantity
from validation.framework.schemes import problem_of

if TYPE_CHECKING:
    import pandas as pd

#: Accuracies for which the cheapest settings are looked up.
WANTED_ACCURACIES = (0.10, 0.05, 0.02, 0.01)


@dataclass(frozen=True)
class QuickestSettings:
    """Quickest settings for a wanted accuracy, or the most accurate settings if none reach it.

    Attributes
    ----------
    problem
        The settings that define the problem.
    error
        Error, which no finer solution exceeds (`assured_errors`).
    """

    case: str
    quantity: str
    problem: CaseSettings
    wanted: float
    reached: bool
    error: float
    solution: Solution


def pareto_front(costs: Sequence[float], errors: Sequence[float]) -> Booleans:
    """Return a mask of the points that no other point beats in both cost and error.

    Examples
    --------
    >>> pareto_front([1.0, 2.0, 3.0, 4.0], [0.3, 0.4, 0.1, 0.1]).tolist()
    [True, False, True, False]
    """
    front = np.zeros(len(costs), dtype=bool)
    best = np.inf
    for i in np.lexsort((errors, costs)):
        if errors[i] < best:
            front[i], best = True, errors[i]
    return front


def by_problem(
    case: Case, candidates: Iterable[Solution]
) -> list[tuple[CaseSettings, list[Solution]]]:
    """Return the problems of some solutions, each with all of its solutions."""
    groups: dict[Hashable, tuple[CaseSettings, list[Solution]]] = {}
    for solution in candidates:
        problem = problem_of(case, solution.settings)
        groups.setdefault(settings_key(problem), (problem, []))[1].append(solution)
    return list(groups.values())


def cheapest(
    table: pd.DataFrame, cases: Iterable[Case], wanted: Sequence[float] = WANTED_ACCURACIES
) -> list[QuickestSettings]:
    """Return the quickest settings for each accuracy.

    The list covers each quantity with a relative error, and each problem with several solutions.
    """
    return [
        _cheapest(case.name, quantity, problem, group, accuracy)
        for case in cases
        for quantity in case.quantities
        if quantity.relative
        for problem, group in by_problem(case, solutions(rows_of(table, case.name, quantity.name)))
        if len(group) > 1
        for accuracy in wanted
    ]


def _cheapest(
    case: str, quantity: Quantity, problem: CaseSettings, group: Sequence[Solution], wanted: float
) -> QuickestSettings:
    errors = assured_errors(group, quantity.order_in)
    i = quickest([solution.wall_s for solution in group], errors, wanted)
    reached = errors[i] <= wanted
    return QuickestSettings(case, quantity.name, problem, wanted, reached, errors[i], group[i])
