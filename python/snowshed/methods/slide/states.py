"""States of a slide at given times or steps, in memory."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.arrays import Integers, Numbers, finite, whole_number
from snowshed.base.core_simulation import core_of
from snowshed.results.particle_dataset import particle_dataset
from snowshed.running.simulation import Simulation
from snowshed.scene.scene import SceneLike

if TYPE_CHECKING:
    import xarray

QUANTITIES = ("id", "position", "velocity", "mass", "thickness")


@dataclass(frozen=True)
class SlideState:
    """The particles and bonds of a slide at a time.

    Attributes
    ----------
    time
        Time, s.
    steps
        Number of steps up to this time.
    quantities : (n,) or (n, 3) each
        Id, position, velocity, mass and thickness of the particles by name, ordered by id. x and y
        count from the south-west node of the terrain.
    bonds : (m, 2)
        The two particles of each bond, as rows of the quantities.
    """

    time: float
    steps: int
    quantities: Mapping[str, Numbers]
    bonds: Integers

    @property
    def particles(self) -> xarray.Dataset:
        """The quantities in the form of `snowshed.Results.particles`.

        Needs xarray (extra ``study``).
        """
        return particle_dataset(self.quantities, 1, self.time)


@checked
def slide_states(
    scene: SceneLike,
    times: Optional[Sequence[float]] = None,
    *,
    steps: Optional[Sequence[int]] = None,
) -> list[SlideState]:
    """Return the states of a slide at given times, or after given numbers of steps.

    Parameters
    ----------
    scene
        A scene whose method is "slide".
    times
        Times, s; each state follows the step that reaches its time.
    steps
        Numbers of steps instead of times; 0 for the release.

    Returns
    -------
    list of SlideState
        The slide, moving or at rest, for each time or number of steps in the given order.

    Raises
    ------
    InputError
        If the scene is wrong, or its method is another; if both or none of `times` and `steps` are
        given, or one is negative.
    SimulationError
        If the simulation cannot continue.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed.scene.builders.slides import example_slide
    >>> with TemporaryDirectory() as folder:
    ...     first, later = slide_states(example_slide(folder), [0.0, 0.5])
    >>> later.steps, len(later.bonds) <= len(first.bonds)
    (50, True)
    """
    if (times is None) == (steps is None):
        raise InputError("slide_states: give either times or steps")
    simulation = Simulation(scene)
    simulation.begin_event()
    if steps is None:
        length = simulation.scene.data["numerics"].get("time_step", 1.0)
        wanted = [_steps_until(time, length) for time in times or ()]
    else:
        wanted = [whole_number("steps", count, lowest=0) for count in steps]
    states: dict[int, SlideState] = {}
    for count in sorted(set(wanted)):
        simulation.step(count - simulation.steps)
        states[count] = _state(simulation)
    return [states[count] for count in wanted]


def _steps_until(time: float, length: float) -> int:
    if finite("times", time) < 0.0:
        raise InputError(f"times: {time!r}; a time from 0 s is needed")
    return math.ceil(time / length - 1e-9)


def _state(simulation: Simulation) -> SlideState:
    core = core_of(simulation)
    pairs, _ = core.slide_bonds()
    quantities = {name: core.field_by_id(name) for name in QUANTITIES}
    bonds = np.searchsorted(quantities["id"], pairs)
    return SlideState(simulation.time, simulation.steps, quantities, bonds)
