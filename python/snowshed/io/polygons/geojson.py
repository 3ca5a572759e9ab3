"""Polygons of a GeoJSON file (RFC 7946, and the coordinate systems of the standard before it).

A link to a coordinate system is never followed.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from snowshed._core import InputError
from snowshed.base.arrays import Floats, Integers
from snowshed.base.extras import require
from snowshed.base.limits import MAX_CORNERS, MAX_GEOJSON_BYTES, MAX_POLYGONS
from snowshed.base.messages import quoted, shortened
from snowshed.io.coordinates.plain_systems import plain_system
from snowshed.io.input_file import read_input
from snowshed.io.polygons.layer import PolygonLayer, is_wanted

GEOMETRIES = (
    *("Point", "MultiPoint", "LineString", "MultiLineString", "Polygon", "MultiPolygon"),
    "GeometryCollection",
)
#: Names of coordinate systems that stand for a code: URNs, and addresses of the standard, which are
#: never opened.
CODES = re.compile(
    r"(?:urn:(?:x-)?ogc:def:crs:|https?://www\.opengis\.net/(?:def/crs/|gml/srs/))"
    r"(EPSG|ESRI|OGC)(?:[:/][\w.]*[:/]|\.xml#)(CRS84|CRS27|CRS83|\d{1,9})",
    re.IGNORECASE,
)
DEGREES = "OGC:CRS84"
NUMBERS = {int, float}
REMEDY = (
    'write it in metres with a member "crs", or as a GeoPackage or shapefile (QGIS: Export, Save '
    "Features As)"
)


def read_geojson(path: Path, *, lines: bool = False) -> PolygonLayer:
    """Return the polygons of a file; see `snowshed.io.polygons.read_layer`."""
    content = _content(path)
    features = _features(content, path)
    if len(features) > MAX_POLYGONS:
        raise InputError(f"{path}: more than {MAX_POLYGONS} polygons")
    outlines = _Outlines(path, lines=lines)
    records = []
    fields: dict[str, None] = {}
    for number, feature in enumerate(features, 1):
        properties = feature.get("properties") or {}
        if not isinstance(properties, dict):
            raise InputError(f"{path}, feature {number}: its properties are not an object")
        fields.update(dict.fromkeys(properties))
        records.append({key: value for key, value in properties.items() if is_wanted(key)})
        outlines.add(feature.get("geometry"), f"{path}, feature {number}")
    corners = outlines.corners()
    farthest = np.abs(corners).max(axis=0, initial=0.0)
    crs = _crs(content, farthest, path)
    return PolygonLayer(outlines.shapes(corners), records, list(fields), crs)


def _content(path: Path) -> dict[str, Any]:
    def refuse(word: str) -> None:
        raise ValueError(f"{word} is not a number")

    try:
        content = json.loads(
            read_input(path, MAX_GEOJSON_BYTES).decode("utf-8-sig"), parse_constant=refuse
        )
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: not GeoJSON: {shortened(str(error), 200)}") from None
    if not isinstance(content, dict):
        raise InputError(f"{path}: not GeoJSON: no object")
    return content


def _features(content: Mapping[str, Any], path: Path) -> list[Mapping[str, Any]]:
    kind = content.get("type")
    if kind == "FeatureCollection":
        features = content.get("features")
        if not isinstance(features, list) or not all(
            isinstance(feature, dict) for feature in features
        ):
            raise InputError(f"{path}: not GeoJSON: its features are not a list of objects")
        return features
    if kind == "Feature":
        return [content]
    if kind in GEOMETRIES:
        return [{"geometry": content}]
    why = "it has no type" if kind is None else f"its type is {quoted(str(kind))}"
    if "geometryType" in content or "spatialReference" in content:
        why = "it is Esri JSON; export it as GeoJSON"
    raise InputError(f"{path}: not GeoJSON: {why}")


class _Outlines:
    """Corners of the rings of all polygons, and of all lines, which are made together."""

    def __init__(self, path: Path, *, lines: bool) -> None:
        self.path = path
        self.lines = lines
        self.x: list[float] = []
        self.y: list[float] = []
        self.ring_sizes: list[int] = []  # and sizes of lines
        self.part_rings: list[int] = []  # number of rings of each polygon; 0 of a line
        self.feature_parts: list[int] = []  # parts of each feature; -1 without a geometry

    def add(self, geometry: object, where: str) -> None:
        """Collect the polygon, or polygons, of a feature."""
        if geometry is None:
            self.feature_parts.append(-1)
            return
        kind = geometry.get("type") if isinstance(geometry, dict) else None
        if kind not in GEOMETRIES or not isinstance(geometry, dict):
            raise InputError(f"{where}: not a GeoJSON geometry")
        coordinates = geometry.get("coordinates")
        is_line = kind in ("LineString", "MultiLineString")
        if kind not in ("Polygon", "MultiPolygon") and not (is_line and self.lines):
            raise InputError(
                f"{where}: not a {'line or a polygon' if self.lines else 'polygon'} but a {kind}"
            )
        parts = [coordinates] if kind in ("Polygon", "LineString") else coordinates
        if not isinstance(parts, list):
            raise InputError(f"{where}: its coordinates are not a list")
        parts = [part for part in parts if part != []]
        for part in parts:
            if not isinstance(part, list):
                raise InputError(f"{where}: its coordinates are not a list of rings")
            for ring in [part] if is_line else part:
                self._add_ring(ring, where, least=2 if is_line else 3)
            self.part_rings.append(0 if is_line else len(part))
        self.feature_parts.append(len(parts))

    def _add_ring(self, ring: object, where: str, least: int) -> None:
        if not isinstance(ring, list) or len(ring) < least or set(map(type, ring)) != {list}:
            noun, count = ("ring", "three") if least == 3 else ("line", "two")
            raise InputError(f"{where}: a {noun} is not a list of at least {count} corners")
        if len(self.x) + len(ring) > MAX_CORNERS:
            raise InputError(f"{self.path}: more than {MAX_CORNERS} corners; simplify the outlines")
        if min(map(len, ring)) < 2 or not set(map(type, chain.from_iterable(ring))) <= NUMBERS:
            raise InputError(f"{where}: a corner is not a list of at least two numbers")
        self.x += [corner[0] for corner in ring]
        self.y += [corner[1] for corner in ring]
        self.ring_sizes.append(len(ring))

    def corners(self) -> Floats:
        """Return the corners of all rings."""
        try:
            corners = np.array([self.x, self.y], dtype=np.float64).T
        except OverflowError:
            corners = np.full((1, 2), np.inf)
        if not np.isfinite(corners).all():
            raise InputError(f"{self.path}: a corner that is not finite")
        return corners

    def shapes(self, corners: Floats) -> list[Any]:
        """Return the geometry of every feature; None for a feature without one."""
        shapely: Any = require("shapely", "terrain", "reading polygons")
        owners = _numbers([max(rings, 1) for rings in self.part_rings])  # of rings and lines
        is_line = np.array(self.part_rings, dtype=int) == 0
        path_of = _numbers(self.ring_sizes)
        along = is_line[owners][path_of]
        parts = np.empty(len(self.part_rings), dtype=object)
        try:
            parts[is_line] = shapely.linestrings(corners[along], indices=_ranks(path_of[along]))
            rings = shapely.linearrings(corners[~along], indices=_ranks(path_of[~along]))
            parts[~is_line] = shapely.polygons(rings, indices=_ranks(owners[~is_line[owners]]))
        except (ValueError, shapely.errors.ShapelyError) as error:
            raise InputError(f"{self.path}: not a polygon: {error}") from None
        groups, first = [], 0
        for count in self.feature_parts:
            own = parts[first : first + max(count, 0)].tolist()
            first += max(count, 0)
            groups.append(None if count < 0 else own[0] if count == 1 else _collected(own))
        return groups


def _collected(parts: Sequence[Any]) -> Any:
    """Return several lines, or several polygons or none, as one geometry."""
    shapely: Any = require("shapely", "terrain", "reading polygons")
    if parts and parts[0].geom_type == "LineString":
        return shapely.MultiLineString(parts)
    return shapely.MultiPolygon(parts)


def _ranks(numbers: Integers) -> Integers:
    """Return ascending numbers with repeats, without gaps: 3, 3, 7 become 0, 0, 1."""
    ranks: Integers = np.unique(numbers, return_inverse=True)[1]
    return ranks


def _numbers(counts: Sequence[int]) -> Integers:
    """Return for each part the index of its whole; `counts` are the parts of each whole."""
    numbers: Integers = np.repeat(np.arange(len(counts)), counts)
    return numbers


def _crs(content: Mapping[str, Any], farthest: Floats, path: Path) -> str:
    if "crs" not in content:
        if farthest[0] > 180 or farthest[1] > 90:
            raise InputError(
                f"{path}: has no coordinate system; its numbers are not degrees, the unit of "
                f"GeoJSON without one; {REMEDY}"
            )
        return DEGREES
    system = content["crs"]
    if system is None:  # explicitly no system
        return ""
    kind = system.get("type") if isinstance(system, dict) else None
    properties = system.get("properties") if isinstance(system, dict) else None
    if not isinstance(properties, dict):
        raise InputError(f"{path}: crs: not as GeoJSON has it; {REMEDY}")
    if kind == "link":
        raise InputError(f"{path}: crs: a link, which is not followed; {REMEDY}")
    name = properties.get("name" if kind == "name" else "code")
    description = f"EPSG:{name}" if kind == "EPSG" else str(name)
    code = CODES.fullmatch(description)
    plain = plain_system(f"{code[1]}:{code[2]}" if code else description)
    if not plain:
        raise InputError(f"{path}: crs: {quoted(description)} is not a code such as EPSG:31287")
    return plain
