"""Images in TIFF stacks and in folders of numbered TIFF, PNG or BMP slices, read by Pillow."""

from __future__ import annotations

import re
import struct
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.io.damage import DAMAGED
from snowshed.io.extras import require
from snowshed.io.voxels.voxel_file import VoxelFile, check_size

if TYPE_CHECKING:
    from PIL.Image import Image

#: What the ending of a slice says, and what Pillow calls it.
FORMATS = {".tif": "TIFF", ".tiff": "TIFF", ".png": "PNG", ".bmp": "BMP"}
#: Pillow's modes with one number per pixel.
TYPES = {
    "1": "uint8", "L": "uint8", "P": "uint8", "I": "int32", "F": "float32",
    "I;16": "<u2", "I;16L": "<u2", "I;16B": ">u2", "I;16N": "=u2",
}  # fmt: skip
SAMPLE_FORMAT, SIGNED = 339, 2  # TIFF
BITS_PER_SAMPLE = 258
IMAGE_DESCRIPTION = 270
MOST_SLICES = 1 << 16


def open_stack(path: Path) -> VoxelFile:
    """Return the image of a TIFF file, a slice from each page.

    Raises
    ------
    InputError
        If it is damaged, has colours, or its pages differ.
    OSError
        If it cannot be read.
    """
    with _opened(path) as image:
        count = getattr(image, "n_frames", 1)
        width, height = image.size
        shape = (count, height, width)
        check_size(str(path), shape)
        described = str(getattr(image, "tag_v2", {}).get(IMAGE_DESCRIPTION, ""))
        dtype = _type(image, str(path))
        mode = image.mode
    slices = re.search(r"^images=(\d+)", described, re.MULTILINE)
    if slices and count == 1 and int(slices[1]) > 1:
        raise InputError(
            f"{path}: ImageJ wrote {slices[1]} slices as one page (a stack beyond 4 GB); save it "
            "as an image sequence or as raw"
        )

    def read(low: int, high: int) -> NDArray[Any]:
        found = np.empty((high - low, height, width), dtype=dtype.newbyteorder("="))
        with _opened(path) as image:
            for number in range(low, high):
                image.seek(number)
                name = f"{path}, page {number + 1}"
                _check_slice(image, name, (width, height), mode, "the first page")
                found[number - low] = _pixels(image, name)
        return found

    return VoxelFile(str(path), shape, dtype, read)


def open_slices(folder: Path) -> VoxelFile:
    """Return the image of a folder of slices, in the order of the numbers in their names.

    Raises
    ------
    InputError
        If slices are missing, of mixed types or sizes, or have colours, or other files have such
        an ending.
    OSError
        If they cannot be read.
    """
    paths = _numbered(folder)
    with _opened(paths[0]) as image:
        size, mode, dtype = image.size, image.mode, _type(image, str(paths[0]))
    width, height = size
    check_size(str(folder), (len(paths), height, width))
    for path in paths[1:]:  # the headers alone
        with _opened(path) as image:
            _check_slice(image, str(path), size, mode, paths[0].name)

    def read(low: int, high: int) -> NDArray[Any]:
        found = np.empty((high - low, height, width), dtype=dtype.newbyteorder("="))
        for number, path in enumerate(paths[low:high]):
            with _opened(path) as image:
                _check_slice(image, str(path), size, mode, paths[0].name)
                found[number] = _pixels(image, str(path))
        return found

    return VoxelFile(str(folder), (len(paths), height, width), dtype, read)


def _numbered(folder: Path) -> list[Path]:
    """Return the slices of a folder by their number, of which none is missing."""
    paths = []
    for path in folder.iterdir():
        if path.suffix.lower() in FORMATS and not path.name.startswith("."):
            paths.append(path)
        if len(paths) > MOST_SLICES:
            raise InputError(f"{folder}: more than {MOST_SLICES:,} slices")
    if not paths:
        raise InputError(f"{folder}: no slices in it; {', '.join(FORMATS)} are read")
    kinds = {FORMATS[path.suffix.lower()] for path in paths}
    if len(kinds) > 1:
        raise InputError(f"{folder}: slices of mixed types: {', '.join(sorted(kinds))}")
    numbers: dict[int, Path] = {}
    for path in sorted(paths):
        found = re.search(r"(\d{1,12})\D*$", path.stem)
        if found is None:
            raise InputError(f"{path}: no number in its name; slices are ordered by their numbers")
        number = int(found[1])
        if number in numbers:
            raise InputError(f"{path}: has the number of {numbers[number].name}, {number}")
        numbers[number] = path
    order = sorted(numbers)
    for one, following in zip(order, order[1:]):
        if following != one + 1:
            raise InputError(
                f"{folder}: slice {one + 1} is missing, between {numbers[one].name} and "
                f"{numbers[following].name}"
            )
    return [numbers[number] for number in order]


@contextmanager
def _opened(path: Path) -> Iterator[Image]:
    """Yield a picture as its ending says, whose errors say that it is damaged."""
    pillow = require("PIL.Image", "images", "reading pictures")

    kind = FORMATS[path.suffix.lower()]
    with path.open("rb"):  # a missing file is told as such
        pass
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # sizes are checked, and damage is an error
            with pillow.open(path, formats=[kind]) as image:
                yield image
    except InputError:
        raise
    except pillow.DecompressionBombError as error:
        raise InputError(f"{path}: {error}") from None
    except (OSError, struct.error, *DAMAGED) as error:
        raise InputError(f"{path}: damaged: not read as {kind}: {error}") from None


def _check_slice(image: Image, name: str, size: tuple[int, int], mode: str, first: str) -> None:
    if image.size != size:
        raise InputError(
            f"{name}: {image.size[0]} x {image.size[1]} pixels; {first} has {size[0]} x {size[1]}"
        )
    if image.mode != mode:
        raise InputError(f"{name}: pixels of type {image.mode}; {first} has {mode}")


def _type(image: Image, name: str) -> np.dtype[Any]:
    if image.mode not in TYPES or (image.mode == "P" and not _is_grey(image)):
        raise InputError(f"{name}: has colours ({image.mode}); convert it to shades of grey")
    return np.dtype("int8") if _signed_bytes(image) else np.dtype(TYPES[image.mode])


def _pixels(image: Image, name: str) -> NDArray[Any]:
    if image.mode == "P" and not _is_grey(image):
        raise InputError(f"{name}: has colours; convert it to shades of grey")
    shown = image.convert("L") if image.mode == "P" else image
    pixels = np.asarray(shown)
    if image.mode == "1":
        return pixels.astype(np.uint8)
    return pixels.view(np.int8) if _signed_bytes(image) else pixels


def _is_grey(image: Image) -> bool:
    """Return whether the colours of a palette are shades of grey."""
    colours = np.asarray(image.getpalette("RGB") or [], dtype=np.int64).reshape(-1, 3)
    return bool((colours == colours[:, :1]).all())


def _signed_bytes(image: Image) -> bool:
    tags = getattr(image, "tag_v2", {})
    return (
        image.mode == "L"
        and tags.get(SAMPLE_FORMAT, (1,))[0] == SIGNED
        and tags.get(BITS_PER_SAMPLE, (8,))[0] == 8
    )
