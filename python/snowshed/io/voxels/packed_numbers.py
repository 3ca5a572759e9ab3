"""Numbers that zlib packed, unpacked a few layers at a time."""

from __future__ import annotations

import os
import zlib
from math import prod
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.base.limits import MB
from snowshed.io.input_file import open_regular
from snowshed.io.voxels.voxel_file import VoxelFile, check_unpacked

PIECE = MB  # packed bytes in a chunk
WINDOW_BITS = 47  # of zlib; accepts streams of zlib and of gzip


def packed_numbers(
    name: Path, data: Path, shape: tuple[int, int, int], dtype: np.dtype[Any], start: int, size: int
) -> VoxelFile:
    """Return an image whose numbers are a stream of zlib, unpacked while they are read.

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
        Beginning of the stream, bytes.
    size
        Length of the packed bytes; 0: to the end of the file.

    Raises
    ------
    InputError
        If the numbers unpack to far more bytes than those of any image of snow.
    OSError
        If it cannot be read.
    """
    with open_regular(data) as file:
        file_bytes = max(os.fstat(file.fileno()).st_size - start, 0)
    if size > file_bytes:
        raise InputError(f"{name}: damaged: {file_bytes:,} packed bytes; its header says {size:,}")
    check_unpacked(str(name), prod(shape) * dtype.itemsize, size or file_bytes)
    return VoxelFile(str(name), shape, dtype, _PackedLayers(str(name), data, shape, dtype, start))


class _PackedLayers:
    """Reader of layers; consecutive layers continue the unpacking."""

    def __init__(
        self, name: str, data: Path, shape: tuple[int, int, int], dtype: np.dtype[Any], start: int
    ) -> None:
        self.name, self.data, self.start = name, data, start
        self.shape, self.dtype = shape, dtype
        self.stream = _Stream(name, start)

    def __call__(self, low: int, high: int) -> NDArray[Any]:
        _, ny, nx = self.shape
        layer = ny * nx * self.dtype.itemsize
        if self.stream.done > low * layer:
            self.stream = _Stream(self.name, self.start)
        with open_regular(self.data) as file:
            while self.stream.done < low * layer:
                self.stream.take(file, min(low * layer - self.stream.done, PIECE))
            unpacked = self.stream.take(file, (high - low) * layer)
        return np.frombuffer(unpacked, self.dtype).reshape(high - low, ny, nx)


class _Stream:
    """The unpacked bytes of a stream, from its beginning.

    Attributes
    ----------
    done
        Number of bytes read.
    """

    def __init__(self, name: str, start: int) -> None:
        self.name = name
        self.done = 0
        self._next = start  # packed byte in the file
        self._unpacker = zlib.decompressobj(WINDOW_BITS)

    def take(self, file: BinaryIO, count: int) -> bytearray:
        """Return the next bytes."""
        file.seek(self._next)
        unpacked = bytearray()
        while len(unpacked) < count:
            packed = self._unpacker.unconsumed_tail or file.read(PIECE)
            if not packed or self._unpacker.eof:
                raise InputError(
                    f"{self.name}: damaged: {self.done + len(unpacked):,} bytes unpacked; its "
                    "header "
                    "says more"
                )
            try:
                unpacked += self._unpacker.decompress(packed, count - len(unpacked))
            except zlib.error as error:
                raise InputError(f"{self.name}: damaged: {error}") from None
        self._next = file.tell()
        self.done += count
        return unpacked
