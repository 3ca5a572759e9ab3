"""The measures of a stack, their names, and their columns in tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Optional

from snowshed._core import InputError
from snowshed.snow.stack.trimming import TRIMMINGS

#: Lengths of a stack for comparisons, calibrations and figures, m.
QUANTITIES = ("height", "length", "head", "tail")


@dataclass(frozen=True)
class Measure:
    """A definition of the stack.

    Attributes
    ----------
    name
        Name of the measure in options.
    label
        Description of the measure.
    prefix
        Prefix of its columns.
    trimming
        Trimming rule of the measure; None: that of the table's column ``trimming``.

    Examples
    --------
    >>> MEASURES["body"].column("height")
    'body_height_m'
    """

    name: str
    label: str
    prefix: str = ""
    trimming: Optional[str] = None

    def column(self, quantity: str) -> str:
        """Return the column of one of `QUANTITIES`, in m."""
        return f"{self.prefix}{quantity}_m"

    def columns(self, quantities: Sequence[str]) -> dict[str, str]:
        """Return the quantity that each column holds."""
        return {self.column(quantity): quantity for quantity in quantities}


MEASURES: Mapping[str, Measure] = {
    measure.name: measure
    for measure in (
        Measure("stack", "97 % of the snow"),
        Measure("body", "the largest connected body of snow", "body_"),
        *(
            Measure(name, f"97 % of the snow, trimmed {name.replace('_', ' ')}", f"{name}_", name)
            for name in TRIMMINGS
        ),
    )
}


def measure_named(name: str) -> Measure:
    """Return one of `MEASURES`; raises InputError for an unknown name."""
    if name not in MEASURES:
        raise InputError(f"measure: {name!r} is unknown; allowed: {', '.join(MEASURES)}")
    return MEASURES[name]
