"""Areas on a map from files of polygons: shapefile, GeoPackage, GeoJSON.

They need the extra snowshed[terrain].
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike

from snowshed._core import InputError
from snowshed.base.callers import argument
from snowshed.base.extras import require
from snowshed.base.formatting import plural
from snowshed.base.messages import shortened
from snowshed.base.notes import InputNote, issue_note
from snowshed.base.paths import PathLike
from snowshed.io.coordinates.systems import is_in_degrees
from snowshed.io.polygons import read_layer
from snowshed.io.polygons.layer import PolygonLayer
from snowshed.io.raster.thickness import (
    ThicknessField,
    note_replaced_fields,
    thickness_fields,
    thickness_of,
)

Ring = Sequence[Sequence[float]]

MAX_NAME = 200  # characters


def ring_area(ring: ArrayLike) -> float:
    """Return the area within a ring of corners (x, y), m2.

    Examples
    --------
    >>> ring_area([(0.0, 0.0), (2.0, 0.0), (2.0, 3.0), (0.0, 3.0)])
    6.0
    """
    corners = np.asarray(ring, dtype=float)
    x, y = (corners - corners[0]).T
    return 0.5 * abs(float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))))


@dataclass(frozen=True)
class MapArea:
    """A polygon on the map.

    Attributes
    ----------
    name
        Name from the file, or "area 1" and so on.
    outline
        Corners (x, y) of the outline, m, the first not repeated.
    holes
        Rings of holes.
    thickness
        Thickness of the snow, m, if the file states it.
    crs
        Coordinate system of the file as text, such as "EPSG:31287"; empty if it has none.
    file
        Source file.
    """

    name: str
    outline: Ring
    holes: tuple[Ring, ...] = ()
    thickness: Optional[float] = None
    crs: str = ""
    file: str = ""


def read_areas(
    path: PathLike,
    layer: Optional[str] = None,
    *,
    option: Optional[str] = None,
    with_thickness: bool = True,
    replacement: str = "",
) -> list[MapArea]:
    """Return the polygons of a file; parts of a feature become areas of their own.

    Parameters
    ----------
    path
        A GeoPackage, a shapefile (its .shp) or GeoJSON, on a projected map.
    layer
        Name of the layer of a GeoPackage; None: the only one.
    option
        The argument that selects a layer; an error names it if the file has several. None:
        ``layer``.
    with_thickness
        Whether the thickness of snow is read; else it is None.
    replacement
        Source of the thickness in place of the file, whose own is then None, with a note.

    Raises
    ------
    InputError
        If the file has no polygons or several layers, a polygon crosses itself, its coordinates are
        in degrees, or the reading libraries are missing.
    OSError
        If there is no such file.
    """
    path = Path(path)
    features = read_map_layer(path, layer, option=option)
    fields: list[ThicknessField] = []
    if replacement:
        note_replaced_fields(features.fields, str(path), replacement)
    elif with_thickness:
        fields = thickness_fields(features.fields, str(path))
    areas = list(_areas(features, fields, path))
    if not areas:
        raise InputError(f"{path}: holds no polygon")
    return areas


def read_map_layer(
    path: Path, layer: Optional[str] = None, *, option: Optional[str] = None, lines: bool = False
) -> PolygonLayer:
    """Return the polygons of a file on a projected map, as they are in the file.

    Parameters
    ----------
    path, layer, option
        As in `read_areas`.
    lines
        Whether lines are read, too.

    Raises
    ------
    InputError
        As in `read_areas`.
    OSError
        If there is no such file.
    """
    features = read_layer(path, layer, option or argument("layer"), lines=lines)
    if is_in_degrees(features.crs):
        raise InputError(
            f"{path}: its coordinates are in degrees ({features.crs}); project it to metres"
        )
    _check_shapes(features.shapes, path, lines=lines)
    if not features.crs:
        issue_note(f"{path}: has no coordinate system; that of the terrain is assumed", InputNote)
    return features


def _areas(layer: PolygonLayer, fields: Sequence[ThicknessField], path: Path) -> Iterator[MapArea]:
    """Return the areas in the order of the features; each part of a feature is one."""
    shapely: Any = require("shapely", "terrain", "reading polygons")
    names = names_of(layer, "area")
    thicknesses = [
        thickness_of(fields, record, f"{path}, feature {number}")
        for number, record in enumerate(layer.records, 1)
    ]
    parts, owners = shapely.get_parts(layer.shapes, return_index=True)
    rings = _rings(parts, shapely)
    empty = len(layer.shapes) - len({owner for part, owner in enumerate(owners) if rings[part]})
    if empty:
        issue_note(f"{path}: {plural(empty, 'feature')} without corners, left out", InputNote)
    for part, owner in enumerate(owners.tolist()):
        if rings[part]:
            outline, *holes = rings[part]
            yield MapArea(
                names[owner], outline, tuple(holes), thicknesses[owner], layer.crs, str(path)
            )


def names_of(layer: PolygonLayer, noun: str) -> list[str]:
    """Return the names of all features: those of the field "name", or a noun with a number."""
    named = next((field for field in layer.fields if field.strip().lower() == "name"), "")
    return [
        shortened(str(record.get(named) or f"{noun} {number}"), MAX_NAME)
        for number, record in enumerate(layer.records, 1)
    ]


def _rings(polygons: Any, shapely: Any) -> list[list[Ring]]:
    """Return the rings of each polygon, the outline first; none for an empty polygon.

    Repeated corners are left out, because map programs ignore them.
    """
    rings, owners = shapely.get_rings(polygons, return_index=True)
    corners, of_ring = shapely.get_coordinates(rings, return_index=True)
    repeated = np.zeros(len(corners), dtype=bool)
    repeated[1:] = (of_ring[1:] == of_ring[:-1]) & (corners[1:] == corners[:-1]).all(axis=1)
    corners, of_ring = corners[~repeated], of_ring[~repeated]
    x, y = corners.T.tolist()
    points = list(zip(x, y))
    holes: list[list[Ring]] = [[] for _ in polygons]
    end = 0
    for owner, count in zip(owners.tolist(), np.bincount(of_ring, minlength=len(rings)).tolist()):
        holes[owner].append(points[end : end + count - 1])
        end += count
    return holes


def _check_shapes(shapes: Sequence[Any], path: Path, *, lines: bool) -> None:
    """Refuse invalid shapes, and polygons that cross themselves."""
    shapely: Any = require("shapely", "terrain", "reading polygons")
    kinds_of = shapely.GeometryType
    allowed = [kinds_of.POLYGON, kinds_of.MULTIPOLYGON]
    if lines:
        allowed += [kinds_of.LINESTRING, kinds_of.MULTILINESTRING]
    kinds, valid = shapely.get_type_id(shapes), shapely.is_valid(shapes)
    for number, (kind, is_valid) in enumerate(zip(kinds, valid), 1):
        where = f"{path}, feature {number}"
        if kind not in allowed:
            raise InputError(f"{where}: not a {'line or a polygon' if lines else 'polygon'}")
        if not is_valid:
            reason = shapely.is_valid_reason(shapes[number - 1])
            raise InputError(f"{where}: no valid outline: {reason}; draw it without crossings")
