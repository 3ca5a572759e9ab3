"""Files of polygons that this project writes: GeoJSON, GeoPackage, ESRI Shapefile."""

from __future__ import annotations

import json
import shutil
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Optional, Union

import numpy as np

from snowshed._core import InputError
from snowshed.base.extras import require
from snowshed.io.atomic import replacing, write_text
from snowshed.io.coordinates.gdal_fence import fenced_pyogrio
from snowshed.io.coordinates.plain_systems import CODE
from snowshed.io.coordinates.systems import system_of

Column = Sequence[Union[str, float, None]]
#: Rings of a polygon, the outline first; the first corner (x, y) of a ring is not repeated.
Rings = Sequence[Sequence[Sequence[float]]]

GEOJSON = (".geojson", ".json")
DRIVERS = {".gpkg": "GPKG", ".shp": "ESRI Shapefile"}
ALLOWED = ", ".join((*GEOJSON, *DRIVERS))
#: Files of a shapefile that describe it, and of its search indices, which would be out of date.
COMPANIONS = (".prj", ".cpg", ".qix", ".sbn", ".sbx", ".fix", ".idm", ".ind")
#: Longest name of a field in a shapefile.
MAX_FIELD_NAME = 10


def check_ending(path: Path) -> None:
    """Raise InputError if the name of a file shows no format of polygons that can be written."""
    if path.suffix.lower() not in (*GEOJSON, *DRIVERS):
        raise InputError(f"{path}: not the name of a file of polygons; allowed: {ALLOWED}")


def write_polygons(
    path: Path,
    polygons: Sequence[Rings],
    fields: Mapping[str, Column],
    *,
    crs: str,
    description: str = "",
) -> None:
    """Write polygons in the format of the file's name, whole or not at all.

    Parameters
    ----------
    path
        The file: .geojson, .gpkg or .shp.
    polygons
        The polygons.
    fields
        Values of each field, one for each polygon; a field holds texts or numbers. In a shapefile,
        names have at most ten characters.
    crs
        Coordinate system as text; empty if unknown.
    description
        A text on the whole layer; a shapefile has no place for it.

    Raises
    ------
    InputError
        If the format is another, GeoJSON cannot name the coordinate system, or pyogrio or shapely
        is missing.
    OSError
        If the file cannot be written.
    """
    check_ending(path)
    ending = path.suffix.lower()
    if ending in GEOJSON:
        write_text(path, _geojson(path, polygons, fields, crs, description))
    elif ending == ".gpkg":
        with replacing(path) as beside:
            _write_by_gdal(beside, path.stem, polygons, fields, crs, description)
    else:
        _write_shapefile(path, polygons, fields, crs)


def _geojson(
    path: Path,
    polygons: Sequence[Rings],
    fields: Mapping[str, Column],
    crs: str,
    description: str,
) -> str:
    features = [
        {
            "type": "Feature",
            "properties": {name: values[number] for name, values in fields.items()},
            "geometry": {
                "type": "Polygon",
                "coordinates": [[*ring, ring[0]] for ring in rings],
            },
        }
        for number, rings in enumerate(polygons)
    ]
    collection = {
        "type": "FeatureCollection",
        "crs": _named_system(path, crs),
        **({"description": description} if description else {}),
    }
    lines = ",\n".join(json.dumps(feature, allow_nan=False) for feature in features)
    return f'{json.dumps(collection)[:-1]}, "features": [\n{lines}\n]}}\n'


def _named_system(path: Path, crs: str) -> Optional[dict[str, Any]]:
    """Return the member `crs` of GeoJSON, which can only hold a code."""
    if not crs:
        return None
    system = None if CODE.fullmatch(crs) else system_of(crs)
    code = crs if system is None else ":".join(system.to_authority() or ())
    if not CODE.fullmatch(code):
        raise InputError(
            f"{path}: GeoJSON cannot hold a coordinate system without a code; write a .gpkg"
        )
    authority, _, number = code.partition(":")
    return {"type": "name", "properties": {"name": f"urn:ogc:def:crs:{authority}::{number}"}}


def _write_shapefile(
    path: Path, polygons: Sequence[Rings], fields: Mapping[str, Column], crs: str
) -> None:
    """Write the files of a shapefile elsewhere, then put them in place, the shapes last."""
    for name in fields:
        if len(name) > MAX_FIELD_NAME:
            raise InputError(f"{name}: names in a shapefile have at most {MAX_FIELD_NAME} letters")
    with TemporaryDirectory() as folder:
        written = Path(folder) / "layer.shp"
        _write_by_gdal(written, "layer", polygons, fields, crs, "")
        parts = sorted(written.parent.iterdir(), key=lambda part: part.suffix == ".shp")
        for ending in {*COMPANIONS} - {part.suffix for part in parts}:
            path.with_suffix(ending).unlink(missing_ok=True)
        for part in parts:
            with replacing(path.with_suffix(part.suffix)) as beside:
                shutil.copyfile(part, beside)


def _write_by_gdal(
    file: Path,
    layer: str,
    polygons: Sequence[Rings],
    fields: Mapping[str, Column],
    crs: str,
    description: str,
) -> None:
    pyogrio: Any = require("pyogrio", "terrain", "writing polygons")
    shapely: Any = require("shapely", "terrain", "writing polygons")
    shapes = [shapely.Polygon(rings[0], rings[1:]) for rings in polygons]
    system = system_of(crs)
    columns = [
        np.array(["" if value is None else value for value in values], dtype=object)
        if any(isinstance(value, str) for value in values)
        else np.array([np.nan if value is None else value for value in values], dtype=float)
        for values in fields.values()
    ]
    try:
        with fenced_pyogrio(), warnings.catch_warnings():
            warnings.filterwarnings("ignore", "'crs' was not provided", UserWarning)
            pyogrio.raw.write(
                file,
                shapely.to_wkb(np.array(shapes, dtype=object)),
                columns,
                np.array(list(fields), dtype=object),
                layer=layer,
                driver=DRIVERS[file.suffix.lower()],
                geometry_type="Polygon",
                crs=None if system is None else system.to_wkt(),
                **({"layer_metadata": {"DESCRIPTION": description}} if description else {}),
            )
    except (pyogrio.errors.DataSourceError, pyogrio.errors.DataLayerError) as error:
        raise OSError(f"{file}: {error}") from None
