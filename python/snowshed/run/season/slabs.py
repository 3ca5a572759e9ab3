"""The scene of a season: one slide-off for every release, each with its own slab.

Every release is a layer of the scene's slab that is laid at the start of its event, with the mass
and the mean density that had gathered.
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
    """Return the scene that slides off, event by event, what a season releases.

    Parameters
    ----------
    base
        Panel, ground, obstacles, snow and method. Its slab's length and width hold, its thickness
        and the density of its snow do not, nor does its number of events.
    days
        What `accumulate` made of the season; at least one of them has an event.

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
    """Return the densities of the slabs in numbers to read, kg/m3; thicknesses follow them."""
    for step in (1.0, 10.0):
        found = [max(step * round(day.load / day.thickness / step), step) for day in released]
        if len(set(found)) <= MOST_SNOWS:
            break
    return found
