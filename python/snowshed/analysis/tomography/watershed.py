"""Pieces of the ice by the watershed of the distance from the air."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from snowshed.base.arrays import Booleans, Floats, Integers, Labels, SingleFloats
from snowshed.base.extras import require

EXTRA = "images"
#: Distances are rounded to so many steps per voxel, so that flat tops are one maximum.
STEPS_PER_VOXEL = 8
NEIGHBOURS = np.ones((3, 3, 3), dtype=bool)


@dataclass(frozen=True)
class Basins:
    """Pieces of the ice, one around each maximum of a field.

    Attributes
    ----------
    labels : (nz, ny, nx)
        0 air, else 1 to n.
    distance : (nz, ny, nx)
        Distance from the air, in voxels.
    peaks : (n + 1,)
        Largest distance in each piece.
    """

    labels: Labels
    distance: SingleFloats
    peaks: Floats


def distance_from(mask: Booleans, threads: int) -> SingleFloats:
    """Return the distance of each voxel to the nearest voxel that is not `mask`, in voxels.

    The sides of the image do not count.
    """
    edt = require("edt", EXTRA, "finding grains")
    return np.asarray(edt.edt(mask, parallel=threads, black_border=False), dtype=np.float32)


def distance_basins(ice: Booleans, threads: int) -> Basins:
    """Return the watershed of the distance from the air, a basin for each of its maxima.

    Watershed of Vincent and Soille (1991, doi:10.1109/34.87344) as scikit-image has it.
    """
    morphology = require("skimage.morphology", EXTRA, "finding grains")
    distance = distance_from(ice, threads)
    steps = np.rint(distance * np.float32(STEPS_PER_VOXEL)).astype(np.uint16)
    tops: Booleans = morphology.local_maxima(steps, connectivity=3).astype(bool)
    tops &= ice
    seeds, count = ndimage.label(tops, structure=NEIGHBOURS, output=np.int32)
    del tops
    peaks = np.zeros(count + 1)
    marked = seeds > 0
    peaks[seeds[marked]] = steps[marked] / STEPS_PER_VOXEL
    del marked
    return Basins(flooded(distance, seeds, ice), distance, peaks)


def flooded(height: SingleFloats, seeds: Labels, ice: Booleans) -> Labels:
    """Return labels of the ice: a voxel gets the label of the seed whose flood comes first.

    Floods begin where `height` is largest, and stay in the ice.
    """
    segmentation = require("skimage.segmentation", EXTRA, "finding grains")
    return np.asarray(segmentation.watershed(-height, seeds, mask=ice), dtype=np.int32)


def voxel_counts(labels: Labels) -> Integers:
    """Return how many voxels each label has, (n + 1,)."""
    counts = np.zeros(int(labels.max(initial=0)) + 1, dtype=np.int64)
    for layer in labels:
        counts += np.bincount(layer.ravel(), minlength=len(counts))
    return counts
