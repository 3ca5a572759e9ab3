"""The scene of a season: one slide-off for every release, each with its own slab.

Every event brings a body of its own, and all have one density: the mean over what was released, by
volume. Each slab has the mass that gathered; its thickness is what that mass has at the mean
density.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from snowshed._core import InputError
from snowshed.parts import Body
from snowshed.scene import InitialisedScene, Scene
from snowshed.season.accumulation import Day
from snowshed.structures.panel_edge import panel_edge
from snowshed.structures.panels import SNOW_OF_PANEL
from snowshed.structures.slope import Slope

MOST_EVENTS = 1000  # as in a scene


def season_scene(base: InitialisedScene, days: Sequence[Day]) -> InitialisedScene:
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
    scene = base.data
    released = [day for day in days if day.event is not None]
    if len(released) > MOST_EVENTS:
        raise InputError(f"{len(released)} releases; a scene has at most {MOST_EVENTS} events")
    mean = sum(day.load for day in released) / sum(day.thickness for day in released)
    density = round(mean, 1)  # a number to read; the thicknesses follow it
    if scene.get("bodies"):
        raise InputError("/bodies: a season lays its own snow; leave further bodies out")
    slab = scene.pop("slab", None) or {}
    made = Scene.from_data(scene)
    made._base_dir = base.base_dir
    made.set("snow.density", density)
    made.set("events.count", len(released))
    for number, day in enumerate(released, 1):
        made.append("bodies", _slab(scene, slab, day.load / density, number))
    return made.initialise()


def _slab(scene: Mapping[str, Any], slab: Mapping[str, Any], thickness: float, event: int) -> Body:
    panel, edge = scene["panel"], panel_edge(scene)
    flat = scene["dimension"] == 2
    across = None if flat else slab.get("width") or SNOW_OF_PANEL * panel["width"]
    slope = Slope((edge.x, edge.z), panel["tilt"], across)
    bare = 0.5 * (panel["length"] - (slab.get("length") or panel["length"]))
    return Body(shape=slope.layer(bare, panel["length"] - bare, 0.0, thickness), event=event)
