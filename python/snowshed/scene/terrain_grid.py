"""The terrain of a slide at the nodes of the solver's grid."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import snowshed._core as _core
from snowshed.base.arguments import checked
from snowshed.io.raster.raster import Raster
from snowshed.scene.scene import SceneLike, resolve_scene
from snowshed.scene.shape import Outline


@checked
def slide_terrain(scene: SceneLike) -> Raster:
    """Return the elevations at the nodes of a slide's grid.

    Raises
    ------
    InputError
        If the scene is wrong, or its method is another.
    OSError
        If the terrain cannot be read.
    """
    resolved = resolve_scene(scene)
    maps = _core.Simulation(resolved.core, resolved.base_dir).slide_maps()
    crs = str(resolved.data["terrain"]["crs"])
    return Raster(maps["terrain"], maps["west"], maps["south"], maps["cell"], crs=crs)


def release_outlines(scene: Mapping[str, Any]) -> list[Outline]:
    """Return the corners of the release areas of a complete scene's data, map coordinates, m."""
    return [area["outline"] for area in scene["terrain"]["release"]]
