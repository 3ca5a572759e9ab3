"""Images in MetaImage files: a text header (.mhd) beside the numbers, or before them (.mha).

The fields have the meaning of ITK (MetaIO, https://itk.org/Wiki/ITK/MetaIO/Documentation). Every
field that changes the numbers or their positions is honoured, or the file is refused.
"""

from __future__ import annotations

import re
from math import prod
from pathlib import Path
from typing import Optional

import numpy as np

from snowshed.base.notes import InputNote, issue_note
from snowshed.io.voxels.array_files import number_type, numbers_of
from snowshed.io.voxels.metaimage_fields import HeaderFields
from snowshed.io.voxels.packed_numbers import packed_numbers
from snowshed.io.voxels.text_numbers import text_numbers
from snowshed.io.voxels.turned import Turn, turned
from snowshed.io.voxels.voxel_file import VoxelFile, check_size

#: ElementType of the format, and the type of NumPy.
ELEMENTS = {
    "MET_UCHAR": "uint8",
    "MET_CHAR": "int8",
    "MET_USHORT": "uint16",
    "MET_SHORT": "int16",
    "MET_UINT": "uint32",
    "MET_INT": "int32",
    "MET_ULONG": "uint32",
    "MET_LONG": "int32",
    "MET_ULONG_LONG": "uint64",
    "MET_LONG_LONG": "int64",
    "MET_FLOAT": "float32",
    "MET_DOUBLE": "float64",
}
#: Units of ElementSpacing, m. Without DistanceUnits it is in mm, as in ITK's programs.
UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9}
MATRICES = ("TransformMatrix", "Rotation", "Orientation")
SPACINGS = ("ElementSpacing", "ElementSize")
CUBIC = 1.0001  # ratio of edges up to which a voxel counts as a cube


def open_metaimage(path: Path) -> VoxelFile:
    """Return the image of a .mhd or .mha file; ElementSpacing is in mm unless it names a unit.

    Raises
    ------
    InputError
        If it is damaged, or not a three-dimensional image of one number per voxel on cubes along
        the axes.
    OSError
        If it cannot be read.
    """
    fields = HeaderFields.read(path)
    shape = _shape(fields)
    kind = _kind(fields)
    opened = _numbers(fields, shape, kind)
    _note_on_scale(fields)
    spacing = _spacing(fields)
    image = VoxelFile(str(path), opened.shape, opened.dtype, opened.read_layers, spacing)
    turn = _turn(fields)
    if not turn.is_none:
        issue_note(
            f"{path}: the image is rotated according to its {fields.given(*MATRICES)}", InputNote
        )
    return turned(image, turn)


def _shape(fields: HeaderFields) -> tuple[int, int, int]:
    """Return the voxels (nz, ny, nx)."""
    object_type = fields.text("ObjectType", "Image")
    if object_type != "Image":
        raise fields.wrong("ObjectType", "Image is needed")
    if fields.whole_number("NDims", 3) != 3:
        raise fields.wrong("NDims", "an image of snow has 3")
    if fields.whole_number("ElementNumberOfChannels", 1) != 1:
        raise fields.wrong(
            "ElementNumberOfChannels", "several numbers per voxel (colours?); one is needed"
        )
    sizes = fields.numbers("DimSize", 3)
    if any(size != int(size) for size in sizes):
        raise fields.wrong("DimSize", "whole numbers are needed")
    nx, ny, nz = map(int, sizes)
    check_size(str(fields.path), (nz, ny, nx))
    return nz, ny, nx


def _kind(fields: HeaderFields) -> str:
    """Return the name of the type of the numbers."""
    element = fields.text("ElementType", "")
    if element not in ELEMENTS:
        raise fields.wrong("ElementType", f"{', '.join(ELEMENTS)} are allowed")
    orders = {
        fields.flag(name, False)
        for name in ("ElementByteOrderMSB", "BinaryDataByteOrderMSB")
        if fields.has(name)
    }
    if len(orders) > 1:
        raise fields.wrong("ElementByteOrderMSB", "BinaryDataByteOrderMSB contradicts it")
    return ELEMENTS[element] + ("-be" if True in orders else "")


def _numbers(fields: HeaderFields, shape: tuple[int, int, int], kind: str) -> VoxelFile:
    """Return the image without voxel size and orientation."""
    path, dtype = fields.path, number_type(kind)
    packed = fields.flag("CompressedData", False)
    as_text = not fields.flag("BinaryData", True)
    data = _data_file(fields)
    start = fields.end if data == path else 0
    if fields.has("HeaderSize"):
        start = _header_size(fields, data, start, None if packed or as_text else shape, kind)
    if packed and as_text:
        raise fields.wrong("CompressedData", "numbers as text (BinaryData = False) are not packed")
    if packed:
        size = fields.whole_number("CompressedDataSize", 0)
        return packed_numbers(path, data, shape, dtype, start, size)
    if as_text:
        return text_numbers(path, data, shape, dtype, start)
    return numbers_of(path, data, shape, dtype, start)


