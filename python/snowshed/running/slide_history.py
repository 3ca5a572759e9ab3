"""States of a slide at given times or steps, in memory."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

import snowshed._core as _core
from snowshed.base.arrays import Floats, Integers
from snowshed.scene.scene import SceneLike, resolve_scene

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class SlideState:
    """The particles and bonds of a slide at a time.

    Attributes
    ----------
    time
        Time, s.
    positions : (n, 3)
        Positions, m; x and y from the south-west node of the terrain.
    thickness : (n,)
        Thickness of the snow, m.
    bonds : (m, 2)
        The two particles of each bond, as rows of `positions`.
    """

    time: float
    positions: Floats
    thickness: Floats
    bonds: Integers


def slide_states(scene: SceneLike, times: Sequence[float]) -> list[SlideState]:
    """Return the states of a slide at given times, moving or at rest.

    Parameters
    ----------
    scene
        A scene whose method is "slide".
    times
        Times, s, in rising order; each state is taken after the step that reaches its time.

    Raises
    ------
    InputError
        If the scene is wrong, or its method is another.
    SimulationError
        If the simulation cannot go on.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed.scene.builders.slides import example_slide
    >>> with TemporaryDirectory() as folder:
    ...     first, later = slide_states(example_slide(folder), [0.0, 0.5])
    >>> len(later.bonds) <= len(first.bonds)
    True
    """
    resolved = resolve_scene(scene)
    step = resolved.data["numerics"].get("time_step", 1.0)
    simulation = _core.Simulation(resolved.core, resolved.base_dir)
    simulation.begin_event()
    states, done = [], 0
    for time in times:
        wanted = max(done, int(np.ceil(time / step - 1e-9)))
        simulation.step(wanted - done)
        done = wanted
        states.append(_state(simulation))
    return states


def particles_at(scene: SceneLike, steps: Sequence[int]) -> dict[int, pd.DataFrame]:
    """Return the particles of a slide after given numbers of steps, moving or at rest.

    Parameters
    ----------
    scene
        A scene whose method is "slide".
    steps
        Numbers of steps, 0 for the release.

    Returns
    -------
    dict of pandas.DataFrame
        Tables by the number of steps: ID, x, y, z [m], ux, uy, uz [m/s], m [kg], h [m]; x and y
        from the south-west node of the terrain.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed.scene.builders.slides import example_slide
    >>> with TemporaryDirectory() as folder:
    ...     tables = particles_at(example_slide(folder), [0, 2])
    >>> list(tables)
    [0, 2]
    """
    resolved = resolve_scene(scene)
    simulation = _core.Simulation(resolved.core, resolved.base_dir)
    simulation.begin_event()
    tables: dict[int, pd.DataFrame] = {}
    done = 0
    for wanted in sorted(set(steps)):
        simulation.step(wanted - done)
        done = wanted
        tables[wanted] = _particle_table(simulation)
    return tables


def _state(simulation: _core.Simulation) -> SlideState:
    ids = np.asarray(simulation.field_by_id("id"), dtype=np.int64)
    pairs, _ = simulation.slide_bonds()
    return SlideState(
        time=simulation.time_s,
        positions=simulation.positions(),
        thickness=np.asarray(simulation.field_by_id("thickness"), dtype=np.float64),
        bonds=np.searchsorted(ids, pairs),
    )


def _particle_table(simulation: _core.Simulation) -> pd.DataFrame:
    import pandas as pd

    position, velocity = simulation.positions(), simulation.velocities()
    return pd.DataFrame(
        {
            "ID": simulation.field_by_id("id"),
            **{axis: position[:, k] for k, axis in enumerate("xyz")},
            **{f"u{axis}": velocity[:, k] for k, axis in enumerate("xyz")},
            "m": simulation.masses(),
            "h": simulation.field_by_id("thickness"),
        }
    )
