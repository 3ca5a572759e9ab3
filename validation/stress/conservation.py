"""Balances of momentum and energy of a run, computed outside the solver."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from snowshed import _core

#: Share of a cell. Heights have rounding errors, so errors of energy are relative to at least the
#: work of lifting all snow by this distance.
MIN_DROP = 1e-2

_SPENT = (
    "plastic_j",
    "friction_j",
    "sticking_j",
    "impact_j",
    "transfer_j",
    "sleep_j",
    "damping_j",
)


class Conservation:
    """Balances of momentum and energy of a simulation.

    The input of energy is that of thrown snow and the work of gravity. Kinetic and elastic energy
    can never exceed the input, and together with the spent energy they must equal it. Errors are
    relative to the whole input of the run.
    """

    def __init__(self, simulation: _core.Simulation, gravity: float, dx: float) -> None:
        self.simulation = simulation
        self.gravity = gravity
        self.dx = dx
        self._motion_input = 0.0  # J, motion of thrown snow, less the loss by reseeding
        self._thrown_energy = 0.0  # J, the same without the loss by reseeding
        self._initial_potential = 0.0  # J, gravitational energy of all snow where it was laid
        self._max_gravity_work = 0.0  # J, largest work of gravity in either direction
        self._residual = (0.0, 0.0)  # J, lowest and highest
        self._excess = (-math.inf, -math.inf)  # J, highest and last
        self._mass = 0.0  # kg
        self._momentum = np.zeros(3)  # kg m/s, of all snow when it was laid
        self._momentum_sum = 0.0  # kg m/s, sum of their magnitudes

    def begin(self, before: dict[str, float]) -> None:
        """Add the snow that an event has brought; `before` is the energy before the event."""
        after = self.simulation.energy()
        self._motion_input += _motion_energy(after) - _motion_energy(before)
        self._thrown_energy += max(after["kinetic_j"] - before["kinetic_j"], 0.0)
        self._initial_potential += after["gravitational_j"] - before["gravitational_j"]
        masses, velocities = self.simulation.masses(), self.simulation.velocities()
        self._mass = float(masses.sum())
        self._momentum = masses @ velocities
        self._momentum_sum = float(masses @ np.linalg.norm(velocities, axis=1))

    def sample(self) -> None:
        """Compare the present mass, momentum and energy with their inputs."""
        energy = self.simulation.energy()
        work = self._initial_potential - energy["gravitational_j"]
        excess = _motion_energy(energy) - self._motion_input - work
        residual = excess + sum(energy[name] for name in _SPENT)
        if not math.isfinite(residual):
            work, excess, residual = 0.0, math.inf, math.inf
        self._max_gravity_work = max(self._max_gravity_work, abs(work))
        self._excess = (max(self._excess[0], excess), excess)
        self._residual = (min(self._residual[0], residual), max(self._residual[1], residual))

    def energy_errors(self) -> dict[str, float]:
        """Return the errors of the energy balance, relative to the input.

        Returns
        -------
        dict
            ``energy_error``: largest |stored + spent - input|; ``energy_gain``: largest (stored +
            spent - input); ``stored_excess``: largest (stored - input); ``final_excess``: the last
            (stored - input).
        """
        least = self._mass * self.gravity * self.dx * MIN_DROP
        scale = max(self._thrown_energy + self._max_gravity_work, least)
        low, high = self._residual
        return {
            "energy_error": max(-low, high) / scale,
            "energy_gain": high / scale,
            "stored_excess": self._excess[0] / scale,
            "final_excess": self._excess[1] / scale,
        }

    def momentum_error(self, time_s: float) -> float:
        """Return the relative error of the momentum after a free flight of `time_s`."""
        now = self.simulation.masses() @ self.simulation.velocities()
        fallen = self._mass * self.gravity * time_s
        expected = self._momentum - np.array([0.0, 0.0, fallen])
        return float(np.linalg.norm(now - expected) / (self._momentum_sum + fallen))


def _motion_energy(energy: dict[str, Any]) -> float:
    return float(energy["kinetic_j"] + energy["elastic_j"])
