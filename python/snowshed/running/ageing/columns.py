"""A cloud of particles as columns of snow: the load on each particle, and its settling.

The particles are spread linearly over the nodes of a grid with the simulation's cells. A column
consists of nodes above one another without an empty node between them: snow neither presses nor
sinks through a gap, which may hold a roof or a panel.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.base.arrays import Floats

MIN_FILLED = 0.05  # a node with a smaller share of a full cell's mass is empty
MAX_NODES = 1.5e8  # the limit that also holds between particles and solids
MIN_COVER = 0.25  # smallest share of its base that a column covers


class SnowColumns:
    """The columns of a cloud of particles.

    Parameters
    ----------
    positions : (n, 3)
        m, z upward; y is ignored in 2D.
    masses : (n,)
        kg (per metre of width in 2D).
    densities : (n,)
        kg/m3.
    dimension
        2 or 3.
    dx
        Spacing of the nodes, m.

    Raises
    ------
    InputError
        If the particles spread over too large a grid.
    """

    def __init__(
        self, positions: Floats, masses: Floats, densities: Floats, dimension: int, dx: float
    ) -> None:
        axes = [0, 2] if dimension == 2 else [0, 1, 2]
        place = positions[:, axes] / dx
        low = np.floor(place.min(axis=0)) if len(place) else np.zeros(dimension)
        self._place = place - low
        size = np.floor(self._place.max(axis=0)) + 2 if len(place) else np.ones(dimension)
        if size.prod() > MAX_NODES:
            raise InputError(f"the stack spreads over more than {MAX_NODES:g} cells of {dx:g} m")
        self._shape = tuple(int(n) for n in size)
        self.masses = self._spread(masses)
        volumes = self._spread(masses / densities)
        full = volumes > 0
        self.densities = np.divide(self.masses, volumes, out=np.ones(self._shape), where=full)
        filled = volumes / dx**dimension
        self._snow = self.masses > MIN_FILLED * self.densities * dx**dimension
        # The columns along a wall of snow cover only a part of their base.
        cover = np.clip(filled.max(axis=-1, keepdims=True), MIN_COVER, 1.0)
        self._base = cover[..., 0] * dx ** (dimension - 1)
        # Between snow above and below, cells are full, however the particles are scattered.
        inner = np.zeros_like(self._snow)
        inner[..., 1:-1] = self._snow[..., :-2] & self._snow[..., 2:]
        self._heights = dx * np.where(inner, 1.0, np.minimum(filled / cover, 1.0))

    def stresses(self, gravity: float) -> Floats:
        """Return the vertical stress at the nodes from the snow above them, Pa."""
        above = np.zeros(self._shape)
        load = np.zeros(self._shape[:-1])
        for level in reversed(range(self._shape[-1])):
            own = np.where(self._snow[..., level], self.masses[..., level], 0.0)
            load = np.where(self._snow[..., level], load, 0.0)
            above[..., level] = load + 0.5 * own
            load = load + own
        result: Floats = above * gravity / self._base[..., None]
        return result

    def drops(self, strains: Floats) -> Floats:
        """Return the settling of each particle (n,), m, for strains of the nodes (their shape).

        A strain is the logarithm of the old over the new height.
        """
        shortening = np.where(self._snow, self._heights * -np.expm1(-strains), 0.0)
        sunk = np.zeros(self._shape)
        below = np.zeros(self._shape[:-1])
        for level in range(self._shape[-1]):
            own = shortening[..., level]
            below = np.where(self._snow[..., level], below, 0.0)
            sunk[..., level] = below + 0.5 * own
            below = below + own
        return self.at_particles(sunk)

    def at_particles(self, values: Floats) -> Floats:
        """Return the values of the nodes interpolated at the particles (n,)."""
        result = np.zeros(len(self._place))
        for node, share in self._corners():
            result += share * values.ravel()[node]
        return result

    def _spread(self, quantity: Floats) -> Floats:
        total = np.zeros(int(np.prod(self._shape)))
        for node, share in self._corners():
            total += np.bincount(node, weights=share * quantity, minlength=len(total))
        return total.reshape(self._shape)

    def _corners(self) -> Iterator[tuple[NDArray[np.int64], Floats]]:
        """Yield, for each corner of the cells, the node of each particle and its share."""
        cell = np.floor(self._place).astype(np.int64)
        part = self._place - cell
        for corner in product((0, 1), repeat=len(self._shape)):
            shares = np.where(np.array(corner, bool), part, 1.0 - part)
            node = np.ravel_multi_index((cell + corner).T, self._shape)
            yield node.astype(np.int64), shares.prod(axis=1)
