"""A published relation between quantities of snow: a function with its source."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Optional, TypeVar, Union

from snowshed._core import InputError

Span = tuple[float, float]
Chosen = TypeVar("Chosen")

ICE_DENSITY = 917.0  # kg/m3
UNITS = {"density": "kg/m3", "temperature": "degrees C", "wind": "m/s"}


@dataclass(frozen=True)
class Relation:
    """A relation from the literature; call it with the arguments that `ranges` names.

    Attributes
    ----------
    name
        Authors and year, in kebab case.
    quantity, unit
        Resulting quantity, and its unit.
    formula
        Formula, in plain text.
    source
        Publication, and other places of the formula.
    ranges
        Range of each argument, in order, in the units of `UNITS`. Beyond it, the relation still
        returns a number; `outside` reports it.
    scatter
        Description of its scatter.
    function
        The formula itself.
    range_verified
        Whether the publication states the range; else it is assumed from the data.

    Examples
    --------
    >>> density = {"density": (0, 9)}
    >>> double = Relation("a-2000", "twice", "", "2 rho", "A", density, "", lambda x: 2 * x)
    >>> double(3), double.outside(10)
    (6, ['density 10 kg/m3 (0 to 9)'])
    """

    name: str
    quantity: str
    unit: str
    formula: str
    source: str
    ranges: Mapping[str, Span]
    scatter: str
    function: Callable[..., float]
    range_verified: bool = True

    def __call__(self, *arguments: float) -> float:
        """Return the quantity.

        Raises
        ------
        InputError
            If an argument is not a value that snow can have.
        """
        for name, value in zip(self.ranges, arguments):
            _check(name, value, self.name)
        return self.function(*arguments)

    def outside(self, *arguments: float) -> list[str]:
        """Return a text for each argument outside the relation's range, with this range."""
        return [
            f"{name} {value:g} {UNITS[name]} ({low:g} to {high:g})"
            for (name, (low, high)), value in zip(self.ranges.items(), arguments)
            if not low <= value <= high
        ]


def choose(name: str, relations: Mapping[str, Chosen], where: str) -> Chosen:
    """Return the relation, or law, with a name.

    Raises
    ------
    InputError
        If the name is unknown; the message begins with `where` and lists the known names.
    """
    if name not in relations:
        raise InputError(f"{where}: {name!r} is unknown; allowed: {', '.join(relations)}")
    return relations[name]


def check_choice(name: str, given: Optional[str], allowed: Collection[str]) -> None:
    """Raise InputError at an argument that is neither None nor one of the allowed names."""
    if given is not None and given not in allowed:
        raise InputError(f"{name}: {given!r}; allowed: {', '.join(allowed)}, or None")


def by_name(*relations: Relation) -> dict[str, Relation]:
    """Return relations by their names."""
    return {relation.name: relation for relation in relations}


LIMITS: Mapping[str, Span] = {
    "density": (1.0, ICE_DENSITY),
    "temperature": (-100.0, 50.0),
    "wind": (0.0, 100.0),
}


def _check(name: str, value: Union[float, int], relation: str) -> None:
    low, high = LIMITS[name]
    if not (math.isfinite(value) and low <= value <= high):
        raise InputError(
            f"{relation}: {name} {value:g} is outside the allowed range "
            f"({low:g} <= value <= {high:g} {UNITS[name]})"
        )
