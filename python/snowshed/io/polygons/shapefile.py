"""Polygons of an ESRI Shapefile, read by GDAL after its head, index and companions were checked."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from snowshed._core import InputError
from snowshed.base.extras import require
from snowshed.base.limits import MAX_CORNERS, MAX_POLYGONS, MAX_RINGS
from snowshed.base.messages import shortened
from snowshed.base.notes import InputNote, issue_note
from snowshed.io.coordinates.gdal_fence import fenced_pyogrio
from snowshed.io.coordinates.systems import read_system
from snowshed.io.polygons.layer import PolygonLayer, is_wanted

#: The number of the format, and five unused numbers.
SHAPEFILE = b"\x00\x00\x27\x0a" + bytes(20)
#: Kinds of shapes: plane, with z, with measures.
OF_POLYGONS = (5, 15, 25)
OF_LINES = (3, 13, 23)
KINDS = {1: "points", 3: "lines", 8: "points", 11: "points", 13: "lines", 18: "points"}
HEAD = 100  # bytes of the head of a .shp and of its .shx


def read_shapefile(path: Path, *, lines: bool = False) -> PolygonLayer:
    """Return the polygons of a file; see `snowshed.io.polygons.read_layer`."""
    pyogrio: Any = require("pyogrio", "terrain", "reading shapefiles")
    shapely: Any = require("shapely", "terrain", "reading polygons")
    companions = _companions(path)
    _check_sizes(path, companions, OF_POLYGONS + OF_LINES if lines else OF_POLYGONS)
    if ".prj" in companions:
        read_system(companions[".prj"])
    file = path.absolute()
    with warnings.catch_warnings(record=True) as log:
        warnings.simplefilter("always")
        try:
            with fenced_pyogrio():
                fields = [str(field) for field in pyogrio.read_info(file)["fields"]]
                wanted = [field for field in fields if is_wanted(field)]
                meta, _, shapes, columns = pyogrio.raw.read(
                    file, columns=wanted, max_features=MAX_POLYGONS, force_2d=not lines
                )
            shapes = shapely.from_wkb(shapes)
        except (
            *(pyogrio.errors.DataSourceError, pyogrio.errors.DataLayerError),
            *(pyogrio.errors.CRSError, pyogrio.errors.FeatureError),
            *(pyogrio.errors.GeometryError, shapely.errors.ShapelyError, ValueError),
        ) as error:
            raise InputError(
                f"{path}: not a file of polygons: {shortened(str(error), 300)}"
            ) from None
    for warning in dict.fromkeys(shortened(str(caught.message), 300) for caught in log):
        issue_note(f"{path}: GDAL says: {warning}", InputNote)
    rows = zip(*columns) if columns else [()] * len(shapes)
    names = [str(name) for name in meta["fields"]]
    return PolygonLayer(
        list(shapes), [dict(zip(names, row)) for row in rows], fields, meta["crs"] or ""
    )


def _companions(path: Path) -> dict[str, Path]:
    """Return the files of the same name beside a .shp, by their endings, lower-case."""
    if path.suffix.lower() != ".shp":
        raise InputError(f"{path}: a shapefile's shapes, but its name does not end in .shp")
    files = {
        file.suffix.lower(): file
        for file in sorted(path.parent.glob(f"{_literally(path.stem)}.*"))
        if file.stem == path.stem
    }
    for file in files.values():
        if not file.is_file():
            raise InputError(f"{file}: not a regular file")
    if ".shx" not in files:
        raise InputError(f"{path}: its index {path.stem}.shx is not beside it")
    return files


def _literally(name: str) -> str:
    return "".join(f"[{c}]" if c in "*?[" else c for c in name)


def _check_sizes(path: Path, companions: dict[str, Path], kinds: Sequence[int]) -> None:
    """Refuse files without these kinds of shapes, or with too many, before GDAL reads them."""
    content = np.memmap(path, dtype=np.uint8, mode="r")
    if len(content) < HEAD:
        raise InputError(f"{path}: not a file of polygons: truncated")
    kind = int(content[32:36].view("<i4")[0])
    if int(content[28:32].view("<i4")[0]) != 1000 or kind not in kinds:
        raise InputError(f"{path}: not a file of polygons: {KINDS.get(kind, 'other shapes')}")
    index = companions[".shx"]
    count = (index.stat().st_size - HEAD) // 8
    if count > MAX_POLYGONS:
        raise InputError(f"{path}: more than {MAX_POLYGONS} polygons")
    if count < 1:
        return
    entries = np.fromfile(index, dtype=">i4", count=2 * count, offset=HEAD)
    begins = 2 * entries[::2].astype(np.int64)
    # The number of rings and that of corners stand 44 bytes into a record.
    complete = (begins >= HEAD) & (begins + 52 <= len(content))
    offsets = begins[complete, None] + np.arange(44, 52)
    rings, corners = content[offsets].view("<i4").astype(np.int64).T if len(offsets) else ([0], [0])
    shapes = content[begins[complete, None] + np.arange(8, 12)].view("<i4").ravel()
    wanted = np.isin(shapes, kinds)
    if np.sum(np.asarray(corners)[wanted]) > MAX_CORNERS:
        raise InputError(f"{path}: more than {MAX_CORNERS} corners; simplify the outlines")
    if np.any(np.asarray(rings)[wanted] > MAX_RINGS):
        raise InputError(f"{path}: a polygon of more than {MAX_RINGS} rings; simplify it")
