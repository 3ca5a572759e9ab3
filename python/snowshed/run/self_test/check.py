"""Checks: something measured, and the largest error that is allowed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from math import nan

from snowshed._core import InputError, SimulationError


@dataclass(frozen=True)
class Check:
    """A problem with a known answer.

    Attributes
    ----------
    title
        What is checked.
    bar
        The largest error allowed; 0 demands the same bits.
    measure
        Solve the problem and return the error, relative to the answer.
    """

    title: str
    bar: float
    measure: Callable[[], float]


@dataclass(frozen=True)
class Result:
    """The result of a check.

    Attributes
    ----------
    check
        The check.
    error
        As `Check.measure` returned it; NaN if it could not be measured.
    failure
        Why it could not be measured; empty if it was.
    """

    check: Check
    error: float
    failure: str = ""

    @property
    def holds(self) -> bool:
        """True if the error is within the bar."""
        return abs(self.error) <= self.check.bar


def run_checks(checks: Iterable[Check]) -> Iterator[Result]:
    """Yield the result of each check as soon as it is there.

    Examples
    --------
    >>> half = Check("half of one", bar=0.1, measure=lambda: 0.5)
    >>> [(result.error, result.holds) for result in run_checks([half])]
    [(0.5, False)]
    """
    for check in checks:
        try:
            yield Result(check, check.measure())
        except (InputError, SimulationError, OSError) as error:
            yield Result(check, nan, str(error))
