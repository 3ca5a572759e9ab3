"""Pieces of the ice by the curvature of its surface.

The image is smoothed; the surface is a level of the smooth image. Where the smaller principal
curvature is negative the surface is concave in a direction, as around a neck. The rest of the
surface, with the layer of voxels below it, consists of convex zones, its face-connected components.
The ice is labelled by the nearest zone.

The segmentation by curvature and contiguity is published (Hagenmuller, Chambon and Naaim 2015). The
steps that find and extend the zones are inferred.
"""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from snowshed.analysis.tomography.watershed import (
    NEIGHBOURS,
    Basins,
    distance_from,
    flooded,
)
from snowshed.base.arrays import Booleans, Floats, Integers, SingleFloats

VOXELS_AT_ONCE = 1 << 20  # voxels of the surface at a time


def curvature_basins(
    ice: Booleans, smoothing: float, neck_curvature: float, threads: int
) -> Basins:
    """Return the ice in pieces, one for each zone of the surface that is not concave.

    Parameters
    ----------
    ice : (nz, ny, nx)
        Mask of the ice.
    smoothing
        Standard deviation of the Gaussian that smooths the image, voxels.
    neck_curvature
        The surface is a neck where its smaller principal curvature is below this, 1/voxel.
    threads
        For the distances.
    """
    surface = surface_voxels(ice)
    smooth = ndimage.gaussian_filter(ice.astype(np.float32), smoothing, mode="nearest")
    smaller = principal_curvatures(smooth, surface)[0]
    del smooth
    necks = smaller <= neck_curvature
    convex = np.zeros(ice.shape, dtype=bool)
    convex[tuple(axis[~necks] for axis in surface)] = True
    # Voxels of a slanted surface share edges only; the layer below connects them by faces.
    convex = ndimage.binary_dilation(convex, NEIGHBOURS)
    convex &= ice
    convex[tuple(axis[necks] for axis in surface)] = False
    seeds, count = ndimage.label(convex, output=np.int32)
    if not count:  # nothing is convex: all is one piece
        seeds[ice] = 1
        count = 1
    reach = distance_from(~convex, threads)
    del convex
    labels = flooded(-reach, seeds, ice)
    distance = distance_from(ice, threads)
    peaks = np.zeros(count + 1)
    for layer, heights in zip(labels, distance):
        np.maximum.at(peaks, layer.ravel(), heights.ravel())
    return Basins(labels, distance, peaks)


def surface_voxels(ice: Booleans) -> tuple[Integers, ...]:
    """Return where ice has air at one of its faces: indices along z, y, x."""
    inner = ice.copy()
    for axis in range(3):
        low = tuple(slice(None, -1) if index == axis else slice(None) for index in range(3))
        high = tuple(slice(1, None) if index == axis else slice(None) for index in range(3))
        inner[low] &= ice[high]
        inner[high] &= ice[low]
    return np.nonzero(ice & ~inner)


def principal_curvatures(
    smooth: SingleFloats, at: tuple[Integers, ...]
) -> tuple[SingleFloats, SingleFloats]:
    """Return the principal curvatures of the levels of a field, the smaller first, 1/voxel.

    They are positive where the region above the level is convex. From the mean and the Gaussian
    curvature of an implicit surface: Goldman (2005, doi:10.1016/j.cagd.2005.06.005), section 4.

    Parameters
    ----------
    smooth : (nz, ny, nx)
        A field with second derivatives.
    at
        Indices of n voxels along z, y, x.
    """
    count = len(at[0])
    smaller = np.empty(count, dtype=np.float32)
    larger = np.empty(count, dtype=np.float32)
    for low in range(0, count, VOXELS_AT_ONCE):
        part = slice(low, min(low + VOXELS_AT_ONCE, count))
        smaller[part], larger[part] = _curvatures(smooth, [axis[part] for axis in at])
    return smaller, larger


def _curvatures(smooth: SingleFloats, at: list[Integers]) -> tuple[Floats, Floats]:
    def near(*steps: int) -> Floats:
        place = [
            np.clip(index + step, 0, size - 1) for index, step, size in zip(at, steps, smooth.shape)
        ]
        return smooth[tuple(place)].astype(np.float64)

    def mixed(first: int, second: int) -> Floats:
        corners = [
            (step, other, [step * (axis == first) + other * (axis == second) for axis in range(3)])
            for step in (-1, 1)
            for other in (-1, 1)
        ]
        total = np.sum([first * other * near(*steps) for first, other, steps in corners], axis=0)
        return np.asarray(0.25 * total)

    here = near(0, 0, 0)
    ahead = [near(*(int(axis == index) for axis in range(3))) for index in range(3)]
    behind = [near(*(-int(axis == index) for axis in range(3))) for index in range(3)]
    gz, gy, gx = (0.5 * (a - b) for a, b in zip(ahead, behind))
    hzz, hyy, hxx = (a - 2 * here + b for a, b in zip(ahead, behind))
    hzy, hzx, hyx = mixed(0, 1), mixed(0, 2), mixed(1, 2)
    squared = np.maximum(gz**2 + gy**2 + gx**2, 1e-20)
    along = (
        gz**2 * hzz + gy**2 * hyy + gx**2 * hxx
        + 2 * (gz * gy * hzy + gz * gx * hzx + gy * gx * hyx)
    )  # fmt: skip
    mean = 0.5 * (along - squared * (hzz + hyy + hxx)) / squared**1.5
    gauss = (
        gz**2 * (hyy * hxx - hyx**2) + gy**2 * (hzz * hxx - hzx**2) + gx**2 * (hzz * hyy - hzy**2)
        + 2 * gz * gy * (hyx * hzx - hzy * hxx)
        + 2 * gz * gx * (hzy * hyx - hzx * hyy)
        + 2 * gy * gx * (hzy * hzx - hyx * hzz)
    ) / squared**2  # fmt: skip
    half_difference = np.sqrt(np.maximum(mean**2 - gauss, 0.0))
    return mean - half_difference, mean + half_difference
