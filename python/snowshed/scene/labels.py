"""Symbols, names and units of parameters, for tables, figures and messages."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from snowshed.scene.schema import parameter_units

#: Units of the schema, and their form on display.
SHOWN_UNITS: Mapping[str, str] = {"degrees": "°", "kg/m3": "kg/m³", "m/s2": "m/s²"}


@dataclass(frozen=True)
class Label:
    """The name, symbol and unit of a parameter.

    Attributes
    ----------
    name
        Name of the parameter.
    symbol
        Short symbol, as in the thesis; otherwise the name.
    unit
        Unit of the values on display; empty for plain numbers.
    scale
        Divisor from values in SI units to values on display.
    """

    name: str
    symbol: str = ""
    unit: str = ""
    scale: float = 1.0

    @property
    def axis(self) -> str:
        """Symbol and unit, for an axis or the head of a column."""
        return f"{self.symbol}, {self.unit}" if self.unit else self.symbol

    @property
    def title(self) -> str:
        """Name and symbol."""
        return self.name if self.symbol == self.name else f"{self.name} {self.symbol}"

    def value(self, number: float, digits: int = 4) -> str:
        """Return a value without its unit."""
        return f"{number / self.scale:.{digits}g}"

    def quantity(self, number: float, digits: int = 4) -> str:
        """Return a value with its unit."""
        return self._with_unit(self.value(number, digits))

    def change(self, before: float, after: float) -> str:
        """Return two values with their unit."""
        return self._with_unit(f"{self.value(before)} → {self.value(after)}")

    def _with_unit(self, text: str) -> str:
        return text + ("" if self.unit in ("", "°") else " ") + self.unit


#: Name and symbol of each parameter, and the unit and scale where they differ from the schema's.
LABELS: Mapping[str, Label] = {
    "dimension": Label("dimension"),
    "event": Label("event"),
    "panel.height": Label("panel height"),
    "panel.length": Label("panel length"),
    "panel.width": Label("panel width"),
    "panel.tilt": Label("panel tilt"),
    "panel.condition": Label("panel, boundary condition"),
    "panel.friction": Label("panel friction"),
    "ground.tilt": Label("ground tilt"),
    "ground.condition": Label("ground, boundary condition"),
    "slab.thickness": Label("slab thickness"),
    "slab.length": Label("slab length"),
    "slab.width": Label("slab width"),
    "snow.density": Label("density"),
    "snow.youngs_modulus": Label("Young's modulus", "E", "MPa", 1e6),
    "snow.poissons_ratio": Label("Poisson's ratio", "nu"),
    "snow.critical_state_slope": Label("internal friction", "M"),
    "snow.preconsolidation_pressure": Label("preconsolidation pressure", "p₀", "kPa", 1e3),
    "snow.cohesion": Label("cohesion factor", "β"),
    "snow.hardening_factor": Label("hardening factor", "ξ"),
    "seeding.seed": Label("placement of the particles", "seeding"),
    "numerics.dx": Label("grid size", "dx"),
    "events.count": Label("events"),
    "events.between": Label("stack between events"),
    "events.max_time": Label("longest event"),
}


@functools.cache
def label(path: str) -> Label:
    """Return the label of a parameter; without an entry in `LABELS` its name is the path.

    Examples
    --------
    >>> label("snow.preconsolidation_pressure").axis
    'p₀, kPa'
    >>> label("snow.preconsolidation_pressure").quantity(7000)
    '7 kPa'
    >>> label("events.rest_speed").axis
    'events.rest_speed, m/s'
    """
    entry = LABELS.get(path, Label(path))
    unit = entry.unit or parameter_units().get(path, "")
    return Label(entry.name, entry.symbol or entry.name, SHOWN_UNITS.get(unit, unit), entry.scale)


def settings_text(values: Mapping[str, float]) -> str:
    """Return parameters with their values as one text; values that are not finite are left out.

    Examples
    --------
    >>> settings_text({"snow.cohesion": 0.2, "snow.youngs_modulus": 1e6, "panel.tilt": 40})
    'β 0.2, E 1 MPa, panel tilt 40°'
    """
    return ", ".join(
        f"{label(path).symbol} {label(path).quantity(value)}"
        for path, value in values.items()
        if np.isfinite(value)
    )
