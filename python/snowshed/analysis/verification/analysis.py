"""What the measurements say: orders of convergence, Pareto fronts, cheapest settings, bars.

All functions take tables as `snowshed.analysis.verification.measurements.to_table` makes them, or what `solutions`
makes of one quantity's rows, and change nothing. Errors count by their size. Random seedings of the
same settings are one way of solving and are taken together.
"""

from __future__ import annotations

from collections.abc import Collection, Hashable, Iterable, Sequence
from dataclasses import dataclass
from math import inf, isnan, nan
from typing import TYPE_CHECKING, NamedTuple, Optional

import numpy as np
from validation.schemes import SAMPLING, problem_of

from snowshed.analysis.verification.case import Case, Quantity, Settings
from snowshed.analysis.verification.measurements import settings_of
from snowshed.io.arrays import Booleans, Floats

if TYPE_CHECKING:
    import pandas as pd

#: Accuracies for which the cheapest settings are looked up.
WANTED = (0.10, 0.05, 0.02, 0.01)


class Row(NamedTuple):
    """A row of the table."""

    settings: Settings
    error: float
    wall_s: float


@dataclass(frozen=True)
class Solution:
    """One way of solving, over all its random seedings.

    Attributes
    ----------
    settings
        All but those in `SAMPLING`.
    error
        Root mean square.
    wall_s
        Mean time of the solution, s.
    """

    settings: Settings
    error: float
    wall_s: float


@dataclass(frozen=True)
class Convergence:
    """How an error falls with a setting, all others equal.

    Attributes
    ----------
    settings
        The other settings.
    sizes, errors
        The setting's values, from the coarsest to the finest, and the errors.
    order
        Slope of the least-squares line through their logarithms; NaN if it is not defined.
    pairwise
        Slope between neighbours, one fewer than the sizes.
    """

    settings: Settings
    sizes: Floats
    errors: Floats
    order: float
    pairwise: Floats


@dataclass(frozen=True)
class Cheapest:
    """The quickest way to a wanted accuracy; the best there is where none reached it.

    Attributes
    ----------
    problem
        The settings that make the problem.
    error
        Assured by all finer solutions (`assured_errors`).
    """

    case: str
    quantity: str
    problem: Settings
    wanted: float
    reached: bool
    error: float
    solution: Solution


@dataclass(frozen=True)
class Bar:
    """A demand on a quantity, and what was found.

    Attributes
    ----------
    kind
        ``"error"`` (the largest allowed) or ``"order"`` of convergence (the smallest allowed).
    demanded, found
        The bar, and the worst that was measured (NaN if that failed; None if nothing was).
    settings
        Those of the worst.
    count
        How many errors or orders were compared with the bar.
    """

    case: str
    quantity: Quantity
    kind: str
    demanded: float
    found: Optional[float]
    settings: Settings
    count: int

    @property
    def meant(self) -> Settings:
        """The settings that the demand is for; an order is not for one size alone."""
        order_in = self.quantity.order_in if self.kind == "order" else None
        return {name: value for name, value in self.quantity.bar_for.items() if name != order_in}

    @property
    def holds(self) -> Optional[bool]:
        """Whether the bar holds; None if nothing was measured that it is for."""
        if self.found is None:
            return None
        return self.found >= self.demanded if self.kind == "order" else self.found <= self.demanded


def rows_of(table: pd.DataFrame, case: str, quantity: str) -> pd.DataFrame:
    """Return the rows of one quantity of a case."""
    return table[(table["case"] == case) & (table["quantity"] == quantity)]


def solutions(rows: pd.DataFrame) -> list[Solution]:
    """Return the ways in which one quantity was solved for; failed measurements are left out.

    Parameters
    ----------
    rows
        Of one quantity of one case.
    """
    groups: dict[Hashable, list[Row]] = {}
    for row in _records(rows[rows["error"].notna()]):
        groups.setdefault(key_of(row.settings, without=SAMPLING), []).append(row)
    return [_solution(group) for group in groups.values()]


