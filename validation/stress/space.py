"""Parameters of the stress suite, with their ranges, extremes and reference values."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Union

import numpy as np

Value = Union[str, int, float]

#: Values of all parameters of `PARAMETERS` by name.
Point = Mapping[str, Value]


@dataclass(frozen=True)
class Range:
    """A parameter with a numerical range.

    Parameters
    ----------
    name, title, unit:
        Key, heading and unit.
    low, high:
        Extremes, which are tried singly and pairwise.
    reference:
        Value in the reference scene.
    log:
        Whether random values are log-uniform, as for ranges of several decades.
    is_integer:
        Whether values are integers.
    """

    name: str
    title: str
    unit: str
    low: float
    high: float
    reference: float
    log: bool = False
    is_integer: bool = False

    @property
    def levels(self) -> tuple[Value, ...]:
        """Reference and extremes, with the reference first."""
        others = [v for v in (self.low, self.high) if v != self.reference]
        return tuple(self._rounded(v) for v in (self.reference, *others))

    def draw(self, random: np.random.Generator) -> Value:
        """Return a random value."""
        if self.log:
            exponent = random.uniform(math.log(self.low), math.log(self.high))
            return self._rounded(min(max(math.exp(exponent), self.low), self.high))
        return self._rounded(float(random.uniform(self.low, self.high)))

    def _rounded(self, value: float) -> Value:
        return round(value) if self.is_integer else float(value)


@dataclass(frozen=True)
class Choice:
    """A parameter with a few values, which are all tried; the first is the reference."""

    name: str
    title: str
    levels: tuple[Value, ...]

    @property
    def reference(self) -> Value:
        """Value in the reference scene."""
        return self.levels[0]

    def draw(self, random: np.random.Generator) -> Value:
        """Return a random value."""
        return self.levels[int(random.integers(len(self.levels)))]


Parameter = Union[Range, Choice]

#: Kinds of scenes, which `scenes` builds.
KINDS = {
    "slide": "slab slides off the panel onto the ground, a chunk of snow thrown onto it",
    "throw": "block of snow thrown onto the ground",
    "plate": "block of snow thrown onto a thin free-standing plate",
    "collide": "two blocks collide in free flight",
    "single": "one particle thrown onto the ground",
    "coincident": "two blocks with pairwise coincident particles thrown onto the ground",
}

PARAMETERS: tuple[Parameter, ...] = (
    Choice("kind", "Scene", tuple(KINDS)),
    Range("youngs_modulus", "Young's modulus E", "Pa", 1e4, 1e9, 1e6, log=True),
    Range("poissons_ratio", "Poisson's ratio nu", "", 0.0, 0.49, 0.3),
    Range("density", "Density", "kg/m3", 10.0, 917.0, 210.0, log=True),
    Range("hardening_factor", "Hardening factor xi", "", 1e-3, 50.0, 0.1, log=True),
    Range("critical_state_slope", "Critical state slope M", "", 0.0, 2.0, 0.5),
    Range("cohesion", "Cohesion beta", "", 0.0, 1.0, 0.2),
    Range(
        "preconsolidation_pressure", "Preconsolidation pressure p0", "Pa", 1.0, 1e6, 7e3, log=True
    ),
    Choice("model", "Law", ("cam_clay", "elastic")),
    Range("tilt", "Tilt of panel or plate", "degrees", 1.0, 89.0, 50.0),
    Range("ground_tilt", "Tilt of the ground", "degrees", -45.0, 45.0, 0.0),
    Range("friction", "Friction coefficient", "", 0.0, 2.0, 0.3),
    Choice("condition", "Condition of panel or plate", ("separate", "slip", "sticky")),
    Choice("ground_condition", "Condition of the ground", ("sticky", "separate", "slip")),
    Range("speed", "Speed of thrown snow", "m/s", 0.1, 100.0, 2.0, log=True),
    Range("thickness", "Thickness of the snow", "m", 0.005, 1.0, 0.06, log=True),
    Range("cells", "Cells across the snow", "", 1, 6, 3, is_integer=True),
    Range("plate_cells", "Thickness of panel or plate in cells", "", 0.01, 4.0, 1.0, log=True),
    Range("particles_per_voxel", "Particles per voxel", "", 1, 8, 6, is_integer=True),
    Choice("pattern", "Seeding pattern", ("poisson", "jittered", "regular")),
    Choice("dimension", "Dimension", (2, 3)),
    Choice("transfer", "Transfer", ("flip", "apic")),
    Range("flip_ratio", "FLIP ratio", "", 0.0, 1.0, 0.99),
    Choice("basis", "Basis", ("quadratic", "cubic")),
    Choice("precision", "Precision", ("float", "double")),
    Range("courant_factor", "Courant factor", "", 0.01, 1.0, 0.9, log=True),
    Range("strain_limit", "Strain limit", "", 1e-3, 0.5, 0.2, log=True),
    Choice("sleep_speed", "Sleep speed, m/s", (0.02, 0.0, 0.1)),
    Choice("between", "Between the two events", ("carry", "reseed")),
)


def reference() -> dict[str, Value]:
    """Return the point from which single parameters are varied.

    Examples
    --------
    >>> reference()["youngs_modulus"]
    1000000.0
    """
    return {p.name: p.levels[0] for p in PARAMETERS}
