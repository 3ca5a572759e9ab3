"""Images in NPY files, and in raw files of given size and type."""

from __future__ import annotations

import os
from math import prod
from pathlib import Path
from typing import Any

import numpy as np
from numpy.lib import format as npy_format
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.base.damage import DAMAGED
from snowshed.base.messages import quoted
from snowshed.base.notes import InputNote, issue_note
from snowshed.io.input_file import open_regular, stored_bytes
from snowshed.io.voxels.turned import Turn, turned
from snowshed.io.voxels.voxel_file import VoxelFile, check_size, check_type, check_unpacked

#: Names of types as people write them; a trailing "-be" is big-endian.
TYPES = (
    "uint8", "int8", "uint16", "int16", "uint32", "int32", "uint64", "int64", "float32", "float64"
)  # fmt: skip
MAX_HEADER = 10_000
COLUMNS_FIRST = Turn((2, 1, 0))


def open_npy(path: Path) -> VoxelFile:
    """Return the image of an NPY file (nz, ny, nx).

    Raises
    ------
    InputError
        If it is damaged or holds something else.
    OSError
        If it cannot be read.
    """
    with open_regular(path) as file:
        try:
            version = npy_format.read_magic(file)
            read = {(1, 0): npy_format.read_array_header_1_0}.get(
                version, npy_format.read_array_header_2_0
            )
            shape, columns_first, dtype = read(file, max_header_size=MAX_HEADER)
        except DAMAGED as error:
            raise InputError(f"{path}: damaged: no NPY file: {error}") from None
        start = file.tell()
    shape = tuple(map(int, shape))
    if not columns_first:
        return numbers_of(path, path, shape, dtype, start)
    return turned(numbers_of(path, path, shape[::-1], dtype, start), COLUMNS_FIRST)


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
    return numbers_of(path, path, shape, number_type(kind), offset)


def number_type(kind: str) -> np.dtype[Any]:
    """Return the type with a name.

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


def numbers_of(
    name: Path, data: Path, shape: tuple[int, ...], dtype: np.dtype[Any], start: int
) -> VoxelFile:
    """Return an image whose numbers follow one another in a file, the last axis fastest.

    Parameters
    ----------
    name
        Name of the image in messages.
    data
        The file.
    shape
        Shape of the image.
    dtype
        Type of the numbers.
    start
        Bytes before the first number. With an offset, bytes after the last number are left out, and
        a note reports them.

    Raises
    ------
    InputError
        If the file is too short, too long for a file without a header, or mostly holes.
    OSError
        If it cannot be read.
    """
    check_size(str(name), shape)
    check_type(str(name), dtype)
    count = prod(shape) * dtype.itemsize
    with open_regular(data) as file:
        size = os.fstat(file.fileno()).st_size
        if size < start + count or (size > start + count and start == 0):
            raise InputError(
                f"{data}: damaged: {size:,} bytes; {' x '.join(map(str, shape))} voxels of type "
                f"{dtype.name} take {start + count:,}"
            )
        check_unpacked(str(data), count, stored_bytes(file, count))
    if size > start + count:
        issue_note(
            f"{data}: {size - start - count:,} bytes after the image are left out", InputNote
        )
    nz, ny, nx = shape
    layer = ny * nx

    def read(low: int, high: int) -> NDArray[Any]:
        with open_regular(data) as file:
            file.seek(start + low * layer * dtype.itemsize)
            numbers = np.fromfile(file, dtype, (high - low) * layer)
        if len(numbers) < (high - low) * layer:
            raise InputError(f"{data}: damaged: it has become shorter")
        if dtype.kind == "b":  # a byte may hold any number
            numbers = numbers.view(np.uint8) != 0
        return numbers.reshape(high - low, ny, nx)

    return VoxelFile(str(name), (nz, ny, nx), dtype, read)
