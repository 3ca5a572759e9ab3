"""Images in MetaImage files: a text header (.mhd) beside raw numbers, or before them (.mha)."""

from __future__ import annotations

import math
import re
import zlib
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from snowshed._core import InputError
from snowshed.io.messages import quoted
from snowshed.io.voxels.array_files import number_type, open_raw
from snowshed.io.voxels.voxel_file import VoxelFile, check_size

LONGEST_HEADER = 1 << 16
MM = 1e-3
#: ElementType of the format, and what it is here.
ELEMENTS = {
    "MET_UCHAR": "uint8",
    "MET_CHAR": "int8",
    "MET_USHORT": "uint16",
    "MET_SHORT": "int16",
    "MET_UINT": "uint32",
    "MET_INT": "int32",
    "MET_FLOAT": "float32",
    "MET_DOUBLE": "float64",
}


def open_metaimage(path: Path) -> VoxelFile:
    """Return the image of a .mhd or .mha file; its ElementSpacing is in mm, as ITK has it.

    Raises
    ------
    InputError
        If it is damaged, or not a three-dimensional image of one number per voxel on cubes.
    OSError
        If it cannot be read.
    """
    fields, start = _header(path)
    if _flag(fields, "ElementNumberOfChannels", "1") != "1":
        raise InputError(f"{path}: several numbers per voxel (colours?); one is needed")
    sizes = _numbers(path, fields, "DimSize")
    if any(size != int(size) for size in sizes):
        raise InputError(f"{path}: DimSize {sizes}: not whole numbers")
    shape = tuple(int(size) for size in reversed(sizes))  # x first in the file
    check_size(str(path), shape)
    nz, ny, nx = shape
    element = fields.get("ElementType", "")
    if element not in ELEMENTS:
        raise InputError(
            f"{path}: ElementType {quoted(element)}; {', '.join(ELEMENTS)} are allowed"
        )
    big = "True" in (
        _flag(fields, "ElementByteOrderMSB", "False"),
        _flag(fields, "BinaryDataByteOrderMSB", "False"),
    )
    kind = ELEMENTS[element] + ("-be" if big else "")
    data, offset = _data_file(path, fields, start)
    if _flag(fields, "CompressedData", "False") == "True":
        opened = _compressed(path, data, offset, (nz, ny, nx), kind)
    else:
        if data != path and "HeaderSize" in fields:
            offset = _header_size(path, fields, data, (nz, ny, nx), kind)
        opened = open_raw(data, (nz, ny, nx), kind, offset)
    return VoxelFile(
        str(path), opened.shape, opened.dtype, opened.read_layers, _spacing(path, fields)
    )


def _header(path: Path) -> tuple[dict[str, str], int]:
    """Return the fields of the header, and where it ends."""
    with path.open("rb") as file:
        head = file.read(LONGEST_HEADER)
    fields: dict[str, str] = {}
    position = 0
    while "ElementDataFile" not in fields:
        end = head.find(b"\n", position)
        line = head[position : end if end >= 0 else len(head)]
        name, equals, value = line.decode("utf-8", "replace").partition("=")
        if not equals or (end < 0 and len(head) == LONGEST_HEADER):
            raise InputError(f"{path}: damaged: no line ElementDataFile = ... in its header")
        fields[name.strip()] = value.strip()
        position = end + 1 if end >= 0 else len(head)
        if position >= len(head) and "ElementDataFile" not in fields:
            raise InputError(f"{path}: damaged: its header ends before ElementDataFile")
    return fields, position


def _flag(fields: dict[str, str], name: str, default: str) -> str:
    value = fields.get(name, default)
    return value.capitalize() if value.lower() in ("true", "false") else value


def _numbers(path: Path, fields: dict[str, str], name: str) -> list[float]:
    try:
        numbers = [float(word) for word in fields[name].split()]
    except (KeyError, ValueError):
        raise InputError(
            f"{path}: {name} {quoted(fields.get(name, ''))}: three numbers are needed"
        ) from None
    if len(numbers) != 3 or not all(math.isfinite(number) for number in numbers):
        raise InputError(f"{path}: {name} {quoted(fields[name])}: three numbers are needed")
    return numbers


def _spacing(path: Path, fields: dict[str, str]) -> float | None:
    if "ElementSpacing" not in fields:
        return None
    spacing = _numbers(path, fields, "ElementSpacing")
    if min(spacing) <= 0 or max(spacing) > 1.0001 * min(spacing):
        raise InputError(
            f"{path}: ElementSpacing {fields['ElementSpacing']}: voxels must be cubes; resample "
            "the image"
        )
    return spacing[0] * MM


def _data_file(path: Path, fields: dict[str, str], start: int) -> tuple[Path, int]:
    """Return the file of the numbers, which is the same or beside it, and where they begin."""
    name = fields["ElementDataFile"]
    if name == "LOCAL":
        return path, start
    if not name or name.startswith("LIST") or "%" in name:
        raise InputError(f"{path}: ElementDataFile {quoted(name)}: one file is needed")
    if Path(name).name != name or name in (".", "..") or "\\" in name:
        raise InputError(f"{path}: ElementDataFile {quoted(name)}: must be in the same folder")
    return path.with_name(name), 0


def _header_size(
    path: Path, fields: dict[str, str], data: Path, shape: tuple[int, int, int], kind: str
) -> int:
    """Return how many bytes of the raw file come before the numbers; -1 means: all others."""
    size = fields["HeaderSize"]
    if not re.fullmatch(r"-1|[0-9]{1,15}", size):
        raise InputError(f"{path}: HeaderSize {quoted(size)}: a number of bytes is needed")
    if int(size) >= 0:
        return int(size)
    return max(data.stat().st_size - prod(shape) * np.dtype(kind.partition("-")[0]).itemsize, 0)


def _compressed(
    path: Path, data: Path, offset: int, shape: tuple[int, int, int], kind: str
) -> VoxelFile:
    """Return an image that zlib compressed; no more is unpacked than its header says."""
    dtype = number_type(kind)
    expected = prod(shape) * dtype.itemsize
    unpacker = zlib.decompressobj()
    with data.open("rb") as file:
        file.seek(offset)
        packed = file.read(expected + (1 << 20))  # zlib never makes data much longer
    try:
        numbers = unpacker.decompress(packed, expected)
    except zlib.error as error:
        raise InputError(f"{path}: damaged: {error}") from None
    if len(numbers) < expected:
        raise InputError(
            f"{path}: damaged: {len(numbers):,} bytes unpacked; its header says {expected:,}"
        )
    array: np.ndarray[Any, Any] = np.frombuffer(numbers, dtype).reshape(shape)
    return VoxelFile(str(path), shape, dtype, lambda low, high: array[low:high])
