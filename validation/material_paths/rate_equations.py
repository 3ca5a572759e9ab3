"""Rate equations of cohesive Modified Cam-Clay snow, integrated by an adaptive Runge-Kutta method.

The module checks the return mapping independently and shares nothing with the core: stress and
strain are principal values instead of p and q, and the plastic multiplier comes from the
consistency condition instead of a projection. With yield function y, stress tau, elastic stiffness
C and the volumetric plastic strain e_v (thesis 1.2.5-1.2.7; flow is associative, compression
positive in p and negative in e_v):

    plastic strain rate = g dy/dtau,    e_v' = tr(plastic strain rate),
    g = (dy/dtau : C : rate) / (dy/dtau : C : dy/dtau - dy/de_v tr(dy/dtau)).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from snowshed.base.arrays import Floats

#: Integration of softening snow ends at this fraction of the initial strength; below, stress and
#: strength vanish together, and rounding destroys their ratio.
MIN_STRENGTH_SHARE = 1e-3
RELATIVE_TOLERANCE = 1e-12  # of the integrated solution
ABSOLUTE_TOLERANCE = 1e-15  # of integrated strains


@dataclass(frozen=True)
class RateEquations:
    """Constants of the constitutive law.

    Attributes
    ----------
    youngs_modulus
        E, Pa.
    poissons_ratio, critical_state_slope, cohesion, hardening_factor
        nu, M, beta, xi.
    dimension
        2 (invariants in the plane, as in a 2D scene) or 3.

    Examples
    --------
    Snow that is compressed equally on all sides yields at p = p0 and then hardens.

    >>> snow = RateEquations(1e6, 0.3, 0.5, 0.2, 0.1, dimension=3)
    >>> start = snow.initial_state(7e3)
    >>> path = snow.integrate(start, np.full(3, -1 / 3), np.array([0.005, 0.02]))
    >>> p, q = snow.invariants(path)
    >>> p.round(3).tolist(), np.allclose(q, 0, atol=1e-6)
    ([4166.667, 7878.82], True)
    """

    youngs_modulus: float
    poissons_ratio: float
    critical_state_slope: float
    cohesion: float
    hardening_factor: float
    dimension: int

    @property
    def shear_modulus(self) -> float:
        """Shear modulus mu, Pa."""
        return self.youngs_modulus / (2 * (1 + self.poissons_ratio))

    @property
    def stiffness(self) -> Floats:
        """Matrix from principal Hencky strains to principal Kirchhoff stresses, Pa, (d, d)."""
        nu = self.poissons_ratio
        first_lame = self.youngs_modulus * nu / ((1 + nu) * (1 - 2 * nu))
        return first_lame + 2 * self.shear_modulus * np.eye(self.dimension)

    @property
    def hardening_modulus(self) -> float:
        """Bulk modulus K of (1.2.7), Pa."""
        return self.youngs_modulus / (3 - 6 * self.poissons_ratio)

    def strength(self, ev: float) -> float:
        """Return the strength p0 (Pa) by (1.2.7) from the volumetric plastic strain."""
        return self.hardening_modulus * math.sinh(self.hardening_factor * max(-ev, 0.0))

    def initial_state(self, strength: float, pressure: float = 0.0) -> Floats:
        """Return an isotropic state: elastic principal strains, volumetric plastic strain, (d + 1).

        Parameters
        ----------
        strength
            p0, Pa.
        pressure
            p, Pa, positive in compression.
        """
        plastic = -math.asinh(strength / self.hardening_modulus) / self.hardening_factor
        elastic = -pressure / self.stiffness.sum(axis=0)
        return np.append(elastic, plastic)

    def stress(self, states: Floats) -> Floats:
        """Return the principal Kirchhoff stresses, Pa, tension positive, (..., d)."""
        return np.asarray(states[..., :-1] @ self.stiffness)

    def invariants(self, states: Floats) -> tuple[Floats, Floats]:
        """Return pressure and Mises stress, Pa, of states (..., d + 1)."""
        stress = self.stress(states)
        pressure = -stress.mean(axis=-1)
        deviator = stress + pressure[..., np.newaxis]
        return pressure, np.sqrt(1.5 * (deviator**2).sum(axis=-1))

    def yield_function(self, state: Floats) -> float:
        """Return the yield function y of (1.2.6), Pa2."""
        p, q = self.invariants(state)
        p0 = self.strength(state[-1])
        shear = (1 + 2 * self.cohesion) * q**2
        return float(shear + self.critical_state_slope**2 * (p + self.cohesion * p0) * (p - p0))

    def integrate(self, start: Floats, rate: Floats, times: Floats) -> Floats:
        """Return the states at increasing times of a straight strain path.

        Parameters
        ----------
        start
            The state at time 0, inside the yield surface, (d + 1).
        rate
            Rate of the principal strains, (d). Once the path has reached the yield surface it must
            continue to load.
        times
            Times of the states, (n).

        Returns
        -------
        numpy.ndarray
            States, (n, d + 1).

        Raises
        ------
        ArithmeticError
            If the rate equations become singular, or if the strength nearly vanishes at a time.
        """
        yields = self._yield_time(start, rate, times[-1])
        later = times[times > yields]
        before = self._elastic(start, rate, times[times <= yields])
        if not len(later):
            return before
        solution = self._plastic(self._elastic(start, rate, yields), rate, yields, later)
        return np.vstack([before, solution])

    def _elastic(self, start: Floats, rate: Floats, times: Any) -> Floats:
        states: Floats = start + np.multiply.outer(times, np.append(rate, 0.0))
        return states

    def _yield_time(self, start: Floats, rate: Floats, end: float) -> float:
        """Return the time at which an elastic path yields, or `end`; y is convex along the path."""

        def overshoot(time: float) -> float:
            return self.yield_function(self._elastic(start, rate, time))

        if overshoot(end) <= 0:
            return end
        from scipy.optimize import brentq

        return float(brentq(overshoot, 0.0, end, xtol=1e-16, rtol=1e-15))

    def _plastic(self, start: Floats, rate: Floats, begin: float, times: Floats) -> Floats:
        def rates(_: float, state: Floats) -> Floats:
            return self._rates(state, rate)

        def strength_left(_: float, state: Floats) -> float:
            return float(state[-1] - MIN_STRENGTH_SHARE * start[-1])

        strength_left.terminal = True  # type: ignore[attr-defined]
        from scipy.integrate import solve_ivp

        solution = solve_ivp(
            rates,
            (begin, times[-1]),
            start,
            method="DOP853",
            t_eval=times,
            events=strength_left,
            rtol=RELATIVE_TOLERANCE,
            atol=ABSOLUTE_TOLERANCE,
        )
        if not solution.success:
            raise ArithmeticError(f"the rate equations became singular: {solution.message}")
        states: Floats = np.reshape(solution.y, (len(start), -1)).T
        if solution.status == 0:
            return states
        loose_states = self._loose(solution.y_events[0][0], rate, times - solution.t_events[0][0])
        return np.vstack([states, loose_states[len(states) :]])

    def _rates(self, state: Floats, rate: Floats) -> Floats:
        """Return the rates of the elastic strains and of e_v on the yield surface."""
        stress, p0 = self.stress(state), self.strength(state[-1])
        pressure = -stress.mean()
        slope2, beta, xi = self.critical_state_slope**2, self.cohesion, self.hardening_factor
        pressure_slope = slope2 * (2 * pressure - (1 - beta) * p0)
        strength_slope = slope2 * ((beta - 1) * pressure - 2 * beta * p0)
        hardening = -self.hardening_modulus * xi * math.cosh(xi * state[-1])
        normal = -pressure_slope / self.dimension + 3 * (1 + 2 * beta) * (stress + pressure)
        stiff_normal = self.stiffness @ normal
        resistance = normal @ stiff_normal - strength_slope * hardening * normal.sum()
        flow = max(0.0, float(stiff_normal @ rate)) / resistance * normal
        return np.append(rate - flow, flow.sum())

    def _loose(self, last: Floats, rate: Floats, after: Floats) -> Floats:
        """Return states at times `after` the loss of strength: no stress, only plastic strain."""
        unresolved = -2 * last[-1] / rate.sum()
        if np.any((after > 0) & (after < unresolved)):
            raise ArithmeticError("a time falls where the strength nearly vanishes; choose others")
        states = np.zeros((len(after), len(last)))
        states[:, -1] = last.sum() + after * rate.sum()
        return states


def evenly(end: float, count: int) -> Floats:
    """Return `count` times up to `end`, evenly spaced, without zero.

    Examples
    --------
    >>> evenly(1.0, 4).tolist()
    [0.25, 0.5, 0.75, 1.0]
    """
    return end * np.arange(1, count + 1) / count
