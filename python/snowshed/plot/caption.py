"""The key numbers of a scene in a line or two, for pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from snowshed.methods.registry import settings_of

if TYPE_CHECKING:
    import pandas as pd

MOST_LAYERS = 4  # whose thicknesses are named one by one


def scene_caption(scene: dict[str, Any], damping_rate: Optional[float] = None) -> str:
    """Return what tells one scene from another.

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
    snow 210 kg/m³, E 1 MPa, nu 0.3, M 0.5, p₀ 7 kPa, β 0.2, ξ 0.1 · events carry
    dx 0.01 m · FLIP 0.99 a step
    """
    parts = [f"{scene['dimension']}D"]
    if panel := scene.get("panel"):
        parts.append(
            f"panel {panel['length']:g} m, tilt {panel['tilt']:g}°, "
            f"{panel['height']:g} m above ground, {contact_text(panel)}"
        )
    if slab := scene.get("slab"):
        parts.append(_slab(slab))
    if tilt := (scene.get("ground") or {}).get("tilt"):
        parts.append(f"ground tilt {tilt:g}°")
    settings = settings_of(scene)
    method = [f"{settings.RESOLUTION} {settings.resolution:g} m"]
    if damping := settings.damping_text(damping_rate):
        method.append(damping)
    snow = [_snow(scene), f"events {_between(scene)}"]
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


def _slab(slab: dict[str, Any]) -> str:
    layers = slab["layers"]
    if not layers:
        return f"slab {slab['thickness']:g} m thick"
    thicknesses = [f"{layer['thickness']:.3g}" for layer in layers]
    if len(layers) > MOST_LAYERS:
        low, high = min(thicknesses, key=float), max(thicknesses, key=float)
        return f"{len(layers)} layers of {low} to {high} m"
    return f"layers {', '.join(thicknesses)} m"


def _densities(scene: dict[str, Any]) -> str:
    layers = (scene.get("slab") or {}).get("layers") or [{}]
    found = [layer.get("snow", scene["snow"])["density"] for layer in layers]
    return " to ".join(f"{density:g}" for density in sorted({min(found), max(found)}))


def _snow(scene: dict[str, Any]) -> str:
    snow = scene["snow"]
    text = (
        f"snow {_densities(scene)} kg/m³, E {snow['youngs_modulus'] / 1e6:g} MPa, "
        f"nu {snow['poissons_ratio']:g}"
    )
    if snow["model"] == "elastic":
        return text + ", elastic"
    return text + (
        f", M {snow['critical_state_slope']:g}, "
        f"p₀ {snow['preconsolidation_pressure'] / 1e3:g} kPa, "
        f"β {snow['cohesion']:g}, ξ {snow['hardening_factor']:g}"
    )


def _between(scene: dict[str, Any]) -> str:
    return str(scene["events"]["between"])
