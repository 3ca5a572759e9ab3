"""The core's simulation inside the one that users hold."""

from __future__ import annotations

from typing import Protocol, Union

import snowshed._core as _core


class HoldsCore(Protocol):
    """The part of `snowshed.Simulation` that the rooms below it need."""

    _core: _core.Simulation


AnySimulation = Union[HoldsCore, _core.Simulation]


def core_of(simulation: AnySimulation) -> _core.Simulation:
    """Return the core's simulation of a `snowshed.Simulation`; or itself, if it is one."""
    return simulation if isinstance(simulation, _core.Simulation) else simulation._core
