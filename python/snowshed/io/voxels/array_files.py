"""Images in NPY files, and in raw files whose size and type are known from elsewhere."""

from __future__ import annotations

from math import prod
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import format as npy_format

from snowshed._core import InputError
from snowshed.io.damage import DAMAGED
from snowshed.io.messages import quoted
from snowshed.io.voxels.voxel_file import VoxelFile, check_size, check_type

#: Names of types as people write them; a trailing "-be" is big-endian.
TYPES = ("uint8", "int8", "uint16", "int16", "uint32", "int32", "float32", "float64")
LONGEST_HEADER = 10_000


def open_npy(path: Path) -> VoxelFile:
    """Return the image of an NPY file (nz, ny, nx).

    Raises
    ------
    InputError
        If it is damaged or holds something else.
    OSError
        If it cannot be read.
    """
    with path.open("rb") as file:
        try:
            version = npy_format.read_magic(file)
            read = {(1, 0): npy_format.read_array_header_1_0}.get(
                version, npy_format.read_array_header_2_0
            )
            shape, columns_first, dtype = read(file, max_header_size=LONGEST_HEADER)
        except DAMAGED as error:
            raise InputError(f"{path}: damaged: no NPY file: {error}") from None
        start = file.tell()
    return _mapped(path, tuple(map(int, shape)), dtype, start, "F" if columns_first else "C")


def open_raw(path: Path, shape: tuple[int, int, int], kind: str, offset: int = 0) -> VoxelFile:
    """Return the image of a file of bare numbers, x fastest.

    Parameters
    ----------
    path
        The file.
    shape
        Voxels (nz, ny, nx).
    kind
        One of `TYPES`, with "-be" if big-endian.
    offset
        Bytes before the first number.

    Raises
    ------
    InputError
        If the file has another size.
    OSError
        If it cannot be read.
    """
    return _mapped(path, shape, number_type(kind), offset, "C")


def number_type(kind: str) -> np.dtype[Any]:
    """Return the type of a name.

    Examples
    --------
    >>> number_type("uint16-be").str
    '>u2'
    """
    name, big, end = kind.partition("-be")
    if name not in TYPES or end:
        raise InputError(
            f"type {quoted(kind)}: {', '.join(TYPES)}, each also with -be, are allowed"
        )
    return np.dtype(name).newbyteorder(">" if big else "<")


def _mapped(
    path: Path, shape: tuple[int, ...], dtype: np.dtype[Any], start: int, order: str
) -> VoxelFile:
    check_size(str(path), shape)
    check_type(str(path), dtype)
    expected = start + prod(shape) * dtype.itemsize
    size = path.stat().st_size
    if size < expected or (size > expected and start == 0):
        raise InputError(
            f"{path}: damaged: {size:,} bytes; {' x '.join(map(str, shape))} voxels of type "
            f"{dtype.name} take {expected:,}"
        )
    numbers = np.memmap(path, dtype, "r", start, shape, order)  # type: ignore[call-overload]
    nz, ny, nx = shape
    return VoxelFile(str(path), (nz, ny, nx), dtype, lambda low, high: np.array(numbers[low:high]))
