"""The scene of a season: one slide-off for every release, each with its own slab.

Every release is a layer of the scene's slab, laid at the start of its event. It has the mass and
the mean density of the accumulated snow, and strength and stiffness to match.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Optional

from snowshed._core import InputError
from snowshed.scene.components import Layer, Slab, Snow
from snowshed.scene.scene import ResolvedScene, Scene
from snowshed.season.accumulation import WinterDay
from snowshed.season.settings import SeasonSettings
from snowshed.snow.relations.stiffness import YOUNGS_MODULUS
from snowshed.snow.relations.strength import TENSILE_STRENGTH

MAX_EVENTS = 1000  # as in a scene
MAX_SNOWS = 250  # a scene has up to 256


def season_scene(
    base: ResolvedScene, days: Sequence[WinterDay], settings: Optional[SeasonSettings] = None
) -> ResolvedScene:
    """Return the scene whose events are the releases of a season.

    Parameters
    ----------
    base
        The scene with panel, ground, obstacles, snow and method. The length and width of its slab
        hold. The slab's thickness, the density of the snow and the number of events are replaced.
    days
        From `accumulate`; at least one of them has an event.
    settings
        Settings of the slab's strength. [default: `SeasonSettings()`]

    Raises
    ------
    InputError
        If the scene has snow of its own, or there are too many releases.
    """
    scene: dict[str, Any] = base.copied_data()
    released = [day for day in days if day.event is not None]
    if len(released) > MAX_EVENTS:
        raise InputError(f"{len(released)} releases; a scene has at most {MAX_EVENTS} events")
    if scene.get("bodies"):
        raise InputError("/bodies: a season lays its own snow; remove further bodies")
    natural: dict[str, Any] = scene["snow"]
    slab = scene.pop("slab", None) or {}
    strength = (settings or SeasonSettings()).strength
    scene_of_season = Scene.from_data(scene)
    scene_of_season._base_dir = base.base_dir
    scene_of_season.slab = Slab(
        length=slab.get("length"),
        width=slab.get("width"),
        layers=[
            Layer(
                day.slab_load / density,
                snow_of_density(natural, density, strength),
                day.event,
            )
            for day, density in zip(released, _densities(released))
        ],
    )
    scene_of_season.set("events.count", len(released))
    return scene_of_season.resolve()


def snow_of_density(base: Mapping[str, Any], density: float, strength: Optional[str]) -> Snow:
    """Return snow with strength and stiffness scaled to another density.

    The strength of the snow scales with the relation named `strength`, its stiffness with Young's
    modulus of sigrist-2006. Only ratios are used, because loose snow has a fraction of the strength
    and stiffness of these relations.

    Parameters
    ----------
    base
        The other snow, complete.
    density
        Density, kg/m3.
    strength
        A name in `TENSILE_STRENGTH`; None: no change but the density.

    Examples
    --------
    >>> base = Snow.preset("calibrated").to_data() | {"model": "cam_clay"}
    >>> new = snow_of_density(base, 105.0, "sigrist-2006")
    >>> round(new.preconsolidation_pressure / base["preconsolidation_pressure"], 3)  # 2^-2.44
    0.184
    """
    snow = Snow(density=density)
    if strength is None:
        return snow
    own = float(base["density"])
    stiffness = YOUNGS_MODULUS["sigrist-2006"]
    snow.youngs_modulus = base["youngs_modulus"] * stiffness(density) / stiffness(own)
    if base["model"] == "cam_clay":
        law = TENSILE_STRENGTH[strength]
        ratio = law(density) / law(own)
        snow.preconsolidation_pressure = base["preconsolidation_pressure"] * ratio
    return snow


def _densities(released: Sequence[WinterDay]) -> list[float]:
    """Return densities of the slabs, kg/m3, rounded so that a scene can hold all of them."""
    for step in (1.0, 10.0):
        densities = [
            max(step * round(day.slab_load / day.slab_thickness / step), step) for day in released
        ]
        if len(set(densities)) <= MAX_SNOWS:
            break
    return densities
