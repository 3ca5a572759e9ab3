"""Ice and air from the numbers of an image, a few layers at a time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.analysis.tomography.automatic_threshold import automatic_threshold
from snowshed.analysis.tomography.downscaling import downscaled
from snowshed.analysis.tomography.ice_image import IceImage, check_phases
from snowshed.analysis.tomography.parts import largest_part
from snowshed.base.arguments import checked
from snowshed.base.arrays import finite, positive
from snowshed.base.notes import InputNote, issue_note
from snowshed.io.voxels.voxel_file import VoxelFile

#: Relative difference of the voxel sizes of file and options that a note reports.
MAX_SIZE_DEVIATION = 0.01
Crop = tuple[tuple[int, int], tuple[int, int], tuple[int, int]]


@checked
@dataclass(frozen=True)
class ImageSettings:
    """Settings that separate ice from air in an image.

    Attributes
    ----------
    voxel_size
        Edge of a voxel, m; None: as the file says.
    threshold
        Value above which a voxel is ice. Default: the midpoint of an image of two values, else
        Otsu's threshold (1979, doi:10.1109/TSMC.1979.4310076).
    dark_ice
        Whether ice is below the threshold.
    crop
        First voxel, and the one after the last, along z, y and x; None: all.
    downscale
        Number of voxels along an edge to merge; keeps the ice fraction.
    connected
        Whether only the largest connected part of the ice is kept.
    synthetic_source
        Origin of the snow, if it is synthetic; else empty.
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
    """Ice from an image, and the decisions on the way to it.

    Attributes
    ----------
    image
        The ice.
    threshold
        Threshold between ice and air.
    chosen
        Who chose the threshold: "given", "two values" or "Otsu".
    lost
        Share of the ice that was left out, because it is not connected to the largest part.
    """

    image: IceImage
    threshold: float
    chosen: str
    lost: float


@checked
def read_ice(file: VoxelFile, settings: Optional[ImageSettings] = None) -> ReadImage:
    """Return the ice of an image.

    Parameters
    ----------
    file
        The image.
    settings
        Settings that separate ice from air; None: the defaults, with the voxel size of the file.

    Raises
    ------
    InputError
        If a value is out of range, the image has only one value, or the voxel size is unknown.

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
    size = _voxel_size(file, wanted.voxel_size)
    crop = _checked_crop(file, wanted.crop)
    if wanted.threshold is not None:
        threshold, chosen = finite("threshold", wanted.threshold), "given"
    else:
        threshold, chosen = automatic_threshold(
            file.name, lambda: (part for _, part in _parts(file, crop))
        )
    ice = np.empty([high - low for low, high in crop], dtype=bool)
    for low, part in _parts(file, crop):
        above = part > threshold
        ice[low : low + len(part)] = ~above if wanted.dark_ice else above
    source = wanted.synthetic_source
    image = IceImage(ice, size, source or file.name, synthetic=bool(source))
    check_phases(image)  # before downscaling, which may round a phase away
    image = downscaled(image, wanted.downscale)
    check_phases(image)
    lost = 0.0
    if wanted.connected:
        largest = largest_part(image.ice)
        lost = 1.0 - float(np.count_nonzero(largest) / np.count_nonzero(image.ice))
        image = image.with_ice(largest)
    return ReadImage(image, threshold, chosen, lost)


def _voxel_size(file: VoxelFile, given: Optional[float]) -> float:
    """Return the edge of a voxel, m; a note reports another size in the file."""
    if given is None:
        if file.voxel_size is None:
            hint = ""
            if file.printed_size is not None:
                hint = f"; its tags of resolution would mean {file.printed_size:.4g} m"
            raise InputError(
                f"{file.name}: its voxel size is not known; give the edge of a voxel in m{hint}"
            )
        return positive("voxel size", file.voxel_size)
    size = positive("voxel size", given)
    for stated, source in ((file.voxel_size, "the file"), (file.printed_size, "its resolution")):
        if stated is not None and abs(stated - size) > MAX_SIZE_DEVIATION * size:
            issue_note(
                f"{file.name}: voxels of {size:g} m, as given; {source} says {stated:.4g} m",
                InputNote,
            )
    return size


def cropped_shape(file: VoxelFile, crop: Optional[Crop]) -> tuple[int, int, int]:
    """Return how many voxels along z, y and x a crop keeps.

    Raises
    ------
    InputError
        If the crop is not within the image.
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
                f"{file.name}: crop {low}:{high} along {axis} exceeds the image (0:{count})"
            )
    return crop


def _parts(file: VoxelFile, crop: Crop) -> Iterator[tuple[int, NDArray[Any]]]:
    """Yield the first layer in the crop, and the numbers of some layers from there."""
    (z0, z1), (y0, y1), (x0, x1) = crop
    for low in range(z0, z1, file.layers_at_once):
        part = file.layers(low, min(low + file.layers_at_once, z1))[:, y0:y1, x0:x1]
        if part.dtype.kind == "f" and not np.isfinite(part).all():
            raise InputError(f"{file.name}: non-finite values from layer {low} on")
        yield low - z0, part
