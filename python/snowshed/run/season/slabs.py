"""The scene of a season: one slide-off for every release, each with its own slab.

Every release is a layer of the scene's slab, laid at the start of its event. It has the mass and
the mean density of the accumulated snow.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from snowshed._core import InputError
from snowshed.run.season.accumulation import Day
from snowshed.scene.components import Layer, Slab, Snow
from snowshed.scene.scene import ResolvedScene, Scene

MOST_EVENTS = 1000  # as in a scene
MOST_SNOWS = 250  # a scene has up to 256


def season_scene(base: ResolvedScene, days: Sequence[Day]) -> ResolvedScene:
    """Return the scene whose events are the releases of a season.

    Parameters
    ----------
    base
        The scene with panel, ground, obstacles, snow and method. The length and width of its slab
        hold. The slab's thickness, the density of the snow and the number of events are replaced.
    days
        From `accumulate`; at least one of them has an event.

    Raises
    ------
    InputError
        If the scene has snow of its own, or there are too many releases.
    """
    scene: dict[str, Any] = base.data
    released = [day for day in days if day.event is not None]
    if len(released) > MOST_EVENTS:
        raise InputError(f"{len(released)} releases; a scene has at most {MOST_EVENTS} events")
    if scene.get("bodies"):
        raise InputError("/bodies: a season lays its own snow; leave further bodies out")
    slab = scene.pop("slab", None) or {}
    made = Scene.from_data(scene)
    made._base_dir = base.base_dir
    made.slab = Slab(
        length=slab.get("length"),
        width=slab.get("width"),
        layers=[
            Layer(day.load / density, Snow(density=density), day.event)
            for day, density in zip(released, _densities(released))
        ],
    )
    made.set("events.count", len(released))
    return made.resolve()


def _densities(released: Sequence[Day]) -> list[float]:
    """Return rounded densities of the slabs, kg/m3, of which there are few enough for a scene."""
    for step in (1.0, 10.0):
        found = [max(step * round(day.load / day.thickness / step), step) for day in released]
        if len(set(found)) <= MOST_SNOWS:
            break
    return found
