"""Well-known binary geometries, checked before a library reads them.

GEOS follows geometries within geometries without a limit, and a file can nest millions of them.
"""

from __future__ import annotations

import struct

from snowshed._core import InputError

LINE, POLYGON, MULTILINE, MULTIPOLYGON = 2, 3, 5, 6
#: Geometries with parts, and the geometry of each part.
PARTS = {MULTILINE: LINE, MULTIPOLYGON: POLYGON}
#: Curves: CircularString, CompoundCurve, CurvePolygon, MultiCurve, MultiSurface.
CURVED_TYPES = (8, 9, 10, 11, 12)


def count_corners(wkb: bytes, where: str, *, lines: bool = False) -> int:
    r"""Return the number of corners of a polygon or of several polygons.

    Parameters
    ----------
    wkb
        The geometry.
    where
        Its place in messages.
    lines
        Whether lines are allowed, too.

    Raises
    ------
    InputError
        If it is another geometry, or is truncated.

    Examples
    --------
    >>> ring = struct.pack("<I6d", 3, 0, 0, 1, 0, 0, 1)
    >>> count_corners(b"\x01" + struct.pack("<II", 3, 1) + ring, "here")
    3
    """
    other = f"{where}: not a {'line or a polygon' if lines else 'polygon'}"
    try:
        kind, offset, byte_order, _ = _head(wkb, 0)
        if kind in CURVED_TYPES:
            raise InputError(
                f"{where}: has curved edges; draw it with straight ones (QGIS: Segmentize)"
            )
        if kind not in (POLYGON, MULTIPOLYGON, *((LINE, MULTILINE) if lines else ())):
            raise InputError(other)
        if kind not in PARTS:
            return _corners_of_part(wkb, 0)[0]
        (parts,) = struct.unpack_from(f"{byte_order}I", wkb, offset)
        offset, corners = offset + 4, 0
        for _ in range(parts):
            if _head(wkb, offset)[0] != PARTS[kind]:
                raise InputError(other)
            count, offset = _corners_of_part(wkb, offset)
            corners += count
    except struct.error:
        raise InputError(f"{where}: its geometry is damaged") from None
    return corners


def _head(wkb: bytes, offset: int) -> tuple[int, int, str, int]:
    """Return kind, next offset, byte order, and number of coordinates of a corner."""
    byte_order = "<" if wkb[offset : offset + 1] == b"\1" else ">"
    (code,) = struct.unpack_from(f"{byte_order}I", wkb, offset + 1)
    offset += 9 if code & 0x20000000 else 5  # an identifier of the coordinate system
    base = code & 0x0FFFFFFF
    numbers = 2 + bool(code & 0x80000000) + bool(code & 0x40000000)
    numbers += {0: 0, 1: 1, 2: 1, 3: 2}.get(base // 1000, 0)
    return base % 1000, offset, byte_order, numbers


def _corners_of_part(wkb: bytes, offset: int) -> tuple[int, int]:
    """Return the number of corners of a line or a polygon, and the offset after it."""
    kind, offset, byte_order, numbers = _head(wkb, offset)
    rings, corners = 1, 0
    if kind == POLYGON:
        (rings,) = struct.unpack_from(f"{byte_order}I", wkb, offset)
        offset += 4
    for _ in range(rings):
        (count,) = struct.unpack_from(f"{byte_order}I", wkb, offset)
        offset += 4 + count * numbers * 8
        corners += count
        if offset > len(wkb):
            raise struct.error
    return corners, offset
