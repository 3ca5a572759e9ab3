"""The key numbers of a scene in a line or two, for pictures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from snowshed.methods.registry import settings_of
from snowshed.plot.labels import label

if TYPE_CHECKING:
    import pandas as pd

#: Parameters of the snow that are named.
ELASTIC = ("youngs_modulus", "poissons_ratio")
PLASTIC = ("critical_state_slope", "preconsolidation_pressure", "cohesion", "hardening_factor")
#: Treatment of the stack between events.
BETWEEN = {"carry": "the stack stays", "reseed": "the stack is reseeded"}
MAX_LAYERS = 4  # whose thicknesses are named one by one


def scene_caption(scene: Mapping[str, Any], damping_rate: Optional[float] = None) -> str:
    """Return the key numbers of a scene.

    Parameters
    ----------
    scene
        Complete scene data, as in scene.json.
    damping_rate
        Mean rate of the damping in a run of it, 1/s, as run.json has it.

    Examples
    --------
    >>> from snowshed.scene.scene import Scene
    >>> print(scene_caption(Scene.preset("lab-50").resolve().data))
    3D · panel 0.245 m, tilt 50°, 0.33 m above ground, separate, friction 0.3 · slab 0.02 m thick
    snow 210 kg/m³, E 1 MPa, nu 0.3, M 0.5, p₀ 7 kPa, β 0.2, ξ 0.1 · the stack stays
    dx 0.01 m · FLIP 0.99 per step
    """
    parts = [f"{scene['dimension']}D"]
    if panel := scene.get("panel"):
        parts.append(
            f"panel {_shown('panel.length', panel)}, tilt {_shown('panel.tilt', panel)}, "
            f"{_shown('panel.height', panel)} above ground, {contact_text(panel)}"
        )
    if slab := scene.get("slab"):
        parts.append(_slab(slab))
    if (ground := scene.get("ground")) and ground.get("tilt"):
        parts.append(f"ground tilt {_shown('ground.tilt', ground)}")
    settings = settings_of(scene)
    method = [f"{settings.RESOLUTION} {settings.resolution:g} m"]
    if damping := settings.damping_text(damping_rate):
        method.append(damping)
    snow = [_snow(scene)] if "snow" in scene else []  # some methods have theirs in their settings
    snow.append(BETWEEN[scene["events"]["between"]])
    return "\n".join(" · ".join(line) for line in (parts, snow, method))


def mean_damping_rate(table: pd.DataFrame) -> Optional[float]:
    """Return the mean rate of the damping over a table of events, 1/s; None where it has none."""
    if "damping_rate_per_s" not in table or table["damping_rate_per_s"].isna().any():
        return None
    return float(np.average(table["damping_rate_per_s"], weights=table["sim_time_s"]))


def contact_text(part: dict[str, Any]) -> str:
    """Return the contact condition of a panel, ground or obstacle, with its friction.

    Examples
    --------
    >>> contact_text({"condition": "slip", "friction": 0.3})
    'slip, friction 0.3'
    """
    condition: str = part["condition"]
    return condition if condition == "sticky" else f"{condition}, friction {part['friction']:g}"


def _shown(path: str, section: dict[str, Any]) -> str:
    """Return the value of a parameter, which the section it belongs to holds, with its unit."""
    return label(path).quantity(section[path.rpartition(".")[2]])


def _slab(slab: dict[str, Any]) -> str:
    layers = slab["layers"]
    if not layers:
        return f"slab {_shown('slab.thickness', slab)} thick"
    thicknesses = [f"{layer['thickness']:.3g}" for layer in layers]
    if len(layers) > MAX_LAYERS:
        low, high = min(thicknesses, key=float), max(thicknesses, key=float)
        return f"{len(layers)} layers of {low} to {high} m"
    return f"layers {', '.join(thicknesses)} m"


def _span(scene: Mapping[str, Any], name: str) -> str:
    """Return a parameter of the snow with its unit; its range over the layers if they differ."""
    layers = (scene.get("slab") or {}).get("layers") or [{}]
    values = [layer.get("snow", scene["snow"])[name] for layer in layers]
    parameter = label(f"snow.{name}")
    ends = sorted({min(values), max(values)})
    return " to ".join([*map(parameter.value, ends[:-1]), parameter.quantity(ends[-1])])


def _snow(scene: Mapping[str, Any]) -> str:
    elastic = scene["snow"]["model"] == "elastic"
    shown = ELASTIC if elastic else (*ELASTIC, *PLASTIC)
    values = [f"{label(f'snow.{name}').symbol} {_span(scene, name)}" for name in shown]
    return ", ".join([f"snow {_span(scene, 'density')}", *values, *["elastic"] * elastic])
