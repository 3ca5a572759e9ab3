"""The grains of an image as tables."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd

from snowshed.analysis.tomography.crofton import LAYERS_AT_ONCE
from snowshed.analysis.tomography.segmentation import Segmentation
from snowshed.base.arguments import checked
from snowshed.base.arrays import Booleans, Floats, Integers, Labels


@dataclass(frozen=True)
class GrainStatistics:
    """Numbers of all grains.

    Attributes
    ----------
    grains, contacts
        Number of grains, and of contacts.
    mean_coordination
        Mean number of grains that a grain touches.
    mean_diameter_m, median_diameter_m
        Mean and median diameter of spheres with the volumes of the grains.
    mean_contact_area_m2
        Mean area of all contacts.
    bonded_surface
        Area of the contacts, counted at both sides, over the whole surface of the grains.
    """

    grains: int
    contacts: int
    mean_coordination: float
    mean_diameter_m: float
    median_diameter_m: float
    mean_contact_area_m2: float
    bonded_surface: float


@checked
def grain_table(segmentation: Segmentation) -> pd.DataFrame:
    """Return a row for each grain.

    Columns
        ``grain``, its label; ``volume_m3``; ``equivalent_diameter_m`` of the sphere of this volume;
        ``surface_m2`` to air and ``contact_area_m2`` to other grains, by Crofton's formula;
        ``coordination``, the number of grains that it touches; ``x_m``, ``y_m``, ``z_m``, its
        centre; ``at_side``, whether a side of the image cuts it.

    Examples
    --------
    >>> from snowshed.analysis.tomography.segmentation import known_grains
    >>> from snowshed.analysis.tomography.sphere_packing import sphere_snow
    >>> snow = sphere_snow((40, 40, 40), 5e-5, diameter=5e-4, density=200, seed=1)
    >>> table = grain_table(known_grains(snow))
    >>> bool(abs(table.volume_m3.sum() / snow.ice.sum() / 5e-5**3 - 1) < 1e-9)
    True
    """
    size, touching = segmentation.image.voxel_size, segmentation.touching
    voxels, centres = _centres(segmentation.labels)
    volume = voxels[1:] * size**3
    x, y, z = (centres[1:] * size).T
    return pd.DataFrame(
        {
            "grain": np.arange(1, len(voxels)),
            "volume_m3": volume,
            "equivalent_diameter_m": np.cbrt(6 / np.pi * volume),
            "surface_m2": touching.air[1:] * size**2,
            "contact_area_m2": touching.contact_areas[1:] * size**2,
            "coordination": touching.coordination[1:],
            "x_m": x,
            "y_m": y,
            "z_m": z,
            "at_side": _at_side(segmentation.labels, len(voxels))[1:].astype(int),
        }
    )


@checked
def contact_table(segmentation: Segmentation) -> pd.DataFrame:
    """Return a row for each contact.

    Columns
        ``grain`` and ``other``, the labels that touch; ``area_m2``, by Crofton's formula;
        ``voxel_faces``, the number of voxel faces between them, each a bond in the loading tests;
        ``contiguity``, the area over the total surface of the grain with the smaller surface.
    """
    touching = segmentation.touching
    first, second = touching.pairs.T
    surfaces = touching.surfaces
    return pd.DataFrame(
        {
            "grain": first,
            "other": second,
            "area_m2": touching.areas * segmentation.image.voxel_size**2,
            "voxel_faces": touching.faces,
            "contiguity": touching.areas / np.minimum(surfaces[first], surfaces[second]),
        }
    )


def grain_statistics(grains: pd.DataFrame, contacts: pd.DataFrame) -> GrainStatistics:
    """Return the summary of the tables of grains and contacts."""
    bonded = float(grains["contact_area_m2"].sum())
    return GrainStatistics(
        grains=len(grains),
        contacts=len(contacts),
        mean_coordination=float(grains["coordination"].mean()),
        mean_diameter_m=float(grains["equivalent_diameter_m"].mean()),
        median_diameter_m=float(grains["equivalent_diameter_m"].median()),
        mean_contact_area_m2=float(contacts["area_m2"].mean()) if len(contacts) else 0.0,
        bonded_surface=bonded / (bonded + float(grains["surface_m2"].sum())),
    )


def _centres(labels: Labels) -> tuple[Integers, Floats]:
    """Return the number of voxels of each label, and their mean centre (x, y, z), in voxels."""
    count = int(labels.max(initial=0)) + 1
    voxels = np.zeros(count, dtype=np.int64)
    sums = np.zeros((count, 3))
    for low in range(0, len(labels), LAYERS_AT_ONCE):
        z, y, x = np.nonzero(labels[low : low + LAYERS_AT_ONCE])
        inside = labels[low : low + LAYERS_AT_ONCE][z, y, x]
        voxels += np.bincount(inside, minlength=count)
        for axis, place in enumerate((x, y, z + low)):
            sums[:, axis] += np.bincount(inside, place + 0.5, minlength=count)
    return voxels, sums / np.maximum(voxels, 1)[:, None]


def _at_side(labels: Labels, count: int) -> Booleans:
    """Return which labels a side of the image cuts."""
    cut = np.zeros(count, dtype=bool)
    for axis in range(3):
        for end in (0, -1):
            cut[np.take(labels, end, axis=axis)] = True
    return cut
