"""The key numbers of a scene in a line or two, for pictures."""

from __future__ import annotations

from typing import Any


def scene_caption(scene: dict[str, Any]) -> str:
    """Return what tells one scene from another.

    Parameters
    ----------
    scene
        Complete scene data, as in scene.json.

    Examples
    --------
    >>> from snowshed.scene import Scene
    >>> print(scene_caption(Scene.preset("lab-50").initialise().data))
    3D · panel 0.245 m, tilt 50°, 0.33 m above ground, friction 0.3 · slab 0.02 m thick · dx 0.01 m
    snow 210 kg/m³, E 1 MPa, nu 0.3, M 0.5, p₀ 7 kPa, β 0.2, ξ 0.1 · events carry
    """
    parts = [f"{scene['dimension']}D"]
    if panel := scene.get("panel"):
        parts.append(
            f"panel {panel['length']:g} m, tilt {panel['tilt']:g}°, "
            f"{panel['height']:g} m above ground, {_contact(panel)}"
        )
    if slab := scene.get("slab"):
        parts.append(_slab(slab))
    if tilt := (scene.get("ground") or {}).get("tilt"):
        parts.append(f"ground tilt {tilt:g}°")
    parts.append(f"dx {scene['numerics']['dx']:g} m")
    return " · ".join(parts) + "\n" + _snow(scene["snow"]) + f" · events {_between(scene)}"


def _slab(slab: dict[str, Any]) -> str:
    layers = slab["layers"]
    if not layers:
        return f"slab {slab['thickness']:g} m thick"
    return (
        "layers "
        + ", ".join(f"{layer['thickness']:g}" for layer in layers[:5])
        + (f" m (of {len(layers)})" if len(layers) > 5 else " m")
    )


def _contact(panel: dict[str, Any]) -> str:
    return "sticky" if panel["condition"] == "sticky" else f"friction {panel['friction']:g}"


def _snow(snow: dict[str, Any]) -> str:
    text = (
        f"snow {snow['density']:g} kg/m³, E {snow['youngs_modulus'] / 1e6:g} MPa, "
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