def key_of(settings: Settings, *, without: Collection[str] = ()) -> Hashable:
    """Return what equal settings have in common, whatever their order.

    Examples
    --------
    >>> key_of({"dx": 0.1, "seed": 1}, without=["seed"]) == key_of({"dx": 0.1})
    True
    """
    return tuple(sorted((name, v) for name, v in settings.items() if name not in without))


def varying(settings: Iterable[Settings]) -> list[str]:
    """Return the names of the settings in which several choices differ, in order of appearance.

    Examples
    --------
    >>> varying([{"dx": 0.1, "basis": "cubic"}, {"dx": 0.2, "basis": "cubic"}])
    ['dx']
    """
    listed = list(settings)
    names = dict.fromkeys(name for one in listed for name in one)
    return [name for name in names if len({one.get(name) for one in listed}) > 1]


def observed_order(sizes: Floats, errors: Floats) -> float:
    """Return the order of convergence: the least-squares slope of log error over log size.

    NaN with fewer than two different sizes, or where an error is zero or not finite.

    Examples
    --------
    >>> round(observed_order(np.array([0.4, 0.2, 0.1]), 3 * np.array([0.16, 0.04, 0.01])), 6)
    2.0
    """
    errors = np.abs(errors)
    if len(set(sizes)) < 2 or not np.all((errors > 0) & np.isfinite(errors)):
        return nan
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])


def pairwise_orders(sizes: Floats, errors: Floats) -> Floats:
    """Return the slope of log error over log size between neighbours.

    Examples
    --------
    >>> pairwise_orders(np.array([0.4, 0.2, 0.1]), np.array([0.8, 0.4, 0.1])).round(6).tolist()
    [1.0, 2.0]
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        slopes: Floats = np.diff(np.log(np.abs(errors))) / np.diff(np.log(sizes))
    return slopes


def convergences(found: Sequence[Solution], order_in: str) -> list[Convergence]:
    """Return how the error falls with a setting such as ``"dx"``, for each choice of the others."""
    series = []
    for group in _alike(found, order_in):
        if len(group) > 1:
            sizes = np.array([float(one.settings[order_in]) for one in group])
            errors = np.array([abs(one.error) for one in group])
            others = {k: v for k, v in group[0].settings.items() if k != order_in}
            order, pairwise = observed_order(sizes, errors), pairwise_orders(sizes, errors)
            series.append(Convergence(others, sizes, errors, order, pairwise))
    return series


def assured_errors(found: Sequence[Solution], order_in: Optional[str]) -> list[float]:
    """Return for each solution the largest error that it or any finer one like it has.

    A coarse solution may be right by chance. That does not count: an accuracy is reached where
    every finer solution, all other settings equal, reaches it too.

    Parameters
    ----------
    found
        Solutions for one quantity.
    order_in
        The setting that makes a solution finer as it falls; None: the errors stand as they are.
    """
    assured = {id(one): abs(one.error) for one in found}
    for group in _alike(found, order_in) if order_in else []:
        worst = 0.0
        for one in reversed(group):
            worst = assured[id(one)] = max(worst, abs(one.error))
    return [assured[id(one)] for one in found]


def pareto_front(costs: Sequence[float], errors: Sequence[float]) -> Booleans:
    """Return which points no other point beats in both cost and error.

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


def by_problem(case: Case, found: Iterable[Solution]) -> list[tuple[Settings, list[Solution]]]:
    """Return the problems among solutions, each with all ways in which it was solved."""
    groups: dict[Hashable, tuple[Settings, list[Solution]]] = {}
    for one in found:
        problem = problem_of(case, one.settings)
        groups.setdefault(key_of(problem), (problem, []))[1].append(one)
    return list(groups.values())


def cheapest(
    table: pd.DataFrame, cases: Iterable[Case], wanted: Sequence[float] = WANTED
) -> list[Cheapest]:
    """Return the quickest way to each accuracy.

    For each quantity with a relative error and each problem that was solved in several ways.
    """
    return [
        _cheapest(case.name, quantity, problem, found, accuracy)
        for case in cases
        for quantity in case.quantities
        if quantity.relative
        for problem, found in by_problem(case, solutions(rows_of(table, case.name, quantity.name)))
        if len(found) > 1
        for accuracy in wanted
    ]


