"""Solutions of a problem: accuracy and cost of each choice of settings.

Errors count by their absolute value. Random seedings of the same settings are combined to one
solution.
"""

from __future__ import annotations

from collections.abc import Collection, Hashable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple, Optional

import numpy as np

from snowshed.snow.accuracy.measurements import CaseSettings, setting_names

if TYPE_CHECKING:
    import pandas as pd

#: Settings that only select another random sample.
SEEDING_SETTINGS = ("seed", "seedings")


class SolutionRow(NamedTuple):
    """A row of the table."""

    settings: CaseSettings
    error: float
    wall_s: float


@dataclass(frozen=True)
class Solution:
    """A solution with one choice of settings, over all its random seedings.

    Attributes
    ----------
    settings
        All settings except those in `SEEDING_SETTINGS`.
    error
        Root mean square of the errors.
    wall_s
        Mean time of the solution, s.
    """

    settings: CaseSettings
    error: float
    wall_s: float


def rows_of(table: pd.DataFrame, case: str, quantity: str) -> pd.DataFrame:
    """Return the rows of one quantity of a case."""
    return table[(table["case"] == case) & (table["quantity"] == quantity)]


def records(rows: pd.DataFrame) -> list[SolutionRow]:
    """Return rows of the table, each with the settings that it has."""
    names = setting_names(rows)
    return [
        SolutionRow(
            {name: row[name] for name in names if row[name] is not None},
            *(float(row[name]) for name in SolutionRow._fields[1:]),
        )
        for row in rows.to_dict("records")
    ]


def solutions(rows: pd.DataFrame) -> list[Solution]:
    """Return the solutions for one quantity; failed measurements are left out.

    Parameters
    ----------
    rows
        Rows of one quantity of one case.
    """
    groups: dict[Hashable, list[SolutionRow]] = {}
    for row in records(rows[rows["error"].notna()]):
        groups.setdefault(settings_key(row.settings, without=SEEDING_SETTINGS), []).append(row)
    return [_solution(group) for group in groups.values()]


def settings_key(settings: CaseSettings, *, without: Collection[str] = ()) -> Hashable:
    """Return a key that is equal for equal settings in any order.

    Examples
    --------
    >>> settings_key({"dx": 0.1, "seed": 1}, without=["seed"]) == settings_key({"dx": 0.1})
    True
    """
    return tuple(sorted((name, v) for name, v in settings.items() if name not in without))


def convergence_series(solved: Iterable[Solution], order_in: str) -> list[list[Solution]]:
    """Return groups of solutions that differ in one setting only, each from coarse to fine."""
    groups: dict[Hashable, list[Solution]] = {}
    for solution in solved:
        if order_in in solution.settings:
            groups.setdefault(settings_key(solution.settings, without=(order_in,)), []).append(
                solution
            )
    return [
        sorted(group, key=lambda solution: -float(solution.settings[order_in]))
        for group in groups.values()
    ]


def assured_errors(solved: Sequence[Solution], order_in: Optional[str]) -> list[float]:
    """Return for each solution the largest error of it and of all finer ones.

    A coarse solution may be right by chance, which does not count: an accuracy is reached only if
    every finer solution with equal other settings reaches it, too.

    Parameters
    ----------
    solved
        Solutions for one quantity.
    order_in
        The setting that refines a solution as it falls; None: the errors are used directly.
    """
    assured = {id(solution): abs(solution.error) for solution in solved}
    for group in convergence_series(solved, order_in) if order_in else []:
        worst = 0.0
        for finer in reversed(group):
            worst = assured[id(finer)] = max(worst, abs(finer.error))
    return [assured[id(solution)] for solution in solved]


def quickest(costs: Sequence[float], errors: Sequence[float], wanted: float) -> int:
    """Return the index of the cheapest accurate solution, or else of the most accurate one.

    Examples
    --------
    >>> [quickest([1.0, 2.0, 9.0], [0.2, 0.04, 0.03], wanted) for wanted in (0.1, 0.01)]
    [1, 2]
    """
    good = [i for i, error in enumerate(errors) if error <= wanted]
    if good:
        return min(good, key=lambda i: costs[i])
    return min(range(len(errors)), key=lambda i: (errors[i], costs[i]))


def _solution(group: Sequence[SolutionRow]) -> Solution:
    return Solution(
        settings={k: v for k, v in group[0].settings.items() if k not in SEEDING_SETTINGS},
        error=float(np.sqrt(np.mean([row.error**2 for row in group]))),
        wall_s=float(np.mean([row.wall_s for row in group])),
    )
