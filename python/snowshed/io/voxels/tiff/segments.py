"""The strips and tiles of a TIFF page: from packed bytes to numbers.

zlib and lzma unpack at most a strip. libtiff unpacks the other kinds of compression, through
Pillow: it gets each strip as a small TIFF file of bytes, so that the type of the numbers does not
matter.
"""

from __future__ import annotations

import io
import lzma
import struct
import warnings
import zlib
from dataclasses import dataclass
from typing import Any, BinaryIO, Optional

import numpy as np
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.base.damage import DAMAGED
from snowshed.base.extras import require
from snowshed.base.messages import shortened

NONE, JPEG, PACKED_BY_LZMA = 1, 7, 34925
DEFLATE = (8, 32946)
FAX = (2, 3, 4)
#: Compressions that libtiff unpacks: fax, LZW, JPEG, PackBits, Zstandard.
BY_LIBTIFF = (*FAX, 5, JPEG, 32773, 50000)
READ = (NONE, *DEFLATE, PACKED_BY_LZMA, *BY_LIBTIFF)
NO_PREDICTOR, DIFFERENCES, FLOAT_DIFFERENCES = 1, 2, 3
REVERSED_BITS = np.packbits(np.unpackbits(np.arange(256, dtype=np.uint8)).reshape(256, 8)[:, ::-1])


@dataclass(frozen=True)
class Coding:
    """Coding of the numbers of a page.

    Attributes
    ----------
    compression, predictor
        Number of the compression in TIFF.
    bits
        Bits of a number.
    dtype
        Type of a number, in the byte order of the file; uint8 for fewer than 8 bits.
    reversed_bits
        Whether the lowest bit of a byte comes first (FillOrder 2).
    tables
        Tables of JPEG that all strips share.
    options
        Options of fax coding (T4Options or T6Options).
    """

    compression: int
    predictor: int
    bits: int
    dtype: np.dtype[Any]
    reversed_bits: bool = False
    tables: Optional[bytes] = None
    options: int = 0

    def row_bytes(self, columns: int) -> int:
        """Return the number of bytes of an unpacked row."""
        return (columns * self.bits + 7) // 8

    def longest(self, rows: int, columns: int) -> int:
        """Return the largest plausible number of bytes of packed rows."""
        return 2 * rows * self.row_bytes(columns) + (1 << 16)


def decoded(coding: Coding, packed: bytes, rows: int, columns: int, name: str) -> NDArray[Any]:
    """Return the numbers of a strip or tile, (rows, columns).

    Raises
    ------
    InputError
        If it is damaged.
    """
    if coding.reversed_bits:
        packed = REVERSED_BITS[np.frombuffer(packed, np.uint8)].tobytes()
    try:
        if coding.compression in FAX or coding.compression == JPEG:
            return _by_libtiff(coding, packed, rows, columns)
        unpacked = _unpacked(coding, packed, rows, columns)
    except (zlib.error, lzma.LZMAError, OSError, struct.error, *DAMAGED) as error:
        raise InputError(f"{name}: damaged: {shortened(str(error), 200)}") from None
    width = coding.row_bytes(columns)
    if len(unpacked) < rows * width:
        raise InputError(
            f"{name}: damaged: {len(unpacked):,} bytes in a strip or tile of {rows * width:,}"
        )
    bytes_of_rows = np.frombuffer(unpacked, np.uint8, rows * width).reshape(rows, width)
    if coding.bits < 8:
        return _from_bits(bytes_of_rows, coding.bits, columns)
    return _numbers(coding, bytes_of_rows, columns)


def _unpacked(coding: Coding, packed: bytes, rows: int, columns: int) -> bytes:
    count = rows * coding.row_bytes(columns)
    if coding.compression == NONE:
        return packed[:count]
    if coding.compression in DEFLATE:
        return zlib.decompressobj().decompress(packed, count)
    if coding.compression == PACKED_BY_LZMA:
        return lzma.LZMADecompressor().decompress(packed, count)
    return _by_libtiff(coding, packed, rows, coding.row_bytes(columns)).tobytes()


def _by_libtiff(coding: Coding, packed: bytes, rows: int, columns: int) -> NDArray[Any]:
    """Return a strip unpacked by libtiff, as bytes, or for fax as bits."""
    pillow = require("PIL.Image", "images", "reading compressed pictures")
    fax = coding.compression in FAX
    tags = {
        256: columns, 257: rows, 258: 1 if fax else 8, 259: coding.compression, 262: 1, 277: 1,
        278: rows, 279: len(packed),
    }  # fmt: skip
    if fax and coding.options:
        tags[292 if coding.compression == 3 else 293] = coding.options
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        file = io.BytesIO(_one_strip(tags, packed, coding.tables))
        try:
            with pillow.open(file, formats=["TIFF"]) as image:
                pixels = np.asarray(image)
        except pillow.DecompressionBombError as error:
            raise ValueError(f"a strip or tile is too large: {error}") from None
    return pixels.astype(np.uint8)


def _one_strip(tags: dict[int, int], packed: bytes, tables: Optional[bytes]) -> bytes:
    """Return a TIFF file of one strip (TIFF 6.0)."""
    count = len(tags) + 1 + (tables is not None)
    after = 8 + 2 + 12 * count + 4
    entries = [struct.pack("<HHII", code, 4, 1, value) for code, value in tags.items()]
    entries.append(struct.pack("<HHII", 273, 4, 1, after))
    if tables is not None:
        entries.append(struct.pack("<HHII", 347, 7, len(tables), after + len(packed)))
    entries.sort(key=lambda entry: struct.unpack("<H", entry[:2]))
    head = struct.pack("<2sHIH", b"II", 42, 8, count)
    return head + b"".join(entries) + bytes(4) + packed + (tables or b"")


def _from_bits(rows: NDArray[np.uint8], bits: int, columns: int) -> NDArray[Any]:
    """Return numbers of 1, 2 or 4 bits; the first is in the highest bits."""
    parts = [(rows >> shift) & ((1 << bits) - 1) for shift in range(8 - bits, -1, -bits)]
    return np.stack(parts, axis=-1).reshape(len(rows), -1)[:, :columns]


def _numbers(coding: Coding, rows: NDArray[np.uint8], columns: int) -> NDArray[Any]:
    dtype = coding.dtype
    if coding.predictor == FLOAT_DIFFERENCES:  # the highest bytes of all numbers come first
        planes = np.cumsum(rows, axis=1, dtype=np.uint8).reshape(len(rows), dtype.itemsize, -1)
        numbers = np.ascontiguousarray(planes.transpose(0, 2, 1)).view(f">f{dtype.itemsize}")
        return numbers.reshape(len(rows), columns)
    numbers = rows.view(dtype)
    if coding.predictor == DIFFERENCES:
        integers = numbers.view(f"{dtype.str[0]}u{dtype.itemsize}")
        native = np.dtype(f"u{dtype.itemsize}")
        return np.cumsum(integers, axis=1, dtype=native).view(dtype.newbyteorder("="))
    return numbers


def read_at(file: BinaryIO, offset: int, count: int, name: str) -> bytes:
    """Return bytes of a file; raises InputError if some are missing."""
    file.seek(offset)
    content = file.read(count)
    if len(content) < count:
        raise InputError(f"{name}: damaged: the file ends before its numbers do")
    return content