def _data_file(fields: HeaderFields) -> Path:
    """Return the file of the numbers: the same file, or a file in the same folder."""
    path, name = fields.path, fields.text("ElementDataFile", "")
    if name.upper() == "LOCAL":
        return path
    if not name or name.split()[0] == "LIST" or "%" in name:
        raise fields.wrong(
            "ElementDataFile", "one file is needed; join slices into one, or open their folder"
        )
    inside = Path(name).name == name and name not in (".", "..") and "\\" not in name
    if inside:
        data = path.with_name(name)
        inside = data.resolve().parent == path.parent.resolve() or not data.exists()
    if not inside:
        raise fields.wrong("ElementDataFile", "it must be in the same folder")
    return data


def _header_size(
    fields: HeaderFields, data: Path, start: int, shape: Optional[tuple[int, int, int]], kind: str
) -> int:
    """Return the number of bytes before the numbers; -1 means everything except the numbers."""
    text = fields.text("HeaderSize", "")
    if not re.fullmatch(r"-1|[0-9]{1,15}", text):
        raise fields.wrong("HeaderSize", "a number of bytes is needed")
    if int(text) == 0:
        return start
    if int(text) > 0:
        return int(text)
    if shape is None:
        raise fields.wrong("HeaderSize", "it must be known where packed numbers begin")
    size = data.stat().st_size - prod(shape) * number_type(kind).itemsize
    return max(size, start)


def _note_on_scale(fields: HeaderFields) -> None:
    """Print a note that the file's scale is not applied to the numbers."""
    (slope,) = fields.numbers("ElementToIntensityFunctionSlope", 1, [1.0])
    (offset,) = fields.numbers("ElementToIntensityFunctionOffset", 1, [0.0])
    if slope <= 0:
        raise fields.wrong("ElementToIntensityFunctionSlope", "only positive ones are read")
    if (slope, offset) != (1.0, 0.0):
        issue_note(
            f"{fields.path}: the stored numbers are used; ElementToIntensityFunctionSlope "
            f"{slope:g} and Offset {offset:g} are not applied, also not to thresholds",
            InputNote,
        )


def _spacing(fields: HeaderFields) -> Optional[float]:
    """Return the edge of a voxel, m."""
    name = fields.given(*SPACINGS)
    if name is None:
        return None
    if name == "ElementSize":
        issue_note(
            f"{fields.path}: ElementSize is used as the spacing, because ElementSpacing is missing",
            InputNote,
        )
    unit = fields.text("DistanceUnits", "mm").lower()
    unit = {"?": "mm", "\N{MICRO SIGN}m": "um", "\N{GREEK SMALL LETTER MU}m": "um"}.get(unit, unit)
    if unit not in UNITS:
        raise fields.wrong("DistanceUnits", f"{', '.join(UNITS)} are allowed")
    edges = fields.numbers(name, 3)
    if min(edges) <= 0 or max(edges) > CUBIC * min(edges):
        raise fields.wrong(name, "voxels must be cubes; resample the image")
    return float(f"{edges[0] * UNITS[unit]:.12g}")


def _turn(fields: HeaderFields) -> Turn:
    """Return the axes of the image by those of the file.

    Every three numbers are the direction of an axis of the file; the axis x comes first.
    """
    name = fields.given(*MATRICES)
    if name is None:
        return Turn()
    matrix = np.array(fields.numbers(name, 9)).reshape(3, 3)  # axis of the file, x y z
    steps = np.rint(matrix)
    along_axes = np.abs(matrix - steps).max() < 1e-4 and (np.abs(steps).sum(axis=0) == 1).all()
    if not along_axes or not (np.abs(steps).sum(axis=1) == 1).all():
        raise fields.wrong(name, "the axes must be along x, y and z; resample the image")
    axes, mirrored = [], []
    for axis in (2, 1, 0):  # of the image: z, y, x
        own = int(np.flatnonzero(steps[:, axis])[0])  # of the file, x first
        axes.append(2 - own)
        mirrored.append(bool(steps[own, axis] < 0))
    return Turn((axes[0], axes[1], axes[2]), (mirrored[0], mirrored[1], mirrored[2]))