def _cheapest(
    case: str, quantity: Quantity, problem: Settings, found: Sequence[Solution], wanted: float
) -> Cheapest:
    errors = assured_errors(found, quantity.order_in)
    i = quickest([one.wall_s for one in found], errors, wanted)
    reached = errors[i] <= wanted
    return Cheapest(case, quantity.name, problem, wanted, reached, errors[i], found[i])


def quickest(costs: Sequence[float], errors: Sequence[float], wanted: float) -> int:
    """Return the index of the cheapest whose error is small enough, or of the smallest error.

    Examples
    --------
    >>> [quickest([1.0, 2.0, 9.0], [0.2, 0.04, 0.03], wanted) for wanted in (0.1, 0.01)]
    [1, 2]
    """
    good = [i for i, error in enumerate(errors) if error <= wanted]
    if good:
        return min(good, key=lambda i: costs[i])
    return min(range(len(errors)), key=lambda i: (errors[i], costs[i]))


def bars(table: pd.DataFrame, cases: Iterable[Case]) -> list[Bar]:
    """Compare every demand of the cases with what was measured."""
    found = []
    for case in cases:
        for quantity in case.quantities:
            rows = rows_of(table, case.name, quantity.name)
            if quantity.bar is not None:
                found.append(_error_bar(case.name, quantity, quantity.bar, rows))
            if quantity.least_order is not None and quantity.order_in is not None:
                found.append(_order_bar(case.name, quantity, quantity.least_order, rows))
    return found


def _error_bar(case: str, quantity: Quantity, demanded: float, rows: pd.DataFrame) -> Bar:
    """Every single measurement must be within the bar; one that failed is not."""
    meant = [row for row in _records(rows) if _matches(row.settings, quantity.bar_for)]
    if not meant:
        return Bar(case, quantity, "error", demanded, None, {}, 0)
    worst = max(meant, key=lambda row: inf if isnan(row.error) else abs(row.error))
    return Bar(case, quantity, "error", demanded, abs(worst.error), worst.settings, len(meant))


def _order_bar(case: str, quantity: Quantity, demanded: float, rows: pd.DataFrame) -> Bar:
    """Every series must converge fast enough; one with a failed measurement does not."""
    order_in = quantity.order_in or ""
    demand = {name: value for name, value in quantity.bar_for.items() if name != order_in}
    meant = [(one.order, one.settings) for one in convergences(solutions(rows), order_in)]
    meant += [(nan, row.settings) for row in _records(rows) if isnan(row.error)]
    meant = [(order, settings) for order, settings in meant if _matches(settings, demand)]
    if not meant:
        return Bar(case, quantity, "order", demanded, None, {}, 0)
    order, settings = min(meant, key=lambda one: -inf if isnan(one[0]) else one[0])
    return Bar(case, quantity, "order", demanded, order, settings, len(meant))


def _records(rows: pd.DataFrame) -> list[Row]:
    names = settings_of(rows)
    return [
        Row(
            {name: row[name] for name in names if row[name] is not None},
            *(float(row[name]) for name in Row._fields[1:]),
        )
        for row in rows.to_dict("records")
    ]


def _solution(group: Sequence[Row]) -> Solution:
    return Solution(
        settings={k: v for k, v in group[0].settings.items() if k not in SAMPLING},
        error=float(np.sqrt(np.mean([row.error**2 for row in group]))),
        wall_s=float(np.mean([row.wall_s for row in group])),
    )


def _alike(found: Iterable[Solution], order_in: str) -> list[list[Solution]]:
    """Return the solutions that differ in one setting only, from the coarsest to the finest."""
    groups: dict[Hashable, list[Solution]] = {}
    for one in found:
        if order_in in one.settings:
            groups.setdefault(key_of(one.settings, without=(order_in,)), []).append(one)
    return [
        sorted(group, key=lambda one: -float(one.settings[order_in])) for group in groups.values()
    ]


def _matches(settings: Settings, wanted: Settings) -> bool:
    return all(settings.get(name) == value for name, value in wanted.items())
