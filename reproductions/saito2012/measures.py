"""Measures of the snow: its front, its deposit, and the share that passes an obstacle."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reproductions.saito2012.cases import Case
from reproductions.saito2012.runs import Snow
from snowshed.base.arrays import Booleans, Floats

MOVING_KIND = 0
#: Share of the moving snow behind the front; single grains run ahead of it.
FRONT_QUANTILE = 0.99
#: Largest distance above an obstacle of snow that it holds, m.
HELD_LENGTH = 0.8
#: Largest speed of this snow, m/s.
HELD_SPEED = 0.3
#: Largest mean speed of snow at rest, m/s.
REST_SPEED = 0.02


@dataclass(frozen=True)
class CaseHistory:
    """A case over time.

    Attributes
    ----------
    case, snow
        The case; the snow at each time.
    released
        Mask of the particles of the avalanche, without the erodible layer.
    """

    case: Case
    snow: Sequence[Snow]
    released: Booleans

    @classmethod
    def of(cls, case: Case, snow: Sequence[Snow]) -> CaseHistory:
        """Return the history of the stored states of a case, which must include the first."""
        return cls(case, snow, snow[0].kinds == MOVING_KIND)

    @property
    def times(self) -> Floats:
        """Times in s."""
        return np.array([state.time for state in self.snow])

    def at(self, time: float) -> Snow:
        """Return the snow at a time; raises LookupError if it is not stored."""
        for state in self.snow:
            if abs(state.time - time) < 0.5 * self.case.interval:
                return state
        raise LookupError(f"{self.case.name} at {time:g} s")

    def distances(self, snow: Snow) -> Floats:
        """Return the distances of the released snow along the profile, m."""
        return self.case.profile.along(snow.positions[self.released].astype(float))

    def front(self, snow: Snow) -> float:
        """Return the position of the front along the profile, m."""
        return float(np.quantile(self.distances(snow), FRONT_QUANTILE))

    def fronts(self) -> Floats:
        """Return the position of the front at all times, m."""
        return np.array([self.front(state) for state in self.snow])

    def speed(self, snow: Snow) -> float:
        """Return the mean speed of the released snow, m/s."""
        return float(np.linalg.norm(snow.velocities[self.released], axis=1).mean())

    def width(self, snow: Snow) -> float:
        """Return the width that holds 98 % of the released snow, m."""
        across = snow.positions[self.released][:, 1]
        return float(np.quantile(across, 0.99) - np.quantile(across, 0.01))

    def held(self, snow: Snow) -> float:
        """Return the share of the released snow that is slow and lies just above the obstacle."""
        assert self.case.obstacle is not None
        distances = self.distances(snow)
        near = (distances < self.case.obstacle) & (distances > self.case.obstacle - HELD_LENGTH)
        slow = np.linalg.norm(snow.velocities[self.released], axis=1) < HELD_SPEED
        return float((near & slow).mean())

    def passed(self, snow: Snow) -> float:
        """Return the share of the released snow that lies below the obstacle."""
        assert self.case.obstacle is not None
        return float((self.distances(snow) > self.case.obstacle).mean())

    def passed_at_edges(self, first: Snow, second: Snow, half_width: float) -> float:
        """Return the share that passes at the edges, among the snow passing between two times."""
        assert self.case.obstacle is not None
        before, after = self.distances(first), self.distances(second)
        through = (before <= self.case.obstacle) & (after > self.case.obstacle)
        if not through.any():
            raise LookupError("snow that passes")
        across = np.abs(first.positions[self.released][through][:, 1])
        return float((across > half_width).mean())
