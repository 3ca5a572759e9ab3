"""What tables and figures call the parameters of a scene: symbols, and units that read well."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Word:
    """How a parameter is written.

    Attributes
    ----------
    symbol
        Short, as the thesis writes it.
    name
        In words.
    unit
        Of the values as they are shown; empty for plain numbers.
    scale
        By how much values in SI units are divided to be shown.
    """

    symbol: str
    name: str
    unit: str = ""
    scale: float = 1.0

    @property
    def label(self) -> str:
        """Symbol and unit, for an axis."""
        return f"{self.symbol}, {self.unit}" if self.unit else self.symbol

    def value(self, number: float) -> str:
        """Return a value without its unit."""
        return f"{number / self.scale:.4g}"


WORDS: Mapping[str, Word] = {
    "snow.critical_state_slope": Word("M", "internal friction"),
    "snow.preconsolidation_pressure": Word("p₀", "preconsolidation pressure", "kPa", 1e3),
    "snow.cohesion": Word("β", "cohesion factor"),
    "snow.hardening_factor": Word("ξ", "hardening factor"),
    "snow.youngs_modulus": Word("E", "Young's modulus", "MPa", 1e6),
    "seeding.seed": Word("seeding", "placement of the particles"),
    "panel.friction": Word("panel friction", "panel friction"),
    "panel.tilt": Word("panel tilt", "panel tilt", "degrees"),
}


def word(path: str) -> Word:
    """Return how a parameter is written; others than the known ones by their path.

    Examples
    --------
    >>> word("snow.preconsolidation_pressure").label
    'p₀, kPa'
    >>> word("snow.preconsolidation_pressure").value(7000)
    '7'
    >>> word("slab.length").label
    'slab.length'
    """
    return WORDS.get(path, Word(path, path))


def setting(values: Mapping[str, float]) -> str:
    """Return values of some parameters as one text.

    Examples
    --------
    >>> setting({"snow.cohesion": 0.2, "snow.youngs_modulus": 1e6})
    'β 0.2, E 1 MPa'
    """
    return ", ".join(
        f"{word(path).symbol} {word(path).value(value)} {word(path).unit}".rstrip()
        for path, value in values.items()
        if np.isfinite(value)
    )
