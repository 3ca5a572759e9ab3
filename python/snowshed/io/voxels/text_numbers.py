"""Numbers as text, separated by white space."""

from __future__ import annotations

import warnings
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from snowshed._core import InputError
from snowshed.base.limits import MAX_VOXEL_TEXT_BYTES, MB
from snowshed.io.input_file import open_regular
from snowshed.io.voxels.voxel_file import VoxelFile

EXACT = 4  # bytes of the largest integer type that double holds exactly


def text_numbers(
    name: Path, data: Path, shape: tuple[int, int, int], dtype: np.dtype[Any], start: int
) -> VoxelFile:
    """Return an image whose numbers are text, x fastest.

    Parameters
    ----------
    name
        Name of the image in messages.
    data
        The file.
    shape
        Voxels (nz, ny, nx).
    dtype
        Type of the numbers.
    start
        Beginning of the numbers, bytes.

    Raises
    ------
    InputError
        If there are more or fewer numbers, some are beyond their type, or the text is too long.
    OSError
        If it cannot be read.
    """
    if dtype.kind in "iu" and dtype.itemsize > EXACT:
        raise InputError(f"{name}: whole numbers of {dtype.itemsize} bytes as text are not read")
    count = prod(shape)
    with open_regular(data) as file:
        file.seek(start)
        text = file.read(MAX_VOXEL_TEXT_BYTES + 1)
    if len(text) > MAX_VOXEL_TEXT_BYTES:
        raise InputError(
            f"{name}: more than {MAX_VOXEL_TEXT_BYTES // MB} MB of numbers as text; save them as "
            "binary"
        )
    if 2 * count > len(text) + 1:  # at least a digit and a space for each number
        raise InputError(f"{name}: damaged: {len(text):,} characters for {count:,} numbers")
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)  # the text is not a number
        try:
            numbers = np.fromstring(text.decode("ascii"), dtype=np.float64, sep=" ")
        except (ValueError, DeprecationWarning) as error:
            raise InputError(f"{name}: damaged: its text is not only numbers: {error}") from None
    if len(numbers) != count:
        raise InputError(
            f"{name}: damaged: {len(numbers):,} numbers as text; its header says {count:,}"
        )
    native = dtype.newbyteorder("=")
    with np.errstate(invalid="ignore", over="ignore"):
        array = numbers.astype(native)
    if dtype.kind in "iu" and (array != numbers).any():
        raise InputError(f"{name}: damaged: numbers that do not fit {native.name}")
    array = array.reshape(shape)
    return VoxelFile(str(name), shape, native, lambda low, high: array[low:high])
