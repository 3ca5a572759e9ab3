"""A rigid slab that slides off the edge of an inclined panel, tips and falls.

A point mass would leave the panel as soon as it passes the edge. The edge supports a slab until its
last part has passed, so the slab flies a little further and turns. Both effects follow,
independently of the material point method, from Newton's equations of a rigid rectangle whose
bottom face slides over a fixed edge.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from snowshed.base.arrays import Floats


@dataclass(frozen=True)
class Landing:
    """Place and time of a slab's landing, and its spin.

    Attributes
    ----------
    distance
        Horizontal distance of the centre of mass from the panel's edge, m.
    time_s
        Time since the slab was released, s.
    spin
        Angular velocity in flight, nose down, rad/s.
    """

    distance: float
    time_s: float
    spin: float


@dataclass(frozen=True)
class RigidSlab:
    """Slab that starts from rest on a panel, which is too steep for friction to hold it.

    Attributes
    ----------
    length, thickness
        m; the width does not matter.
    tilt
        Tilt of the panel, degrees.
    friction
        Coulomb coefficient.
    sliding_distance
        Distance along the slope from the centre of mass to the edge, m.
    gravity
        m/s2.

    Examples
    --------
    A slab without extent is a point mass; from a level edge it would fall 1 m in 0.4515 s.

    >>> landing = RigidSlab(1e-6, 1e-6, tilt=40, friction=0, sliding_distance=1).landing(drop=1)
    >>> speed = math.sqrt(2 * 9.81 * math.sin(math.radians(40)))
    >>> down, along = (speed * f(math.radians(40)) for f in (math.sin, math.cos))
    >>> time_s = (math.sqrt(down**2 + 2 * 9.81) - down) / 9.81
    >>> abs(landing.distance / (along * time_s) - 1) < 1e-5
    True
    """

    length: float
    thickness: float
    tilt: float
    friction: float
    sliding_distance: float
    gravity: float = 9.81

    def landing(self, drop: float) -> Landing:
        """Return the landing, when the centre of mass is `drop` m below the edge.

        Raises
        ------
        ValueError
            If friction holds the slab on the panel.
        """
        if self.acceleration <= 0:
            raise ValueError(f"friction {self.friction:g} holds the slab at {self.tilt:g} degrees")
        start, position, velocity, spin, departure_time = self._departure()
        x, z = self._to_horizontal(position)
        along, up = self._to_horizontal(velocity)
        fall_time = (up + math.sqrt(up**2 + 2 * self.gravity * (z + drop))) / self.gravity
        return Landing(x + along * fall_time, start + departure_time + fall_time, spin)

    @property
    def acceleration(self) -> float:
        """Acceleration down the slope while the whole slab lies on the panel, m/s2."""
        pull, press = self._gravity
        return float(pull + self.friction * press)

    @property
    def _gravity(self) -> Floats:
        """Gravity down the slope and normal to it, m/s2."""
        tilt = math.radians(self.tilt)
        return self.gravity * np.array([math.sin(tilt), -math.cos(tilt)])

    @property
    def _inertia(self) -> float:
        """Moment of inertia over mass, m2."""
        return (self.length**2 + self.thickness**2) / 12

    def _to_horizontal(self, vector: Floats) -> tuple[float, float]:
        """Return a vector with components (down the slope, normal to it) as (x, z)."""
        tilt = math.radians(self.tilt)
        along, off = vector
        x = along * math.cos(tilt) + off * math.sin(tilt)
        return float(x), float(off * math.cos(tilt) - along * math.sin(tilt))

    def _rates(self, state: Floats) -> tuple[float, float, float]:
        """Return the edge's normal force over mass, and the accelerations of both coordinates.

        The state has two coordinates, each followed by its rate: the distance by which the centre
        of mass has passed the edge along the slab's face, and the angle by which the slab has
        tipped. Friction mu N along the face and the normal force N act at the edge, half the
        thickness below the centre of mass: I angle'' = N (past + mu thickness/2).
        """
        past, speed, angle, turn = state
        half = self.thickness / 2
        face = np.array([math.cos(angle), -math.sin(angle)])
        across = np.array([math.sin(angle), math.cos(angle)])
        arm = past + self.friction * half
        push = -self._gravity @ across - 2 * speed * turn - half * turn**2
        push /= 1 + past * arm / self._inertia
        turning = push * arm / self._inertia
        sliding = self._gravity @ face - self.friction * push - half * turning + past * turn**2
        return float(push), float(sliding), float(turning)

    def _departure(self) -> _Departure:
        """Return the state in which the slab leaves the edge, after it has slid and tipped."""
        from scipy.integrate import solve_ivp

        half = self.thickness / 2
        distance = self.sliding_distance - self.friction * half
        speed = math.sqrt(2 * self.acceleration * distance)

        def rates(_: float, state: Floats) -> list[float]:
            _, sliding, turning = self._rates(state)
            return [state[1], sliding, state[3], turning]

        def passed(_: float, state: Floats) -> float:
            return float(state[0] - self.length / 2)

        def lifted(_: float, state: Floats) -> float:
            return self._rates(state)[0]

        passed.terminal = lifted.terminal = True  # type: ignore[attr-defined]
        start = [-self.friction * half, speed, 0.0, 0.0]
        longest = 10 * self.length / speed
        events = [passed, lifted]
        solution = solve_ivp(rates, (0, longest), start, events=events, rtol=1e-11, atol=1e-13)
        past, speed_now, angle, turn = solution.y[:, -1]
        face = np.array([math.cos(angle), -math.sin(angle)])
        across = np.array([math.sin(angle), math.cos(angle)])
        position = past * face + half * across
        velocity = (speed_now + half * turn) * face - past * turn * across
        tip_start = speed / self.acceleration
        return _Departure(tip_start, position, velocity, float(turn), float(solution.t[-1]))


class _Departure(NamedTuple):
    """State in which a slab leaves the edge, with vectors (down the slope, normal to it)."""

    tip_time: float
    position: Floats
    velocity: Floats
    spin: float
    departure_time: float  # s after it began to tip
