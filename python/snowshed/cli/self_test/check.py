"""Checks: a measured error and its tolerance."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import nan
from typing import Optional

from snowshed._core import InputError, SimulationError
from snowshed.base.progress import Progress, Reporter


@dataclass(frozen=True)
class Check:
    """A problem with a known answer.

    Attributes
    ----------
    title
        Name of the check.
    tolerance
        Largest allowed error; 0 requires the same bits.
    measure
        Function that solves the problem and returns the error, relative to the answer.
    """

    title: str
    tolerance: float
    measure: Callable[[], float]


@dataclass(frozen=True)
class Result:
    """The result of a check.

    Attributes
    ----------
    check
        The check.
    error
        The result of `Check.measure`; NaN if it could not be measured.
    failure
        Reason why the error could not be measured; empty if it was.
    """

    check: Check
    error: float
    failure: str = ""

    @property
    def holds(self) -> bool:
        """True if the error is within the tolerance."""
        return abs(self.error) <= self.check.tolerance


def run_checks(checks: Sequence[Check], progress: Optional[Reporter] = None) -> list[Result]:
    """Run checks one after another and return their results.

    Parameters
    ----------
    checks
        The checks.
    progress
        Called before each check.

    Examples
    --------
    >>> half = Check("half of one", tolerance=0.1, measure=lambda: 0.5)
    >>> [(result.error, result.holds) for result in run_checks([half])]
    [(0.5, False)]
    """
    results: list[Result] = []
    for done, check in enumerate(checks):
        if progress is not None:
            progress(Progress(done / len(checks), done, len(checks), "checks", check.title))
        results.append(_result(check))
    return results


def _result(check: Check) -> Result:
    try:
        return Result(check, check.measure())
    except (InputError, SimulationError, OSError) as error:
        return Result(check, nan, str(error))
