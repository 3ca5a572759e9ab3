"""An example of grains: a small synthetic sample, and the scene of its compression."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from snowshed.analysis.tomography.segmentation import known_grains
from snowshed.analysis.tomography.sphere_packing import sphere_snow
from snowshed.base.arguments import checked
from snowshed.base.paths import PathLike
from snowshed.io.atomic import replacing
from snowshed.methods.grains.sample_folder import LABELS
from snowshed.methods.grains.settings import GrainsSettings
from snowshed.scene.builders.grains import grains_scene
from snowshed.scene.loading import LoadingStage
from snowshed.scene.scene import Scene

EXAMPLE_SHAPE, EXAMPLE_VOXEL = (30, 30, 30), 1e-4  # m


@checked
def example_grains(folder: PathLike) -> Scene:
    """Write an example's sample to a folder, and return the scene of its compression.

    A synthetic pack of sintered spheres of ice, 3 mm in all, is compressed by 30 % of its height.
    To take seconds, it is compressed faster than a quasi-static test would be, with grains of
    greater inertia.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     scene = example_grains(folder)
    >>> scene.loading[0].kind
    'compress'
    """
    file = Path(folder) / LABELS
    file.parent.mkdir(parents=True, exist_ok=True)
    snow = sphere_snow(
        EXAMPLE_SHAPE, EXAMPLE_VOXEL, diameter=6e-4, spread=0.2, density=300, neck_ratio=0.5, seed=7
    )
    with replacing(file) as beside:
        np.save(beside, known_grains(snow).labels)
    return grains_scene(
        file,
        EXAMPLE_VOXEL,
        [LoadingStage(kind="compress", speed=0.1, strain=0.3)],
        settings=GrainsSettings(density_scaling=100.0),
        title=snow.source,
    )
