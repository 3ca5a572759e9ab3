"""Cases: problems with known answers, and ways of solving them.

A module of cases makes one `Case`, or several. `measure_cases` passes every entry of its matrix of
settings to `Case.measure`, in a separate process, and the report compares the results.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Optional, Union

from snowshed.base.formatting import number, percent
from snowshed.snow.accuracy.measurements import CaseSettings, Measured, Value

#: Values that settings must have, by name; None: must not be given; a tuple: any of its values.
SettingsFilter = Mapping[str, Union[Value, tuple[Optional[Value], ...], None]]


def alternatives(
    value: Union[Value, tuple[Optional[Value], ...], None],
) -> tuple[Optional[Value], ...]:
    """Return the allowed values of a setting.

    Examples
    --------
    >>> alternatives("flip"), alternatives(("flip", None))
    (('flip',), ('flip', None))
    """
    return value if isinstance(value, tuple) else (value,)


@dataclass(frozen=True)
class Quantity:
    """Measured quantity and its criteria.

    Parameters
    ----------
    name:
        Key, such as ``"acceleration"``.
    title:
        Name in texts, with the unit if it has one.
    limit:
        Largest allowed error; None: any error is allowed.
    limit_for:
        Settings to which the limit applies: each must have the value given here. With None, the
        setting must not be given.
    order_in:
        Setting with which the error follows a power law (``"dx"``, ``"courant_factor"``), if any.
    min_order:
        The smallest order of convergence allowed.
    relative:
        Whether the error is relative to the exact value (shown in %); otherwise it has the
        quantity's unit.
    """

    name: str
    title: str
    limit: Optional[float] = None
    limit_for: SettingsFilter = field(default_factory=dict)
    order_in: Optional[str] = None
    min_order: Optional[float] = None
    relative: bool = True

    def error_text(self, error: Optional[float]) -> str:
        """Return the text of an error, in percent or in the quantity's unit."""
        return percent(error) if self.relative else number(error)


@dataclass(frozen=True)
class Outcome:
    """Results of one entry of the matrix.

    ``wall_s`` is the time of the solution alone, without seeding, imports and evaluation.
    ``updates`` is the number of particles times steps, or of increments for a material path.
    """

    measured: Sequence[Measured]
    wall_s: float
    updates: int
    steps: int = 0
    particles: int = 0


@dataclass(frozen=True)
class Case:
    """Problem with a known answer.

    Parameters
    ----------
    name, title:
        Key and heading.
    source:
        Source of the answer: closed form, equation, paper.
    description:
        A paragraph for the report: the problem, the answer, the definition of the error.
    quantities:
        All quantities that `measure` returns.
    matrix:
        ``matrix(full)`` returns the settings to solve with. All solutions of the quick list take
        seconds.
    measure:
        Function that solves the problem once. The result must depend on the settings alone.
    remarks:
        Weaknesses of the method in this case, and their causes; the report prints them with the
        numbers.
    """

    name: str
    title: str
    source: str
    description: str
    quantities: Sequence[Quantity]
    matrix: Callable[[bool], list[CaseSettings]]
    measure: Callable[[CaseSettings], Outcome]
    remarks: str = ""
