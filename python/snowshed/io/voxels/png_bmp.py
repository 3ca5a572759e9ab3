"""Pictures in PNG and BMP files, read by Pillow."""

from __future__ import annotations

import struct
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.base.damage import DAMAGED
from snowshed.base.extras import require
from snowshed.io.input_file import open_regular
from snowshed.io.voxels.pixel_picture import ORIENTATIONS, PixelPicture
from snowshed.io.voxels.voxel_file import check_size

if TYPE_CHECKING:
    from PIL.Image import Image

#: Pillow's modes with one number per pixel.
TYPES = {
    "1": "uint8", "L": "uint8", "P": "uint8", "I": "int32", "I;16": "<u2", "I;16L": "<u2",
    "I;16B": ">u2", "I;16N": "=u2",
}  # fmt: skip
ORIENTATION = 274  # tag of Exif


def open_picture(path: Path, kind: str) -> PixelPicture:
    """Return the picture in a file of the kind "PNG" or "BMP".

    Raises
    ------
    InputError
        If it is damaged, has colours, or several frames.
    OSError
        If it cannot be read.
    """
    with _open_picture(path, kind) as image:
        width, height = image.size
        check_size(str(path), (1, height, width))
        frames = getattr(image, "n_frames", 1)
        if frames != 1:
            raise InputError(f"{path}: {frames} frames; a slice has one")
        if image.mode not in TYPES or (image.mode == "P" and not _is_grey(image)):
            raise InputError(f"{path}: has colours ({image.mode}); convert it to shades of grey")
        orientation = image.getexif().get(ORIENTATION) if kind == "PNG" else None
        if orientation not in ORIENTATIONS:
            orientation = None
        notes = ("the shades of its palette are used as its numbers",)
        return PixelPicture(
            str(path),
            (height, width),
            np.dtype(TYPES[image.mode]),
            image.mode,
            lambda: _pixels(path, kind),
            orientation,
            path.stat().st_size,
            notes if image.mode == "P" and not _is_plain(image) else (),
        )


def _pixels(path: Path, kind: str) -> NDArray[Any]:
    with _open_picture(path, kind) as image:
        if image.mode not in TYPES or (image.mode == "P" and not _is_grey(image)):
            raise InputError(f"{path}: has colours; convert it to shades of grey")
        pixels = np.asarray(image.convert("L") if image.mode == "P" else image)
        return pixels.astype(np.uint8) if image.mode == "1" else pixels


@contextmanager
def _open_picture(path: Path, kind: str) -> Iterator[Image]:
    """Yield the picture in a file of some kind; errors say that it is damaged."""
    pillow = require("PIL.Image", "images", "reading pictures")
    with open_regular(path) as file:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # our own checks replace Pillow's warnings
                with pillow.open(file, formats=[kind]) as image:
                    yield image
        except InputError:
            raise
        except pillow.DecompressionBombError as error:
            raise InputError(f"{path}: {error}") from None
        except (OSError, struct.error, *DAMAGED) as error:
            raise InputError(f"{path}: damaged: not read as {kind}: {error}") from None


def _colours(image: Image) -> NDArray[np.int64]:
    return np.asarray(image.getpalette("RGB") or [], dtype=np.int64).reshape(-1, 3)


def _is_grey(image: Image) -> bool:
    """Return whether the colours of a palette are shades of grey."""
    colours = _colours(image)
    return bool((colours == colours[:, :1]).all())


def _is_plain(image: Image) -> bool:
    """Return whether each number of a palette is its own shade."""
    colours = _colours(image)
    return bool((colours[:, 0] == np.arange(len(colours))).all())
