"""Criteria of the cases for errors and orders of convergence, and the results."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import inf, isnan, nan
from typing import TYPE_CHECKING, Optional

from snowshed.snow.accuracy.measurements import CaseSettings
from snowshed.snow.accuracy.solutions import records, rows_of, solutions
from validation.framework.case import Case, Quantity, SettingsFilter, alternatives
from validation.framework.convergence import convergences

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class Criterion:
    """Criterion for a quantity, and its worst result.

    Attributes
    ----------
    kind
        ``"error"`` (limited above) or ``"order"`` of convergence (limited below).
    demanded, worst
        The limit, and the worst measured value (NaN if a measurement failed, None if there is no
        value).
    settings
        Settings of the worst value.
    count
        Number of errors or orders that were compared with the criterion.
    """

    case: str
    quantity: Quantity
    kind: str
    demanded: float
    worst: Optional[float]
    settings: CaseSettings
    count: int

    @property
    def applies_to(self) -> SettingsFilter:
        """Settings to which the criterion applies; for an order, without the size that varies."""
        order_in = self.quantity.order_in if self.kind == "order" else None
        return {name: value for name, value in self.quantity.limit_for.items() if name != order_in}

    @property
    def holds(self) -> Optional[bool]:
        """Whether the criterion holds; None if no measurement concerns it."""
        if self.worst is None:
            return None
        return self.worst >= self.demanded if self.kind == "order" else self.worst <= self.demanded


def compare(table: pd.DataFrame, cases: Iterable[Case]) -> list[Criterion]:
    """Return every criterion of the cases, compared with the measurements."""
    criteria = []
    for case in cases:
        for quantity in case.quantities:
            rows = rows_of(table, case.name, quantity.name)
            if quantity.limit is not None:
                criteria.append(_error_criterion(case.name, quantity, quantity.limit, rows))
            if quantity.min_order is not None and quantity.order_in is not None:
                criteria.append(_order_criterion(case.name, quantity, quantity.min_order, rows))
    return criteria


def _error_criterion(case: str, quantity: Quantity, limit: float, rows: pd.DataFrame) -> Criterion:
    """Return the criterion for errors: every measurement is within the limit, and none failed."""
    measured = [row for row in records(rows) if _matches(row.settings, quantity.limit_for)]
    if not measured:
        return Criterion(case, quantity, "error", limit, None, {}, 0)
    worst = max(measured, key=lambda row: inf if isnan(row.error) else abs(row.error))
    return Criterion(
        case, quantity, "error", limit, abs(worst.error), worst.settings, len(measured)
    )


def _order_criterion(case: str, quantity: Quantity, limit: float, rows: pd.DataFrame) -> Criterion:
    """Return the criterion for orders: every series converges fast enough, and none failed."""
    order_in = quantity.order_in or ""
    required = {name: value for name, value in quantity.limit_for.items() if name != order_in}
    orders = [
        (convergence.order, convergence.settings)
        for convergence in convergences(solutions(rows), order_in)
    ]
    orders += [(nan, row.settings) for row in records(rows) if isnan(row.error)]
    orders = [(order, settings) for order, settings in orders if _matches(settings, required)]
    if not orders:
        return Criterion(case, quantity, "order", limit, None, {}, 0)
    order, settings = min(orders, key=lambda pair: -inf if isnan(pair[0]) else pair[0])
    return Criterion(case, quantity, "order", limit, order, settings, len(orders))


def _matches(settings: CaseSettings, required: SettingsFilter) -> bool:
    return all(settings.get(name) in alternatives(value) for name, value in required.items())
