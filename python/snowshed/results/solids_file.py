"""The solids of a scene as triangles for ParaView: panel, ground and obstacles."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.io.raster.raster import Raster
from snowshed.io.vtk.vtp import write_triangles
from snowshed.plot.solids import Box, scene_solids
from snowshed.scene.scene import ResolvedScene

SOLIDS = "solids.vtp"
#: Meaning of the number ``kind`` of a triangle.
KINDS = {"ground": 0, "panel": 1, "solid": 2}


def write_solids(
    scene: ResolvedScene, positions: Floats, folder: Path, terrain: Optional[Raster] = None
) -> Optional[Path]:
    """Write the solids that snow collides with as ``solids.vtp`` of a results folder.

    Triangles have the numbers ``solid``, in the order of the scene, and ``kind``: 0 ground, 1
    panel, 2 obstacle. Moving obstacles stand at their initial positions.

    Parameters
    ----------
    scene
        The simulated scene.
    positions : (n, 3)
        Positions of the snow, m; unbounded solids are drawn around it.
    folder
        The results folder.
    terrain
        Ground of a slide; None for other methods.

    Returns
    -------
    Path or None
        The file; None if there are no solids, or no snow.
    """
    if not len(positions):
        return None
    snow = Box(positions.min(axis=0), positions.max(axis=0))
    solids, _ = scene_solids(scene, snow, terrain)
    if not solids:
        return None
    starts = np.cumsum([0, *(len(solid.corners) for solid in solids)])
    numbers = np.arange(len(solids), dtype=np.int32)
    counts = [len(solid.triangles) for solid in solids]
    kinds = np.array([KINDS[solid.kind] for solid in solids], dtype=np.int32)
    file = folder / SOLIDS
    write_triangles(
        file,
        np.concatenate([solid.corners for solid in solids]).astype(np.float32),
        np.concatenate([solid.triangles + start for solid, start in zip(solids, starts)]),
        {"solid": np.repeat(numbers, counts), "kind": np.repeat(kinds, counts)},
    )
    return file
