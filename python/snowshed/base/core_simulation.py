"""The core's simulation inside a `snowshed.Simulation`."""

from __future__ import annotations

from typing import Protocol, Union

import snowshed._core as _core


class HoldsCore(Protocol):
    """The part of `snowshed.Simulation` that lower layers need."""

    _core: _core.Simulation


AnySimulation = Union[HoldsCore, _core.Simulation]


def core_of(simulation: AnySimulation) -> _core.Simulation:
    """Return the core's simulation of a simulation; the core's own is returned unchanged."""
    return simulation if isinstance(simulation, _core.Simulation) else simulation._core
