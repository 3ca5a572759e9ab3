"""A column of snow layers that may settle under its own weight."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Optional

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.snow.relations.settling import SettlingLaw, settled_densities

#: Largest number of layers, more than a winter of hourly snowfalls has. If there are more, the
#: lower half is merged in pairs, so that snow of many years costs no more than that of one.
MAX_LAYERS = 1000


@dataclass
class SnowColumn:
    """Layers of snow, the lowest first.

    Parameters
    ----------
    load_factor
        Stress, Pa, under a load of 1 kg/m2: gravity, or its part normal to a slope.

    Examples
    --------
    >>> column = SnowColumn(load_factor=9.81)
    >>> column.add(20.0, 100.0)
    >>> column.add(10.0, 50.0)
    >>> column.mass, column.thickness, column.density
    (30.0, 0.4, 75.0)
    """

    load_factor: float
    masses: Floats = field(default_factory=lambda: np.zeros(0))  # kg/m2 of each layer
    densities: Floats = field(default_factory=lambda: np.zeros(0))  # kg/m3

    @property
    def mass(self) -> float:
        """Mass of all layers, kg/m2."""
        return float(self.masses.sum())

    @property
    def thickness(self) -> float:
        """Thickness of all layers, m."""
        return float((self.masses / self.densities).sum())

    @property
    def density(self) -> float:
        """Mean density, kg/m3; NaN without snow."""
        return self.mass / self.thickness if self.thickness else math.nan

    def add(self, mass: float, density: float) -> None:
        """Lay a layer of a mass, kg/m2, and a density, kg/m3, on top."""
        if mass > 0.0:
            self.masses = np.append(self.masses, mass)
            self.densities = np.append(self.densities, density)
        if len(self.masses) > MAX_LAYERS:
            self._merge()

    def melt(self, mass: float) -> None:
        """Take a mass, kg/m2, away from the top.

        Examples
        --------
        >>> column = SnowColumn(load_factor=9.81)
        >>> column.add(20.0, 100.0), column.add(10.0, 50.0), column.melt(15.0)
        (None, None, None)
        >>> column.masses.tolist()
        [15.0]
        """
        above = np.cumsum(self.masses[::-1])[::-1] - self.masses
        left = np.clip(self.masses - np.maximum(mass - above, 0.0), 0.0, None)
        self.masses, self.densities = left[left > 0.0], self.densities[left > 0.0]

    def clear(self) -> None:
        """Remove all snow."""
        self.masses, self.densities = np.zeros(0), np.zeros(0)

    def settle(self, law: Optional[SettlingLaw], seconds: float, temperature: float) -> None:
        """Let the layers settle for some time at a temperature, degrees C; None: no settling."""
        if law is None or not len(self.masses):
            return
        stress = self.load_factor * (np.cumsum(self.masses[::-1])[::-1] - 0.5 * self.masses)
        self.densities = settled_densities(law, self.densities, stress, seconds, temperature)

    def _merge(self) -> None:
        """Merge the layers of the lower half in pairs, with the same mass and thickness."""
        half = 2 * (len(self.masses) // 4)
        thick = self.masses / self.densities
        masses = self.masses[:half].reshape(-1, 2).sum(axis=1)
        thickness = thick[:half].reshape(-1, 2).sum(axis=1)
        self.masses = np.concatenate([masses, self.masses[half:]])
        self.densities = np.concatenate([masses / thickness, self.densities[half:]])
