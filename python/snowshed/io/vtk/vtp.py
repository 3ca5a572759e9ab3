"""Files of VTK (.vtp): reading the particles that a run stored, and writing triangles."""

from __future__ import annotations

import os
import re
import zlib
from collections.abc import Iterable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, Union
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.io.atomic import replacing
from snowshed.io.input_file import read_regular

TYPES = MappingProxyType(
    {
        "Float32": "<f4",
        "Float64": "<f8",
        "Int32": "<i4",
        "UInt16": "<u2",
        "UInt8": "<u1",
    }
)
APPENDED_HEAD = b'<AppendedData encoding="raw">\n_'
#: End of a file with a checksum of the content before; files of earlier versions have none.
END = re.compile(rb"  <!-- crc32 ([0-9a-f]{8}) -->\n</VTKFile>\n\Z")
OLD_END = b"\n  </AppendedData>\n</VTKFile>\n"
MAX_END_LENGTH = 64  # bytes
LENGTH_BYTES = 8  # before each block


def read_particles(path: Union[str, os.PathLike[str]]) -> dict[str, NDArray[Any]]:
    """Read the particles after an event, or of a snapshot.

    Parameters
    ----------
    path
        A file of a results folder's ``particles/`` or ``snapshots/``.

    Returns
    -------
    dict
        ``position`` (n, 3), m, and the quantities of the particles, (n,) or (n, 3), in SI units;
        all finite, ordered by ``id``. The arrays are read-only.

    Raises
    ------
    InputError
        If the file is not one that snowshed wrote, or is damaged.
    OSError
        If it cannot be read.
    """
    content = read_regular(Path(path))
    try:
        piece, data = _piece(content)
        count = int(piece.attrib["NumberOfPoints"])
        arrays = [*piece.iterfind("Points/DataArray"), *piece.iterfind("PointData/DataArray")]
        return {array.attrib["Name"]: _values(array, data, count) for array in arrays}
    except (ValueError, LookupError, OverflowError, ElementTree.ParseError) as error:
        raise InputError(f"{path}: not particles that snowshed wrote: {error}") from None


def read_cells(
    path: Union[str, os.PathLike[str]],
) -> tuple[NDArray[np.float64], dict[str, NDArray[Any]]]:
    """Read the faces in a file of ``pressures/``: lines or polygons with as many corners each.

    Returns
    -------
    points : (n, 3)
        The corners of one face after the other, m.
    values
        The quantities of the faces, by name.

    Raises
    ------
    InputError
        If the file is not one that snowshed wrote, or is damaged.
    """
    content = read_regular(Path(path))
    try:
        piece, data = _piece(content)
        (points,) = piece.iterfind("Points/DataArray")
        cells = int(piece.attrib["NumberOfLines"]) + int(piece.attrib["NumberOfPolys"])
        return _values(points, data, int(piece.attrib["NumberOfPoints"])), {
            array.attrib["Name"]: _values(array, data, cells)
            for array in piece.iterfind("CellData/DataArray")
        }
    except (ValueError, LookupError, OverflowError, ElementTree.ParseError) as error:
        raise InputError(f"{path}: not faces that snowshed wrote: {error}") from None


def _piece(content: bytes) -> tuple[ElementTree.Element, bytes]:
    """Return the description of a file's piece and its raw data."""
    _check_sum(content)
    head, separator, data = content.partition(APPENDED_HEAD)
    if not separator:
        raise ValueError("it has no appended raw data")
    piece = ElementTree.fromstring(head + b"</VTKFile>").find("PolyData/Piece")
    if piece is None:
        raise ValueError("it has no points")
    return piece, data


def _check_sum(content: bytes) -> None:
    """Raise ValueError if the checksum at the end is wrong; an earlier version wrote none."""
    if content.endswith(OLD_END):
        return
    if not (end := END.search(content, max(0, len(content) - MAX_END_LENGTH))):
        raise ValueError("it ends too early")
    if zlib.crc32(memoryview(content)[: end.start()]) != int(end[1], 16):
        raise ValueError("its checksum is wrong")


def _values(array: ElementTree.Element, data: bytes, count: int) -> NDArray[Any]:
    """Return the values of one array; raises ValueError or KeyError if the file lacks them."""
    components = int(array.attrib["NumberOfComponents"])
    if count < 0 or components not in (1, 3):
        raise ValueError(f"{count} points with {components} values each")
    values = np.frombuffer(
        data,
        TYPES[array.attrib["type"]],
        count * components,
        int(array.attrib["offset"]) + LENGTH_BYTES,
    )
    if values.dtype.kind == "f" and not np.isfinite(values).all():
        raise ValueError(f"{array.attrib['Name']} holds a number that is not finite")
    return values.reshape(count, components) if components > 1 else values


def write_triangles(
    path: Union[str, os.PathLike[str]],
    points: NDArray[np.float32],
    triangles: NDArray[np.integer[Any]],
    values: Mapping[str, NDArray[np.int32]],
) -> None:
    """Write triangles as a .vtp file with appended raw data.

    Parameters
    ----------
    path
        The file.
    points : (n, 3)
        Positions of the corners, m.
    triangles : (m, 3)
        Indices of the corners of each triangle.
    values
        Whole numbers of the triangles (m,), by name.
    """
    count = len(triangles)
    corners = triangles.astype("<i8").ravel()
    ends = np.arange(3, 3 * count + 1, 3, dtype="<i8")
    blocks: list[NDArray[Any]] = [points.astype("<f4")]
    blocks += [value.astype("<i4") for value in values.values()]
    blocks += [corners, ends]
    offsets = np.cumsum([0, *(LENGTH_BYTES + block.nbytes for block in blocks)])
    cells = "".join(
        f'<DataArray type="Int32" Name="{name}" format="appended" offset="{offset}"/>\n'
        for name, offset in zip(values, offsets[1:])
    )
    head = (
        '<?xml version="1.0"?>\n'
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n'
        f'<PolyData><Piece NumberOfPoints="{len(points)}" NumberOfPolys="{count}">\n'
        '<Points><DataArray type="Float32" Name="position" NumberOfComponents="3" '
        f'format="appended" offset="0"/></Points>\n<CellData>\n{cells}</CellData>\n'
        '<Polys><DataArray type="Int64" Name="connectivity" format="appended" '
        f'offset="{offsets[-3]}"/>\n<DataArray type="Int64" Name="offsets" format="appended" '
        f'offset="{offsets[-2]}"/></Polys>\n</Piece></PolyData>\n'
    )
    write_appended(path, head, blocks)


def write_appended(
    path: Union[str, os.PathLike[str]], head: str, blocks: Iterable[NDArray[Any]]
) -> None:
    """Write a file of VTK: the XML `head`, then the arrays `blocks` as raw data."""
    with replacing(path) as beside, beside.open("wb") as file:
        file.write(head.encode("ascii") + APPENDED_HEAD)
        for block in blocks:
            file.write(block.nbytes.to_bytes(LENGTH_BYTES, "little"))
            file.write(np.ascontiguousarray(block).data)
        file.write(b"\n</AppendedData>\n</VTKFile>\n")
