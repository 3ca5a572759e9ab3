"""Chosen motions with large strains, and the body forces that cause them.

The method of manufactured solutions: a displacement u(X, t) of an elastic body is chosen, and the
body force that Newton's law then requires, b = u'' - Div P/rho0, is applied to every particle. The
two motions are those of K. Kamojjala, R. Brannon, A. Sadeghirad, J. Guilkey, *Verification tests in
solid mechanics*, Engineering with Computers 31 (2015), with profiles that are smoother at the ends
of the moving part, and with the Hencky elasticity of the snow: Kirchhoff stress tau = 2 mu e +
lambda tr(e) I of the logarithmic strain e, P = tau F^-T.

Points, displacements, velocities and forces are arrays (n, 2) of (x, z), in SI units. X is a
particle's initial position; all bodies are the unit square from (0, 0) to (1, 1) m.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Union

import numpy as np

from snowshed.base.arrays import Floats

YOUNGS_MODULUS, DENSITY = 1e6, 210.0  # Pa, kg/m3
#: Speed of waves in a rod, sqrt(E/rho0), m/s.
WAVE_SPEED = math.sqrt(YOUNGS_MODULUS / DENSITY)


class ManufacturedMotion(ABC):
    """Chosen motion that oscillates with sin(omega t), omega = pi c."""

    #: Poisson's ratio of the moving body.
    poissons_ratio: float
    #: Angular frequency, 1/s; half a period is the time of a wave across the square.
    omega = math.pi * WAVE_SPEED

    @abstractmethod
    def displacement(self, points: Floats, time: float) -> Floats:
        """Return the displacement u(X, t), m."""

    @abstractmethod
    def velocity(self, points: Floats, time: float) -> Floats:
        """Return the velocity du/dt of particles that started at X, m/s."""

    @abstractmethod
    def body_force(self, points: Floats, time: float) -> Floats:
        """Return the body force per mass on particles that started at X, m/s2."""


@dataclass(frozen=True)
class AxialWaves(ManufacturedMotion):
    """Stretching and squeezing along the axes, by turns: u_x = g(t) f(X), u_z = -g(t) f(Z).

    With g = A sin(omega t) and f(X) = sin kX - sin(2 kX)/2, k = 2 pi. f, f' and f'' vanish at the
    square's sides. As Poisson's ratio is 0, the two directions are uncoupled, and no traction is
    needed at the sides. F' below is dF/dX of the stretch F = 1 + g f'; the only stress in its
    direction is P = E ln(F)/F, hence dP/dX = E (1 - ln F)/F^2 F'.

    Attributes
    ----------
    amplitude
        Amplitude A, m. The stretches go from 1 - 4 pi A to 1 + 4 pi A.

    Examples
    --------
    >>> waves = AxialWaves(0.02)
    >>> waves.displacement(np.array([[0.25, 0.25]]), 0.5 / WAVE_SPEED).round(6).tolist()
    [[0.02, -0.02]]
    """

    amplitude: float
    poissons_ratio = 0.0
    _senses = np.array([1.0, -1.0])
    _k = 2 * math.pi

    def displacement(self, points: Floats, time: float) -> Floats:
        """Return the displacement u(X, t), m."""
        return np.asarray(self._swing(time) * self._profile(points)[0])

    def velocity(self, points: Floats, time: float) -> Floats:
        """Return the velocity du/dt of particles that started at X, m/s."""
        rate = self._senses * self.amplitude * self.omega * math.cos(self.omega * time)
        return np.asarray(rate * self._profile(points)[0])

    def body_force(self, points: Floats, time: float) -> Floats:
        """Return the body force per mass on particles that started at X, m/s2."""
        profile, slope, curvature = self._profile(points)
        swing = self._swing(time)
        stretch = 1 + swing * slope
        stress = YOUNGS_MODULUS * (1 - np.log(stretch)) / stretch**2 * swing * curvature
        return np.asarray(-(self.omega**2) * swing * profile - stress / DENSITY)

    def _swing(self, time: float) -> Floats:
        """Return g(t) for both directions."""
        return np.asarray(self._senses * self.amplitude * math.sin(self.omega * time))

    def _profile(self, points: Floats) -> tuple[Floats, Floats, Floats]:
        """Return f and its first two derivatives; sin(2 k X)/2 is sin kX cos kX."""
        k = self._k
        sin, cos = np.sin(k * points), np.cos(k * points)
        slope = k * (1 + cos - 2 * cos**2)
        return sin * (1 - cos), slope, k**2 * sin * (4 * cos - 1)


@dataclass(frozen=True)
class Vortex(ManufacturedMotion):
    """Rotation of rings about the square's centre, each by its own angle.

    A particle at the radius R turns by alpha = A sin(omega t) (1 - (R/R1)^2)^4, R < R1 = 0.45 m;
    particles outside do not move. In axes that turn with the particle, F is a simple shear by s = R
    dalpha/dR. Its Hencky strain has no trace, so Poisson's ratio matters through mu alone, and

        P = mu kappa [[-s/2, 1 + s^2/2], [1, -s/2]],  kappa = 2 asinh(s/2)/sqrt(1 + s^2/4)

    (rows: radial and tangential force, columns: radial and tangential face). The divergence of P is
    -mu (d(kappa s/2)/dR + kappa s/R) radially and mu (dkappa/dR + 2 kappa/R) tangentially.

    Attributes
    ----------
    angle
        Angle A by which the centre turns, rad. The shear s reaches 0.84 A.

    Examples
    --------
    >>> vortex = Vortex(1.0)
    >>> turned = vortex.displacement(np.array([[0.5, 0.6], [0.5, 1.0]]), 0.5 / WAVE_SPEED)
    >>> turned.round(3).tolist()
    [[-0.073, -0.032], [0.0, 0.0]]
    """

    angle: float
    poissons_ratio = 0.3
    _centre, _radius = 0.5, 0.45

    def displacement(self, points: Floats, time: float) -> Floats:
        """Return the displacement u(X, t), m."""
        radius, heading = self._polar(points)
        turned = heading + self.angle * math.sin(self.omega * time) * self._profile(radius)[0]
        return self._centre + _vector(radius, 0.0, turned) - points

    def velocity(self, points: Floats, time: float) -> Floats:
        """Return the velocity du/dt of particles that started at X, m/s."""
        radius, heading = self._polar(points)
        profile = self.angle * self._profile(radius)[0]
        turned = heading + math.sin(self.omega * time) * profile
        turning = self.omega * math.cos(self.omega * time) * profile
        return _vector(0.0, radius * turning, turned)

    def body_force(self, points: Floats, time: float) -> Floats:
        """Return the body force per mass on particles that started at X, m/s2."""
        radius, heading = self._polar(points)
        profile, slope, curvature = self._profile(radius)
        swing = self.angle * math.sin(self.omega * time)
        turning = self.angle * self.omega * math.cos(self.omega * time) * profile
        radial, tangential = self._stress(radius, swing * slope, swing * curvature)
        return _vector(
            -radius * turning**2 - radial / DENSITY,
            -(self.omega**2) * radius * swing * profile - tangential / DENSITY,
            heading + swing * profile,
        )

    def _stress(self, radius: Floats, slope: Floats, curvature: Floats) -> tuple[Floats, Floats]:
        """Return the radial and tangential components of Div P (Pa/m) from alpha' and alpha''."""
        shear = radius * slope
        half = shear / 2
        shear_rate = slope + radius * curvature
        kappa = 2 * np.arcsinh(half) / np.sqrt(1 + half**2)
        kappa_rate = (1 - half * kappa / 2) / (1 + half**2) * shear_rate
        mu = YOUNGS_MODULUS / (2 * (1 + self.poissons_ratio))
        radial = -mu * (kappa_rate * half + kappa * shear_rate / 2 + kappa * slope)
        tangential = mu * (kappa_rate + 2 * kappa / np.maximum(radius, 1e-12))
        return radial, tangential

    def _profile(self, radius: Floats) -> tuple[Floats, Floats, Floats]:
        """Return alpha/(A sin(omega t)) and its first two derivatives in R."""
        part = radius / self._radius
        inside = np.maximum(1 - part**2, 0.0)
        slope = -8 * part * inside**3 / self._radius
        curvature = (48 * part**2 * inside**2 - 8 * inside**3) / self._radius**2
        return inside**4, slope, curvature

    def _polar(self, points: Floats) -> tuple[Floats, Floats]:
        x, z = (points - self._centre).T
        return np.hypot(x, z), np.arctan2(z, x)


def _vector(
    radial: Union[Floats, float], tangential: Union[Floats, float], heading: Floats
) -> Floats:
    """Return the (x, z) of vectors whose components are along and across some headings."""
    cos, sin = np.cos(heading), np.sin(heading)
    return np.stack([radial * cos - tangential * sin, radial * sin + tangential * cos], axis=1)
