"""Finding the grains of an image of snow."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.tomography.adjacency import Adjacency, find_adjacency
from snowshed.analysis.tomography.curvature import curvature_basins
from snowshed.analysis.tomography.ice_image import IceImage, check_phases
from snowshed.analysis.tomography.region_merging import merge_contiguous, merge_shallow
from snowshed.analysis.tomography.watershed import Basins, distance_basins, voxel_counts
from snowshed.base.arguments import checked
from snowshed.base.arrays import Labels, finite, positive
from snowshed.scene.loading import Sample

SegmentationMethod = Literal["watershed", "curvature"]


@checked
@dataclass(frozen=True)
class SegmentationSettings:
    """Settings of the segmentation into grains.

    Attributes
    ----------
    method : {"watershed", "curvature"}
        Method that cuts the ice: the watershed of the distance from the air, or the concave
        surface.
    depth
        Smallest height of a grain's maximum of the distance above the neck towards a higher
        maximum, voxels (watershed).
    smoothing
        Standard deviation of the Gaussian that smooths the surface, voxels (curvature).
    neck_curvature
        The surface is a neck where its smaller principal curvature is below this, 1/voxel
        (curvature).
    contiguity
        Share of the smaller surface of two pieces above which their contact makes them one grain. 0
        < value <= 1; 1: no pieces are merged.
    smallest
        A grain of fewer voxels joins the neighbour with the largest contact.
    threads
        Number of threads for distances. The result does not depend on it.

    Raises
    ------
    InputError
        If a value is out of range.
    """

    method: SegmentationMethod = "watershed"
    depth: float = 0.75
    smoothing: float = 1.5
    neck_curvature: float = 0.0
    contiguity: float = 0.15
    smallest: int = 27
    threads: int = 2

    def __post_init__(self) -> None:
        if self.method not in ("watershed", "curvature"):
            raise InputError(f"method {self.method!r}: watershed and curvature are allowed")
        positive("smoothing", self.smoothing)
        finite("neck_curvature", self.neck_curvature)
        if not finite("depth", self.depth) >= 0:
            raise InputError(f"depth {self.depth:g}: it must not be negative")
        if not 0 < finite("contiguity", self.contiguity) <= 1:
            raise InputError(f"contiguity {self.contiguity:g}: above 0 and up to 1 are allowed")
        if self.smallest < 0 or self.threads < 1:
            raise InputError("smallest must not be negative, and threads must be at least 1")


@dataclass(frozen=True)
class Segmentation:
    """The grains of an image.

    Attributes
    ----------
    image
        The ice.
    settings
        Settings of the segmentation; None for known grains.
    labels : (nz, ny, nx)
        0 air, else a grain from 1.
    touching
        Surfaces and contacts of the grains.
    """

    image: IceImage
    settings: Optional[SegmentationSettings]
    labels: Labels
    touching: Adjacency

    @property
    def count(self) -> int:
        """Number of grains."""
        return len(self.touching.air) - 1

    def sample(self) -> Sample:
        """Return the grains as the sample of a scene, without a file of one's own."""
        return Sample.from_labels(self.labels, voxel_size=self.image.voxel_size)


@checked
def segment(
    image: IceImage,
    settings: Optional[SegmentationSettings] = None,
    progress: Optional[Callable[[float, str], None]] = None,
) -> Segmentation:
    """Find the grains of an image.

    Parameters
    ----------
    image
        The ice. It should be connected; disconnected parts become separate grains.
    settings
        Settings of the segmentation. [default: `SegmentationSettings()`]
    progress
        Called with the finished share, and the current step.

    Raises
    ------
    InputError
        If there is no ice or no air, or all ice is one grain.

    Examples
    --------
    >>> from snowshed.analysis.tomography.sphere_packing import sphere_snow
    >>> snow = sphere_snow((40, 40, 40), 5e-5, diameter=6e-4, density=200, seed=1)
    >>> found = segment(snow)
    >>> abs(found.count - int(snow.labels.max())) <= 2
    True
    """
    chosen = settings or SegmentationSettings()
    check_phases(image)
    report = progress or _silent
    report(0.0, "cutting the ice")
    basins = _basins(image, chosen)
    report(0.6, "measuring contacts")
    labels = basins.labels
    touching = find_adjacency(labels, basins.distance)
    report(0.9, "merging")
    new = np.arange(len(touching.air))
    if chosen.method == "watershed":
        new = merge_shallow(touching, basins.peaks, chosen.depth)
        touching = touching.merged(new)
    voxels = np.bincount(new, voxel_counts(labels)).astype(np.int64)
    contiguous = merge_contiguous(touching, voxels, chosen.contiguity, chosen.smallest)
    new = contiguous[new].astype(np.int32)
    for layer in labels:
        layer[:] = new[layer]
    touching = touching.merged(contiguous)
    if len(touching.air) == 2:
        raise InputError(
            f"{image.source}: all ice is one grain; is the voxel size or the threshold wrong, or "
            "the image smaller than a grain? A larger contiguity separates more grains"
        )
    return Segmentation(image, chosen, labels, touching)


@checked
def known_grains(image: IceImage) -> Segmentation:
    """Return the grains of an image that knows them, such as a sphere pack.

    Raises
    ------
    InputError
        If the image does not know its grains.
    """
    if image.labels is None:
        raise InputError(f"{image.source}: its grains are not known; segment it")
    return Segmentation(image, None, image.labels, find_adjacency(image.labels))


def _basins(image: IceImage, settings: SegmentationSettings) -> Basins:
    if settings.method == "watershed":
        return distance_basins(image.ice, settings.threads)
    return curvature_basins(
        image.ice, settings.smoothing, settings.neck_curvature, settings.threads
    )


def _silent(part: float, doing: str) -> None:
    """Report nothing."""
