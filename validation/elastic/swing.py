"""Frequency and damping of a recorded vibration."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from snowshed.base.arrays import Floats


@dataclass(frozen=True)
class Swing:
    """Damped vibration A exp(-decay t) sin(2 pi frequency t + phase).

    Attributes
    ----------
    frequency
        Hz.
    decay
        1/s.
    """

    frequency: float
    decay: float

    @property
    def loss_per_period(self) -> float:
        """Share of the amplitude that is lost per period."""
        return -math.expm1(-self.decay / self.frequency)

    @classmethod
    def fit(cls, times: Floats, values: Floats, frequency: float) -> Swing:
        """Return the vibration that fits a record best, by least squares.

        Parameters
        ----------
        times
            s, shape (n,).
        values
            Deflections from zero, shape (n,); the vibration starts near zero.
        frequency
            Estimate of the frequency, Hz.

        Examples
        --------
        >>> t = np.linspace(0, 2, 101)
        >>> swing = Swing.fit(t, 3 * np.exp(-0.1 * t) * np.sin(2 * np.pi * 1.1 * t), frequency=1)
        >>> round(swing.frequency, 6), round(swing.decay, 6)
        (1.1, 0.1)
        """
        from scipy.optimize import curve_fit

        def swing(t: Floats, height: float, decay: float, turns: float, phase: float) -> Floats:
            return np.asarray(height * np.exp(-decay * t) * np.sin(2 * np.pi * turns * t + phase))

        # In units of period and amplitude, the four unknowns are of similar size.
        period, height = 1 / frequency, float(np.abs(values).max())
        start = (1.0, 0.0, 1.0, 0.0)
        parameters, _ = curve_fit(swing, times / period, values / height, p0=start)
        return cls(
            frequency=float(parameters[2]) * frequency, decay=float(parameters[1]) * frequency
        )
