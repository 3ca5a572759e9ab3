"""Images that are stacks of pictures: the pages of a file, or the files of a folder."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.base.notes import InputNote, issue_note
from snowshed.io.voxels.voxel_file import VoxelFile, check_size, check_unpacked

#: By the tag Orientation: whether the stored picture is transposed, and then mirrored along y and x
#: (TIFF 6.0, page 36; the same in Exif).
ORIENTATIONS = {
    1: (False, False, False), 2: (False, False, True), 3: (False, True, True),
    4: (False, True, False), 5: (True, False, False), 6: (True, False, True),
    7: (True, True, True), 8: (True, True, False),
}  # fmt: skip


@dataclass(frozen=True)
class PixelPicture:
    """A picture of one number per pixel, of known size, read on demand.

    Attributes
    ----------
    name
        Name for messages.
    size
        Pixels along y and x, as stored.
    dtype
        Type of the numbers.
    kind
        Further properties that all pictures of a stack share, as text.
    read
        Function that returns the numbers as stored.
    orientation
        Orientation of the stored rows and columns, one of `ORIENTATIONS`; None if the picture does
        not state it and takes the orientation of the first picture.
    stored
        Size in the file, bytes.
    notes
        Assumptions made in reading.
    """

    name: str
    size: tuple[int, int]
    dtype: np.dtype[Any]
    kind: str
    read: Callable[[], NDArray[Any]]
    orientation: Optional[int] = None
    stored: int = 0
    notes: tuple[str, ...] = ()


def stacked(
    name: str,
    pictures: Sequence[PixelPicture],
    voxel_size: Optional[float] = None,
    printed_size: Optional[float] = None,
) -> VoxelFile:
    """Return the image of a stack of pictures, and print the assumptions.

    Raises
    ------
    InputError
        If the pictures differ, or the image is larger than any image of snow.
    """
    first = pictures[0]
    for other in pictures[1:]:
        _check_same(other, first)
    height, width = first.size
    check_size(name, (len(pictures), height, width))
    unpacked = len(pictures) * height * width * first.dtype.itemsize
    check_unpacked(name, unpacked, sum(picture.stored for picture in pictures))
    orientation = first.orientation or 1
    transposed = ORIENTATIONS[orientation][0]
    shape = (len(pictures), width, height) if transposed else (len(pictures), height, width)
    for note in first.notes:
        issue_note(f"{name}: {note}", InputNote)
    if orientation != 1:
        issue_note(f"{name}: turned as the tag Orientation ({orientation}) says", InputNote)

    def read(low: int, high: int) -> NDArray[Any]:
        layers = np.empty((high - low, *shape[1:]), dtype=first.dtype.newbyteorder("="))
        for number, picture in enumerate(pictures[low:high]):
            pixels = picture.read()
            if pixels.shape != picture.size:
                raise InputError(f"{picture.name}: damaged: {pixels.shape} pixels")
            layers[number] = oriented(pixels, orientation)
        return layers

    return VoxelFile(name, shape, first.dtype, read, voxel_size, printed_size)


def oriented(pixels: NDArray[Any], orientation: int) -> NDArray[Any]:
    """Return a picture turned as its tag Orientation says.

    Examples
    --------
    >>> oriented(np.array([[1, 2, 3], [4, 5, 6]]), 6).tolist()
    [[4, 1], [5, 2], [6, 3]]
    """
    transposed, upward, leftward = ORIENTATIONS[orientation]
    pixels = pixels.T if transposed else pixels
    return pixels[:: -1 if upward else 1, :: -1 if leftward else 1]


def _check_same(picture: PixelPicture, first: PixelPicture) -> None:
    first_name = Path(first.name).name
    if picture.size != first.size:
        raise InputError(
            f"{picture.name}: {picture.size[1]} x {picture.size[0]} pixels; {first_name} has "
            f"{first.size[1]} x {first.size[0]}"
        )
    if (picture.kind, picture.dtype) != (first.kind, first.dtype):
        raise InputError(
            f"{picture.name}: pixels of type {picture.kind}; {first_name} has {first.kind}"
        )
    if (picture.orientation or first.orientation or 1) != (first.orientation or 1):
        raise InputError(
            f"{picture.name}: Orientation {picture.orientation}; {first_name} has "
            f"{first.orientation or 1}"
        )
