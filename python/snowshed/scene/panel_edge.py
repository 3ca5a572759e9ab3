"""The position of a scene's panel in the plane (x, z)."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Edge:
    """The lower edge of a panel, and the frame its slab lies in, m.

    Attributes
    ----------
    x, z
        The edge.
    center
        Center of the sliding face.
    normal
        Outward from the face.
    """

    x: float
    z: float
    center: tuple[float, float]
    normal: tuple[float, float]

    @property
    def upper(self) -> tuple[float, float]:
        """The upper edge."""
        return 2.0 * self.center[0] - self.x, 2.0 * self.center[1] - self.z


def ground_tilt(scene: Mapping[str, Any]) -> float:
    """Return the tilt of the ground in a scene's data, degrees; 0 without a tilted plane.

    Examples
    --------
    >>> ground_tilt({"ground": {"tilt": 20}}), ground_tilt({})
    (20.0, 0.0)
    """
    return float((scene.get("ground") or {}).get("tilt") or 0.0)


def panel_edge(scene: Mapping[str, Any]) -> Edge:
    """Return the lower edge of the panel in a scene's data; x is 0 at the panel's centre.

    Examples
    --------
    >>> from snowshed.scene.scene import Scene
    >>> edge = panel_edge(Scene.preset("lab-50").resolve().data)
    >>> round(edge.z, 3), round(edge.x, 3)
    (0.33, 0.079)
    """
    panel = scene["panel"]
    tilt = math.radians(panel["tilt"])
    ground = math.radians(ground_tilt(scene))
    half = 0.5 * panel["length"]
    x = half * math.cos(tilt)
    z = panel["height"] - x * math.tan(ground)
    return Edge(x, z, (0.0, z + half * math.sin(tilt)), (math.sin(tilt), math.cos(tilt)))
