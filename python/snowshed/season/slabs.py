"""The scene of a season: one slide-off for every release, each with its own slab.

Every release is a layer of the scene's slab, laid at the start of its event. It has the mass and
the mean density of the accumulated snow, and strength and stiffness to match. The snow falls on the
natural cover, so the panel stands lower above the ground of this scene.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Optional

from snowshed._core import InputError
from snowshed.scene.components import Layer, Slab, Snow
from snowshed.scene.scene import ResolvedScene, Scene
from snowshed.season.accumulation import WinterDay
from snowshed.season.cover import cover_depths
from snowshed.season.rows import add_rows
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
        hold. The slab's thickness, the density of the snow and the number of events are replaced,
        and the panel is lowered by `cover_below_slides`.
    days
        From `accumulate`; at least one of them has an event.
    settings
        Settings of the slab's strength, the cover and the rows. [default: `SeasonSettings()`]

    Raises
    ------
    InputError
        If the scene has snow of its own, or there are too many releases.
    """
    scene: dict[str, Any] = base.copied_data()
    settings = settings or SeasonSettings()
    released = [day for day in days if day.event is not None]
    if len(released) > MAX_EVENTS:
        raise InputError(f"{len(released)} releases; a scene has at most {MAX_EVENTS} events")
    if scene.get("bodies"):
        raise InputError("/bodies: a season lays its own snow; remove further bodies")
    natural: dict[str, Any] = scene["snow"]
    slab = scene.pop("slab", None) or {}
    depths = cover_depths([day.weather for day in days], settings, scene["gravity"])
    cover = cover_below_slides(base.data, days, depths)
    if cover:
        scene["panel"]["height"] -= cover
        subject = scene.get("title") or "Slide-offs of a season"
        scene["title"] = f"{subject}, on {cover:.2f} m of natural snow"
    scene_of_season = Scene.from_data(scene)
    scene_of_season._base_dir = base.base_dir
    layers = [
        Layer(
            day.slab_load / density,
            snow_of_density(natural, density, settings.strength),
            day.event,
        )
        for day, density in zip(released, _densities(released))
    ]
    scene_of_season.slab = Slab(
        length=slab.get("length"), width=slab.get("width"), layers=[*layers]
    )
    scene_of_season.set("events.count", len(released))
    add_rows(scene_of_season, settings.rows, layers)
    return scene_of_season.resolve()


def cover_below_slides(
    scene: Mapping[str, Any], days: Sequence[WinterDay], cover: Iterable[float]
) -> float:
    """Return the mean depth of the natural cover on which the slide-offs fall, m.

    Parameters
    ----------
    scene
        The complete scene, with a panel. If it has obstacles, the depth is 0, because they stand on
        the ground, too.
    days
        The days of the season.
    cover
        Depth of the natural cover on each of them, m.

    Returns
    -------
    float
        The depth, at most the height of the panel.
    """
    if scene.get("obstacles"):
        return 0.0
    depths = [depth for day, depth in zip(days, cover) if day.event is not None]
    mean = sum(depths) / len(depths) if depths else 0.0
    return min(mean, float(scene["panel"]["height"]))


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
    snow = Snow(density=density, youngs_modulus=base["youngs_modulus"])
    snow.preconsolidation_pressure = base["preconsolidation_pressure"]
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
