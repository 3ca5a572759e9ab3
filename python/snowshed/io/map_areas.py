"""Areas on a map from files of polygons: shapefile, GeoPackage, GeoJSON.

They need the extra snowshed[terrain].
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional

from snowshed._core import InputError
from snowshed.io.coordinate_systems import is_in_degrees
from snowshed.io.extras import require
from snowshed.io.messages import quoted
from snowshed.io.number_text import number_in
from snowshed.io.paths import PathLike

Ring = Sequence[Sequence[float]]

#: Names under which files give the thickness of the snow, m; AvaFrame's first.
THICKNESS = ("thickness", "d0")
LARGEST = 100_000  # polygons of a file


@dataclass(frozen=True)
class MapArea:
    """A polygon on the map.

    Attributes
    ----------
    name
        As the file has it, or "area 1" and so on.
    outline
        Corners (x, y), m, the first not repeated.
    holes
        Rings within it that do not belong to it.
    thickness
        Thickness of the snow, m; None where the file does not say it.
    crs
        Coordinate system of the file in words, such as "EPSG:31287"; empty where it has none.
    file
        Where it was read.
    """

    name: str
    outline: Ring
    holes: tuple[Ring, ...] = ()
    thickness: Optional[float] = None
    crs: str = ""
    file: str = ""


def read_areas(path: PathLike) -> list[MapArea]:
    """Return the polygons of a file; parts of a feature become areas of their own.

    Raises
    ------
    InputError
        If the file holds no polygons, one crosses itself, its coordinates are in degrees, or the
        libraries that read it are missing.
    OSError
        If there is no such file.
    """
    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(2, "No such file or directory", str(path))
    pyogrio: Any = require("pyogrio", "terrain", "reading polygons")
    shapely: Any = require("shapely", "terrain", "reading polygons")
    try:
        meta, _, shapes, columns = pyogrio.raw.read(path, max_features=LARGEST + 1)
        shapes = [shapely.from_wkb(shape) for shape in shapes]
    except (
        pyogrio.errors.DataSourceError,
        pyogrio.errors.DataLayerError,
        shapely.errors.ShapelyError,
        ValueError,
    ) as error:
        raise InputError(f"{path}: not a file of polygons: {error}") from None
    if len(shapes) > LARGEST:
        raise InputError(f"{path}: more than {LARGEST} polygons")
    crs = meta["crs"] or ""
    _check_projected(crs, path, pyogrio)
    records = [dict(zip(meta["fields"], row)) for row in zip(*columns)] or [{}] * len(shapes)
    areas = [
        area
        for number, (shape, record) in enumerate(zip(shapes, records), 1)
        for area in _areas_of(shape, record, number, crs, path, shapely)
    ]
    if not areas:
        raise InputError(f"{path}: holds no polygon")
    return areas


def _check_projected(crs: str, path: Path, pyogrio: Any) -> None:
    if is_in_degrees(crs):
        raise InputError(f"{path}: its coordinates are in degrees ({crs}); project it to metres")


def _areas_of(
    shape: Any, record: dict[str, Any], number: int, crs: str, path: Path, shapely: Any
) -> Iterator[MapArea]:
    where = f"{path}, feature {number}"
    if shape is None or shape.geom_type not in ("Polygon", "MultiPolygon"):
        raise InputError(f"{where}: not a polygon")
    if not shape.is_valid:
        reason = shapely.is_valid_reason(shape)
        raise InputError(f"{where}: no valid outline: {reason}; draw it without crossings")
    named = {str(key).lower(): value for key, value in record.items()}
    name = str(named.get("name") or f"area {number}")
    thickness = _thickness(named, where)
    for part in shapely.get_parts(shape):
        if part.is_empty:
            continue
        holes = tuple(_ring(hole) for hole in part.interiors)
        yield MapArea(name, _ring(part.exterior), holes, thickness, crs, str(path))


def _ring(ring: Any) -> Ring:
    return [(float(x), float(y)) for x, y, *_ in ring.coords[:-1]]


def _thickness(named: dict[str, Any], where: str) -> Optional[float]:
    for key in THICKNESS:
        value = named.get(key)
        if value is None or str(value).strip() in ("", "None", "nan"):
            continue
        number = number_in(str(value))
        if math.isnan(number):
            raise InputError(f"{where}: {key} {quoted(str(value))} is not a number")
        if not number > 0:
            raise InputError(f"{where}: {key} is {number:g} m; give one above 0")
        return number
    return None
