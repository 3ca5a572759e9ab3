"""Scenes of grains: a segmented image that is loaded."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Optional

import numpy as np

from snowshed._core import InputError
from snowshed.io.atomic import replacing
from snowshed.io.paths import PathLike
from snowshed.methods.grains.image.sample_folder import LABELS, find_sample
from snowshed.methods.grains.settings import GrainsSettings
from snowshed.scene.components import Events
from snowshed.scene.loading import Cone, LoadingStage, Sample
from snowshed.scene.output import Output
from snowshed.scene.scene import Scene

MAX_TIME = 1e4  # s; the stages end before
NPY = ".npy"
EXAMPLE_SHAPE, EXAMPLE_VOXEL = (30, 30, 30), 1e-4  # m


def grains_scene(
    labels: PathLike,
    voxel_size: Optional[float] = None,
    loading: Sequence[LoadingStage] = (LoadingStage(kind="compress"),),
    *,
    cone: Optional[Cone] = None,
    settings: Optional[GrainsSettings] = None,
    output: Optional[Output] = None,
    title: str = "",
    split_labels: Optional[bool] = None,
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
    split_labels
        Whether each piece of a label that lies in several places is a grain; None: it is not.

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
        sample=Sample(file=file.resolve(), voxel_size=size, split_labels=split_labels),
        loading=list(loading),
        cone=cone,
        numerics=settings or GrainsSettings(),
        events=Events(max_time=MAX_TIME),
        output=output or Output(),
    )


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
    # Here, as scipy's images take a third of a second that other scenes do not need.
    from snowshed.methods.grains.image.segmentation import known_grains
    from snowshed.methods.grains.image.sphere_snow import sphere_snow

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
