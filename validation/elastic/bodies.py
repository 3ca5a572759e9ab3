"""A free elastic body, which the cases of vibrations and of manufactured motions use."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.scene.components import Body, Obstacle
from snowshed.scene.scene import Scene
from snowshed.scene.shape import Shape
from snowshed.snow.accuracy.measurements import CaseSettings
from validation.framework.drive import apply_settings

#: The transfers that cases compare; flip_ratio 0 is PIC.
TRANSFERS: Sequence[CaseSettings] = (
    {"transfer": "flip", "flip_ratio": 1.0},
    {"transfer": "flip", "flip_ratio": 0.99},
    {"transfer": "flip", "flip_ratio": 0.95},
    {"transfer": "apic"},
    {"transfer": "flip", "flip_ratio": 0.0},
)


def elastic_scene(
    shape: Shape,
    settings: CaseSettings,
    case_settings: Collection[str] = (),
    obstacles: Sequence[Obstacle] = (),
) -> Scene:
    """Return a scene of one elastic body without gravity; 2D unless the settings say otherwise.

    Parameters
    ----------
    shape
        The body.
    settings
        As for `apply_settings`; with ``youngs_modulus`` (Pa), ``poissons_ratio``, ``density``
        (kg/m3).
    case_settings
        Names of settings that belong to the case, not to the scene.
    obstacles
        Obstacles that hold the body, if any.

    Examples
    --------
    >>> scene = elastic_scene(Shape.sphere((0, 0), 0.1), {"youngs_modulus": 1e6, "dx": 0.02})
    >>> scene.snow.model, scene.gravity, scene.numerics.sleep_speed
    ('elastic', 0.0, 0.0)
    """
    scene = Scene(dimension=2, gravity=0.0, bodies=[Body(shape=shape)], obstacles=list(obstacles))
    scene.set("snow.model", "elastic")
    return apply_settings(scene, settings, case_settings)


def from_plane(vectors: Floats) -> Floats:
    """Return vectors (n, 2) of (x, z) as the simulation's (n, 3) of (x, y, z).

    Examples
    --------
    >>> from_plane(np.array([[1.0, 2.0]])).tolist()
    [[1.0, 0.0, 2.0]]
    """
    x, z = vectors.T
    return np.stack([x, np.zeros_like(x), z], axis=1)


def in_plane(vectors: Floats) -> Floats:
    """Return the (x, z) of vectors (x, y, z), shapes (n, 2) and (n, 3).

    Examples
    --------
    >>> in_plane(np.array([[1.0, 0.0, 2.0]])).tolist()
    [[1.0, 2.0]]
    """
    return np.asarray(vectors[:, [0, 2]])
