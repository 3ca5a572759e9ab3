"""Coarser images whose ice fraction is the same."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from snowshed._core import InputError
from snowshed.analysis.tomography.ice_image import IceImage
from snowshed.base.arguments import checked
from snowshed.base.arrays import AnyIntegers, SingleFloats
from snowshed.base.notes import InputNote, issue_note

MAX_FACTOR = 16


@checked
def downscaled(image: IceImage, factor: int) -> IceImage:
    """Return an image whose voxels are each `factor` times as long.

    The coarse voxels with the most ice become ice, until the ice fraction is reached. A majority
    rule in each voxel would change the fraction. Among equal voxels their neighbours decide, then
    their order. Incomplete voxels at the far sides are left out.

    Raises
    ------
    InputError
        If the factor is out of range, or the image has fewer voxels.

    Examples
    --------
    >>> ice = np.zeros((8, 8, 8), dtype=bool)
    >>> ice[:3] = True
    >>> coarse = downscaled(IceImage(ice, 5e-5, "a plate"), 2)
    >>> coarse.ice.shape, coarse.voxel_size, coarse.ice_fraction
    ((4, 4, 4), 0.0001, 0.375)
    """
    if factor != int(factor) or not 1 <= factor <= MAX_FACTOR:
        raise InputError(f"downscale {factor}: whole numbers from 1 to {MAX_FACTOR} are allowed")
    if min(image.ice.shape) < factor:
        raise InputError(f"{image.source}: {image.ice.shape} voxels; too few to join {factor}")
    if factor == 1:
        return image
    lost = [count % factor for count in image.ice.shape[::-1]]
    if any(lost):
        issue_note(
            f"{image.source}: {', '.join(map(str, lost))} voxels along x, y, z are left out at the "
            f"far sides, because its size is no multiple of {factor}",
            InputNote,
        )
    counts = _block_counts(image, factor)
    target = round(int(counts.sum(dtype=np.int64)) / factor**3)
    # Unequal counts differ by at least one, the second term by less: it only decides ties.
    around: SingleFloats = ndimage.uniform_filter(counts.astype(np.float32), 3, mode="nearest")
    rank = counts.astype(np.float32) + around / np.float32(2 * factor**3)
    order = np.argsort(-rank, axis=None, kind="stable")
    ice = np.zeros(counts.shape, dtype=bool)
    ice.ravel()[order[:target]] = True
    return image.with_ice(ice, voxel_size=image.voxel_size * factor)


def _block_counts(image: IceImage, factor: int) -> AnyIntegers:
    """Return the number of voxels of ice in each block."""
    nz, ny, nx = (count // factor for count in image.ice.shape)
    counts = np.zeros((nz, ny, nx), dtype=np.uint16)
    for z in range(factor):
        for y in range(factor):
            for x in range(factor):
                counts += image.ice[z::factor, y::factor, x::factor][:nz, :ny, :nx]
    return counts
