"""The key numbers of a scene in a line or two, for pictures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from snowshed.methods.registry import settings_of
from snowshed.scene.labels import label

if TYPE_CHECKING:
    import pandas as pd

#: Parameters of the snow in the caption.
ELASTIC = ("youngs_modulus", "poissons_ratio")
PLASTIC = ("critical_state_slope", "preconsolidation_pressure", "cohesion", "hardening_factor")
#: Treatment of the stack between events.
BETWEEN = {"carry": "the stack stays", "reseed": "the stack is reseeded"}
MAX_LAYERS = 4  # number of layers up to which each thickness is named


def scene_caption(scene: Mapping[str, Any], damping_rate: Optional[float] = None) -> str:
    """Return the key numbers of a scene.

    Parameters
    ----------
    scene
        Complete scene data, as in scene.json.
    damping_rate
        Mean damping rate of a run of the scene, 1/s, as in run.json.

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
            f"panel {_quantity_text('panel.length', panel)}, "
            f"tilt {_quantity_text('panel.tilt', panel)}, "
            f"{_quantity_text('panel.height', panel)} above ground, {contact_text(panel)}"
        )
    if slab := scene.get("slab"):
        parts.append(_slab_text(slab))
    if (ground := scene.get("ground")) and ground.get("tilt"):
        parts.append(f"ground tilt {_quantity_text('ground.tilt', ground)}")
    settings = settings_of(scene)
    method = [f"{settings.RESOLUTION} {settings.resolution:g} m"]
    if damping := settings.damping_text(damping_rate):
        method.append(damping)
    # Some methods have the snow's parameters in their settings.
    snow = [_snow_text(scene)] if "snow" in scene else []
    snow.append(BETWEEN[scene["events"]["between"]])
    return "\n".join(" · ".join(line) for line in (parts, snow, method))


def mean_damping_rate(table: pd.DataFrame) -> Optional[float]:
    """Return the mean damping rate over a table of events, 1/s; None if it lacks a rate."""
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


def _quantity_text(path: str, section: dict[str, Any]) -> str:
    """Return the value of a parameter with its unit; `section` is its section of the scene."""
    return label(path).quantity(section[path.rpartition(".")[2]])


def _slab_text(slab: dict[str, Any]) -> str:
    layers = slab["layers"]
    if not layers:
        return f"slab {_quantity_text('slab.thickness', slab)} thick"
    thicknesses = [f"{layer['thickness']:.3g}" for layer in layers]
    if len(layers) > MAX_LAYERS:
        low, high = min(thicknesses, key=float), max(thicknesses, key=float)
        return f"{len(layers)} layers of {low} to {high} m"
    return f"layers {', '.join(thicknesses)} m"


def _range_text(scene: Mapping[str, Any], name: str) -> str:
    """Return a parameter of the snow with its unit; its range over the layers if they differ."""
    layers = (scene.get("slab") or {}).get("layers") or [{}]
    values = [layer.get("snow", scene["snow"])[name] for layer in layers]
    parameter = label(f"snow.{name}")
    ends = sorted({min(values), max(values)})
    return " to ".join([*map(parameter.value, ends[:-1]), parameter.quantity(ends[-1])])


def _snow_text(scene: Mapping[str, Any]) -> str:
    elastic = scene["snow"]["model"] == "elastic"
    shown = ELASTIC if elastic else (*ELASTIC, *PLASTIC)
    values = [f"{label(f'snow.{name}').symbol} {_range_text(scene, name)}" for name in shown]
    return ", ".join([f"snow {_range_text(scene, 'density')}", *values, *["elastic"] * elastic])
