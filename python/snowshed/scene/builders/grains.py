"""Scenes of grains: a segmented image that is loaded."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Optional

import numpy as np

from snowshed._core import InputError
from snowshed.io.arrays import Integers
from snowshed.io.paths import PathLike
from snowshed.methods.grains.image.sample_folder import LABELS, find_sample
from snowshed.methods.grains.settings import GrainsSettings
from snowshed.scene.components import Events, Output
from snowshed.scene.loading import Cone, LoadingStage, Sample
from snowshed.scene.scene import Scene

MAX_TIME = 1e4  # s; the stages end before
NPY = ".npy"
EXAMPLE_VOXEL = 1e-4  # m


def grains_scene(
    labels: PathLike,
    voxel_size: Optional[float] = None,
    loading: Sequence[LoadingStage] = (LoadingStage(kind="compress"),),
    *,
    cone: Optional[Cone] = None,
    settings: Optional[GrainsSettings] = None,
    output: Optional[Output] = None,
    title: str = "",
) -> Scene:
    """Return the scene of a loading test on segmented snow.

    Parameters
    ----------
    labels
        An NPY file of integers (nz, ny, nx): 0 air, any other number a grain; or the folder of
        ``snowshed grains segment`` or ``synthetic`` that holds it.
    voxel_size
        Edge of a voxel, m; None: as the folder says.
    loading
        The stages, one after another.
    cone
        What stages "penetrate" push in; None: the default cone.
    settings
        Settings of the method; None: its defaults.
    output
        What is written during the run.
    title
        What this scene is; empty: how the sample was made, if it is known to be synthetic.

    Raises
    ------
    InputError
        If `labels` is no NPY file by its name, or nothing says how large a voxel is.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = example_grains(folder).sample.file
    ...     scene = grains_scene(file, 1e-4, [LoadingStage(kind="compress", strain=0.1)])
    >>> scene.resolve().data["loading"][0]["strain"]
    0.1
    """
    sample = find_sample(labels, LABELS)
    file = sample.file
    size = voxel_size if voxel_size is not None else sample.voxel_size
    if size is None:
        raise InputError(f"{file}: the edge of a voxel is not known; give it (--voxel) in m")
    if file.suffix.lower() != NPY:
        raise InputError(
            f"{file}: no NPY file; labels are whole numbers in one, 0 for air (numpy.save)"
        )
    return Scene(
        method="grains",
        dimension=3,
        title=title or sample.source,
        sample=Sample(file=file.resolve(), voxel_size=size),
        loading=list(loading),
        cone=cone,
        numerics=settings,
        events=Events(max_time=MAX_TIME),
        output=output,
    )


def example_grains(folder: PathLike) -> Scene:
    """Write an example's sample to a folder, and return the scene of its compression.

    Sintered balls of ice, 3 mm in all, are compressed by 30 % of their height. To take seconds,
    they are compressed faster than a quasi-static test would be, with grains of greater inertia.

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
    np.save(file, _sintered_balls())
    return grains_scene(
        file,
        EXAMPLE_VOXEL,
        [LoadingStage(kind="compress", speed=0.1, strain=0.3)],
        settings=GrainsSettings(density_scaling=100.0),
        title="Sintered balls of ice, compressed",
    )


def _sintered_balls() -> Integers:
    """Return the labels of balls that overlap, on a jittered lattice with holes, (30, 30, 30)."""
    count, pitch, radius, kept = 5, 6, 3.3, 0.62
    random = np.random.default_rng(7)
    lattice = np.stack(np.meshgrid(*[np.arange(count)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    lattice = lattice[random.random(len(lattice)) < kept]
    centres = (lattice + 0.5 + random.uniform(-0.08, 0.08, lattice.shape)) * pitch
    axis = np.arange(count * pitch) + 0.5
    voxels = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1)
    labels = np.zeros(voxels.shape[:3], dtype=np.int64)
    nearest = np.full(voxels.shape[:3], radius)
    for label, centre in enumerate(centres, start=1):
        distance = np.linalg.norm(voxels - centre, axis=-1)
        labels[distance < nearest] = label
        nearest = np.minimum(nearest, distance)
    return labels
