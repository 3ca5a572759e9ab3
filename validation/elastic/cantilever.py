"""Slowest bending vibration of a clamped beam, by Timoshenko's and by Euler's theory."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from snowshed.base.arrays import Floats


@dataclass(frozen=True)
class Cantilever:
    """Beam of rectangular section in plane strain, clamped at x = 0 and free at its other end.

    Quantities are per metre of width. In plane strain, E/(1 - nu^2) replaces Young's modulus, and
    nu' = nu/(1 - nu) replaces Poisson's ratio. Timoshenko's theory has four states along the beam:
    deflection w, rotation psi, moment M and shear force Q,

        w' = psi + Q/(k G H),  psi' = M/(E I),  M' = -Q - rho I omega^2 psi,  Q' = -rho H omega^2 w,

    and Cowper's shear coefficient k = 10 (1 + nu')/(12 + 11 nu') (G. R. Cowper, *The shear
    coefficient in Timoshenko's beam theory*, Journal of Applied Mechanics 33, 1966). At an
    eigenfrequency w = psi = 0 at the clamp and M = Q = 0 at the free end hold together.

    Attributes
    ----------
    length, height
        m.
    youngs_modulus, poissons_ratio, density
        Constants of the material; Pa, 1, kg/m3.

    Examples
    --------
    A slender beam vibrates at Euler's frequency.

    >>> slender = Cantilever(1.0, 0.001, 1e6, 0.3, 210.0)
    >>> round(slender.frequency / slender.euler_frequency, 5)
    1.0
    >>> thick = Cantilever(1.0, 0.2, 1e6, 0.3, 210.0)
    >>> round(thick.frequency / thick.euler_frequency, 3)
    0.968
    """

    length: float
    height: float
    youngs_modulus: float
    poissons_ratio: float
    density: float

    @property
    def euler_frequency(self) -> float:
        """Frequency of a slender beam, Hz.

        omega L^2 sqrt(rho H/(E I)) = 3.516, the square of the first root of 1 + cosh x cos x = 0.
        """
        slenderness = self._bending / (self.density * self.height)
        return float(1.8751040687**2 / self.length**2 * math.sqrt(slenderness) / (2 * math.pi))

    @cached_property
    def frequency(self) -> float:
        """Frequency by Timoshenko's theory, Hz."""
        from scipy.optimize import brentq

        slender = self.euler_frequency
        return float(brentq(self._misfit, 0.3 * slender, 1.001 * slender, xtol=1e-12 * slender))

    def shape(self, points: Floats) -> tuple[Floats, Floats]:
        """Return deflection w and rotation psi of the slowest vibration along the beam.

        Parameters
        ----------
        points
            Distances x from the clamp, m.

        Returns
        -------
        tuple
            w, which is 1 at the free end, and psi, 1/m.
        """
        from scipy.linalg import expm

        rates = self._rates(self.frequency)
        end = expm(rates * self.length)
        # M(L) = 0 fixes the ratio of M and Q at the clamp.
        start = np.array([0.0, 0.0, -end[2, 3], end[2, 2]])
        states = np.array([expm(rates * x) @ start for x in points]) / (end @ start)[0]
        return states[:, 0], states[:, 1]

    @property
    def _bending(self) -> float:
        """E I, N m2 per metre of width."""
        return self.youngs_modulus / (1 - self.poissons_ratio**2) * self.height**3 / 12

    def _rates(self, frequency: float) -> Floats:
        """Return the matrix that takes the states (w, psi, M, Q) to their derivatives."""
        nu = self.poissons_ratio / (1 - self.poissons_ratio)
        shear = self.youngs_modulus / (2 * (1 + self.poissons_ratio)) * self.height
        shear *= 10 * (1 + nu) / (12 + 11 * nu)
        inertia = self.density * self.height * (2 * math.pi * frequency) ** 2
        return np.array(
            [
                [0.0, 1.0, 0.0, 1 / shear],
                [0.0, 0.0, 1 / self._bending, 0.0],
                [0.0, -inertia * self.height**2 / 12, 0.0, -1.0],
                [-inertia, 0.0, 0.0, 0.0],
            ]
        )

    def _misfit(self, frequency: float) -> float:
        """Return a determinant, which is zero at eigenfrequencies: M(L) = Q(L) = 0 is possible."""
        from scipy.linalg import expm

        end = expm(self._rates(frequency) * self.length)[2:, 2:]
        return float(np.linalg.det(end))
