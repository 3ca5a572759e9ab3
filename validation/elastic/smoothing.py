"""Theory of the damping of small vibrations by the transfers between particles and grid.

On a grid full of particles a wave exp(i k x) loses the factor s = (sin(k h/2)/(k h/2))^m in every
interpolation with a spline (m = 3 for quadratic, 4 for cubic splines). Let V be the amplitude of
the grid's velocity before forces, q the amplitude of the displacement, and Omega the frequency of
the grid without smoothing. A step is

    w = V - dt Omega^2 q,  q <- q + dt w,  V <- g V - f dt Omega^2 q.

FLIP with the ratio a returns the change of velocity, smoothed twice, and keeps the share a of the
unresolved rest: f = s^2, g = 1 - (1 - a)(1 - s^2). APIC passes all of w to the particles and back,
with the slope within each cell: f = g = s^2 + (ds/dk)^2/D, D = h^2/4 or h^2/3. The amplitude falls
by the root of the step's determinant,

    g - dt^2 Omega^2 (g - f),  Omega^2 = omega^2/f,

that is 1 - (1 - s^2) dt^2 Omega^2 even for pure FLIP: forces move the particles' positions without
smoothing, but the changes of their velocities are smoothed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from snowshed.snow.accuracy.measurements import CaseSettings


@dataclass(frozen=True)
class Smoothing:
    """The effect of a transfer of velocities on a wave of small amplitude.

    Attributes
    ----------
    velocity_share
        g, the share of the velocity that remains after a step.
    force_share
        f, the share of the forces that changes the velocity.
    """

    velocity_share: float
    force_share: float

    @classmethod
    def of(cls, settings: CaseSettings, wavenumber: float) -> Smoothing:
        """Return the smoothing of a wave.

        Parameters
        ----------
        settings
            "dx", "basis", "transfer" and for FLIP "flip_ratio".
        wavenumber
            k, 1/m.

        Examples
        --------
        PIC loses (k h/2)^2 of a long wave's velocity in every step.

        >>> pic = {"transfer": "flip", "flip_ratio": 0.0, "dx": 0.1, "basis": "quadratic"}
        >>> round((1 - Smoothing.of(pic, 0.1).velocity_share) / (0.1 * 0.1 / 2) ** 2, 3)
        1.0
        """
        dx, quadratic = float(settings["dx"]), settings["basis"] == "quadratic"
        factors = 3 if quadratic else 4
        half = wavenumber * dx / 2
        wave = math.sin(half) / half
        once = wave**factors
        if settings["transfer"] == "apic":
            slope = factors * wave ** (factors - 1) * (math.cos(half) - wave) / half / 2  # over dx
            affine = once**2 + slope**2 * (4 if quadratic else 3)
            return cls(velocity_share=affine, force_share=affine)
        lost = (1 - float(settings["flip_ratio"])) * (1 - once**2)
        return cls(velocity_share=1 - lost, force_share=once**2)

    def loss_per_period(self, frequency: float, time_step: float) -> float:
        """Return the share of the amplitude that is lost per period.

        Parameters
        ----------
        frequency
            Hz.
        time_step
            s.
        """
        angle = (2 * math.pi * frequency * time_step) ** 2 / self.force_share
        step = self.velocity_share - angle * (self.velocity_share - self.force_share)
        return -math.expm1(math.log(step) / (2 * frequency * time_step))
