"""Scenes of grains: loading tests of a segmented image."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Optional

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.callers import argument
from snowshed.base.paths import PathLike
from snowshed.methods.grains.sample_folder import LABELS, find_sample
from snowshed.methods.grains.settings import GrainsSettings
from snowshed.scene.components import Events
from snowshed.scene.loading import Cone, LoadingStage, Sample
from snowshed.scene.output import Output
from snowshed.scene.scene import Scene

MAX_TIME = 1e4  # s; the stages end before
NPY = ".npy"


@checked
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
        An NPY file of integers (nz, ny, nx): 0 air, any other number a grain; or a folder from
        ``snowshed grains segment`` or ``synthetic`` with such a file.
    voxel_size
        Edge of a voxel, m; None: from the folder.
    loading
        The stages, one after another.
    cone
        The cone of stages "penetrate". [default: `Cone()`]
    settings
        Settings of the method; None: its defaults.
    output
        The output of the run.
    title
        Title of the scene. [default: the source of a synthetic sample]
    split_labels
        Whether each connected piece of a label is a grain; None: all its pieces are one grain.

    Raises
    ------
    InputError
        If `labels` is not an NPY file, or the voxel size is unknown.

    Examples
    --------
    >>> from snowshed.analysis.tomography.example import example_grains
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed.analysis.tomography.example import example_grains
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
        raise InputError(
            f"{file}: the edge of a voxel is not known; give it in m "
            f"({argument('voxel_size', option='voxel')})"
        )
    if file.suffix.lower() != NPY:
        raise InputError(
            f"{file}: not an NPY file, which must hold integers, 0 for air (numpy.save)"
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
