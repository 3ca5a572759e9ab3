"""The cohesive Cam-Clay law of the material point method (thesis 1.2.5-1.2.7).

Hardening is computed by the core. The yield stress at a pressure and that of confined compression
are closed forms of (1.2.6), which the core does not need.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

import snowshed._core as _core
from snowshed.base.arrays import Floats
from snowshed.scene.components import Snow


@dataclass(frozen=True)
class Elasticity:
    """Elastic constants.

    Attributes
    ----------
    youngs_modulus
        Young's modulus E, Pa.
    poissons_ratio
        Poisson's ratio nu.
    """

    youngs_modulus: float
    poissons_ratio: float

    @property
    def bulk_modulus(self) -> float:
        """K of the hardening law (1.2.7), Pa."""
        return self.youngs_modulus / (3 - 6 * self.poissons_ratio)

    @property
    def confined_modulus(self) -> float:
        """Stress over strain without sideways strain, Pa."""
        nu = self.poissons_ratio
        return self.youngs_modulus * (1 - nu) / ((1 + nu) * (1 - 2 * nu))

    def hardened(self, p0: float, factor: float, compaction: Floats) -> Floats:
        """Return p0 after plastic volumetric compaction, Pa: K sinh(asinh(p0/K) + xi e)."""
        law = self._hardening(factor)
        return law.preconsolidation(law.initial_plastic_strain(p0) - compaction)

    def dilation_at_strength_loss(self, p0: float, factor: float) -> float:
        """Return the plastic dilation at which the strength is lost: asinh(p0/K)/xi."""
        return -self._hardening(factor).initial_plastic_strain(p0)

    def _hardening(self, factor: float) -> _core.CamClay:
        """Return a law with this hardening; M and beta do not matter for it."""
        return _core.CamClay(self.youngs_modulus, self.poissons_ratio, 1.0, 0.0, factor)


@dataclass(frozen=True)
class CamClayFit:
    """The parameters of the law.

    Attributes
    ----------
    density
        Density, kg/m3.
    elastic
        Elastic constants, E and nu.
    critical_state_slope, preconsolidation_pressure, cohesion, hardening_factor
        Parameters M, p0 (Pa), beta and xi.
    """

    density: float
    elastic: Elasticity
    critical_state_slope: float
    preconsolidation_pressure: float
    cohesion: float
    hardening_factor: float

    @classmethod
    def of(cls, snow: Snow) -> CamClayFit:
        """Return the law of a complete snow."""
        data = {name: float(value) for name, value in snow.to_data().items() if name != "model"}  # type: ignore[arg-type]
        elastic = Elasticity(data.pop("youngs_modulus"), data.pop("poissons_ratio"))
        return cls(elastic=elastic, **data)

    @property
    def snow(self) -> Snow:
        """The snow of a scene."""
        return Snow(
            density=self.density,
            youngs_modulus=self.elastic.youngs_modulus,
            poissons_ratio=self.elastic.poissons_ratio,
            critical_state_slope=self.critical_state_slope,
            preconsolidation_pressure=self.preconsolidation_pressure,
            cohesion=self.cohesion,
            hardening_factor=self.hardening_factor,
        )

    @property
    def wave_speed(self) -> float:
        """Speed of elastic waves, m/s; the number of time steps is proportional to it."""
        return math.sqrt(self.elastic.confined_modulus / self.density)

    @property
    def dilation_at_strength_loss(self) -> float:
        """Plastic dilation at which the strength is lost."""
        return self.elastic.dilation_at_strength_loss(
            self.preconsolidation_pressure, self.hardening_factor
        )

    def hardened(self, compaction: Floats) -> Floats:
        """Return the pressure of isotropic compression after a plastic compaction, Pa."""
        p0, factor = self.preconsolidation_pressure, self.hardening_factor
        return self.elastic.hardened(p0, factor, compaction)

    def yield_stress(self, pressure: Floats) -> Floats:
        """Return q on the yield surface, Pa, at pressures between -beta p0 and p0."""
        p0, beta = self.preconsolidation_pressure, self.cohesion
        inside = np.maximum((pressure + beta * p0) * (p0 - pressure), 0.0)
        return np.asarray(self.critical_state_slope * np.sqrt(inside / (1 + 2 * beta)))

    def confined_yield(self) -> float:
        """Return the axial stress at which confined compression yields, Pa.

        Examples
        --------
        >>> round(CamClayFit(210, Elasticity(1e6, 0.3), 0.5, 7e3, 0.2, 0.1).confined_yield())
        3030
        """
        p0, beta = self.preconsolidation_pressure, self.cohesion
        side = self.elastic.poissons_ratio / (1 - self.elastic.poissons_ratio)
        per_p, per_q = (1 + 2 * side) / 3, 1 - side  # of the axial stress
        a = (1 + 2 * beta) * per_q**2 + (self.critical_state_slope * per_p) ** 2
        b = self.critical_state_slope**2 * per_p * (beta - 1) * p0
        c = -(self.critical_state_slope**2) * beta * p0**2
        return (-b + math.sqrt(b**2 - 4 * a * c)) / (2 * a)
