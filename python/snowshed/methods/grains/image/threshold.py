"""From the numbers of an image to ice and air, a few layers at a time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.io.array_arguments import finite, positive
from snowshed.io.extras import require
from snowshed.io.formatting import number
from snowshed.io.voxels.voxel_file import VoxelFile
from snowshed.methods.grains.image.downscaling import downscaled
from snowshed.methods.grains.image.ice_image import IceImage, check_phases
from snowshed.methods.grains.image.parts import largest_part

LAYERS = 16  # at a time
BINS = 1024  # of a histogram of anything but small whole numbers
Crop = tuple[tuple[int, int], tuple[int, int], tuple[int, int]]


@dataclass(frozen=True)
class ImageSettings:
    """How ice is found in an image.

    Attributes
    ----------
    voxel_size
        Edge of a voxel, m; None: as the file says.
    threshold
        What is above is ice; None: in an image of two values the larger is, else Otsu's threshold
        (1979, doi:10.1109/TSMC.1979.4310076).
    dark_ice
        Whether ice is below the threshold.
    crop
        First voxel, and the one after the last, along z, y and x; None: all.
    downscale
        How many voxels along an edge become one. The ice fraction stays.
    connected
        Whether only the largest connected part of the ice is kept.
    synthetic_source
        How the snow was made, if it is synthetic; else empty.
    """

    voxel_size: Optional[float] = None
    threshold: Optional[float] = None
    dark_ice: bool = False
    crop: Optional[Crop] = None
    downscale: int = 1
    connected: bool = True
    synthetic_source: str = ""


@dataclass(frozen=True)
class ReadImage:
    """Ice that was read from an image, and what was decided for it.

    Attributes
    ----------
    image
        The ice.
    threshold
        What separates ice and air.
    chosen
        Who chose the threshold: "given", "two values" or "Otsu".
    lost
        Part of the ice that was not connected to the largest part, and was left out.
    """

    image: IceImage
    threshold: float
    chosen: str
    lost: float


def read_ice(file: VoxelFile, settings: Optional[ImageSettings] = None) -> ReadImage:
    """Return the ice of an image.

    Parameters
    ----------
    file
        The image.
    settings
        How ice is found in it; None: the defaults, with the voxel size of the file.

    Raises
    ------
    InputError
        If a value is out of range, the image has one value alone, or the voxel size is not known.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed.io.voxels.open_voxels import open_voxels
    >>> grey = np.zeros((8, 8, 8), dtype=np.uint8)
    >>> grey[2:6, 2:6, 2:6] = 200
    >>> with TemporaryDirectory() as folder:
    ...     np.save(folder + "/snow.npy", grey)
    ...     read = read_ice(open_voxels(folder + "/snow.npy"), ImageSettings(voxel_size=5e-5))
    >>> read.image.ice_fraction, read.chosen
    (0.125, 'two values')
    """
    wanted = settings or ImageSettings()
    size = wanted.voxel_size if wanted.voxel_size is not None else file.voxel_size
    if size is None:
        raise InputError(f"{file.name}: its voxel size is not known; give the edge of a voxel in m")
    positive("voxel size", size)
    crop = _checked_crop(file, wanted.crop)
    if wanted.threshold is not None:
        threshold, chosen = finite("threshold", wanted.threshold), "given"
    else:
        threshold, chosen = _found_threshold(file, crop)
    ice = np.empty([high - low for low, high in crop], dtype=bool)
    for low, part in _parts(file, crop):
        above = part > threshold
        ice[low : low + len(part)] = ~above if wanted.dark_ice else above
    source = wanted.synthetic_source
    image = IceImage(ice, size, source or file.name, synthetic=bool(source))
    check_phases(image)  # before it is rounded away
    image = downscaled(image, wanted.downscale)
    check_phases(image)
    lost = 0.0
    if wanted.connected:
        kept = largest_part(image.ice)
        lost = 1.0 - float(np.count_nonzero(kept) / np.count_nonzero(image.ice))
        image = image.with_ice(kept)
    return ReadImage(image, threshold, chosen, lost)


def cropped_shape(file: VoxelFile, crop: Optional[Crop]) -> tuple[int, int, int]:
    """Return how many voxels along z, y and x a crop keeps.

    Raises
    ------
    InputError
        If it is not within the image.
    """
    nz, ny, nx = (high - low for low, high in _checked_crop(file, crop))
    return nz, ny, nx


def _checked_crop(file: VoxelFile, crop: Optional[Crop]) -> Crop:
    nz, ny, nx = file.shape
    if crop is None:
        return (0, nz), (0, ny), (0, nx)
    for axis, (low, high), count in zip("zyx", crop, file.shape):
        if not 0 <= low < high <= count:
            raise InputError(
                f"{file.name}: crop {low}:{high} along {axis}; 0:{count} is all there is"
            )
    return crop


def _parts(file: VoxelFile, crop: Crop) -> Iterator[tuple[int, NDArray[Any]]]:
    """Yield the first layer in the crop, and the numbers of some layers from there."""
    (z0, z1), (y0, y1), (x0, x1) = crop
    for low in range(z0, z1, LAYERS):
        part = file.layers(low, min(low + LAYERS, z1))[:, y0:y1, x0:x1]
        if part.dtype.kind == "f" and not np.isfinite(part).all():
            raise InputError(f"{file.name}: values that are not finite in layers from {low}")
        yield low - z0, part


def _found_threshold(file: VoxelFile, crop: Crop) -> tuple[float, str]:
    """Return what separates ice and air, and how it was found."""
    lowest, highest = np.inf, -np.inf
    for _, part in _parts(file, crop):
        lowest, highest = min(lowest, float(part.min())), max(highest, float(part.max()))
    if lowest == highest:
        raise InputError(
            f"{file.name}: empty: every voxel has the value {number(lowest)}; there is no ice "
            "among air"
        )
    whole = file.dtype.kind in "bui" and highest - lowest < 1 << 16
    bins = int(highest - lowest) + 1 if whole else BINS
    counts, two = np.zeros(bins, dtype=np.int64), True
    for _, part in _parts(file, crop):
        two = two and bool(((part == lowest) | (part == highest)).all())
        counts += _counts(part, lowest, highest, bins, whole)
    if two:
        return 0.5 * (lowest + highest), "two values"
    filters = require("skimage.filters", "images", "Otsu's threshold")
    width = 1.0 if whole else (highest - lowest) / bins
    centres = lowest + width * (np.arange(bins) + (0.0 if whole else 0.5))
    return float(filters.threshold_otsu(hist=(counts, centres))), "Otsu"


def _counts(
    part: NDArray[Any], lowest: float, highest: float, bins: int, whole: bool
) -> NDArray[np.int64]:
    if whole:
        shifted = part.ravel().astype(np.int64) - int(lowest)
        return np.bincount(shifted, minlength=bins)
    return np.histogram(part, bins, (lowest, highest))[0].astype(np.int64)
