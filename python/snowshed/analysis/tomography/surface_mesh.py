"""The surface of the grains as triangles, for ParaView."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from snowshed.base.arrays import AnyIntegers, Floats, Labels, SingleFloats
from snowshed.base.extras import require
from snowshed.io.vtk.vtp import write_triangles

LAYERS_AT_ONCE = 64  # layers whose surface is found at a time


def write_surface(path: Path, labels: Labels, voxel_size: float) -> int:
    """Write the surface of the ice as a .vtp file, and return its number of triangles.

    Each triangle has the number of its ``grain``. The surface is that of marching cubes (Lewiner et
    al. 2003, doi:10.1080/10867651.2003.10487582), open at the sides of the image.

    Parameters
    ----------
    path
        The file.
    labels : (nz, ny, nx)
        0 air, else a grain.
    voxel_size
        Edge of a voxel, m.
    """
    measure = require("skimage.measure", "images", "the surface of the grains")
    points: list[SingleFloats] = []
    triangles: list[AnyIntegers] = []
    grains: list[Labels] = []
    offset = 0
    for low in range(0, len(labels) - 1, LAYERS_AT_ONCE):
        part = labels[low : low + LAYERS_AT_ONCE + 1]
        ice = part > 0
        if not ice.any() or ice.all():
            continue
        corners, faces, *_ = measure.marching_cubes(ice.astype(np.float32), 0.5)
        grains.append(_nearest_grain(part, corners[faces].mean(axis=1)))
        placed = (corners[:, ::-1] + np.array([0, 0, low]) + 0.5) * voxel_size
        points.append(placed.astype(np.float32))
        triangles.append(faces.astype(np.int64) + offset)
        offset += len(corners)
    write_triangles(
        path, np.concatenate(points), np.concatenate(triangles), {"grain": np.concatenate(grains)}
    )
    return sum(map(len, triangles))


def _nearest_grain(labels: Labels, centres: Floats) -> Labels:
    """Return the grain of triangles: that of the nearest voxel of ice around their centres."""
    low = np.floor(centres).astype(np.int64)
    grains = np.zeros(len(centres), dtype=np.int32)
    nearest = np.full(len(centres), np.inf)
    for step in np.ndindex(2, 2, 2):
        at = np.minimum(low + step, np.array(labels.shape) - 1)
        grain = labels[tuple(at.T)]
        distance = np.where(grain > 0, np.linalg.norm(centres - at, axis=1), np.inf)
        nearer = distance < nearest
        grains[nearer], nearest[nearer] = grain[nearer], distance[nearer]
    return grains
