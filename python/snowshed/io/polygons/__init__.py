"""Files of polygons: GeoPackage, ESRI Shapefile, GeoJSON, recognised by their content.

No other format is read. GDAL recognises dozens of formats by their content; in some of them a file
is a request to another machine or names other files. Therefore GeoPackage and GeoJSON are read
without GDAL, and a shapefile reaches GDAL only after its head and index have been checked.
"""

from __future__ import annotations

from pathlib import Path
from typing import Optional

from snowshed._core import InputError
from snowshed.base.messages import quoted
from snowshed.io.polygons.geojson import read_geojson
from snowshed.io.polygons.geopackage import SQLITE, read_geopackage
from snowshed.io.polygons.layer import PolygonLayer
from snowshed.io.polygons.shapefile import SHAPEFILE, read_shapefile

FORMATS = "allowed: GeoPackage, ESRI Shapefile (its .shp), GeoJSON"


def read_layer(
    path: Path, layer: Optional[str], option: str, *, lines: bool = False
) -> PolygonLayer:
    """Return the polygons of a file.

    Parameters
    ----------
    path
        The file.
    layer
        Name of the layer to read; None: the only one.
    option
        Option that names a layer, for the message if there are several.
    lines
        Whether lines are read, too.

    Raises
    ------
    InputError
        If the file is not regular, is of another format or damaged, or has several layers.
    OSError
        If there is no such file, or it cannot be read.
    """
    if not path.exists():
        raise FileNotFoundError(2, "No such file or directory", str(path))
    if not path.is_file():
        raise InputError(f"{path}: not a regular file")
    with path.open("rb") as file:
        begin = file.read(1024)
    if begin.startswith(SQLITE):
        return read_geopackage(path, layer, option, lines=lines)
    if layer is not None and layer != path.stem:
        raise InputError(f"{path}: has one layer, {quoted(path.stem)}; {option} {quoted(layer)}")
    if begin.startswith(SHAPEFILE):
        return read_shapefile(path, lines=lines)
    if begin.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"{"):
        return read_geojson(path, lines=lines)
    raise InputError(f"{path}: not a file of polygons; {FORMATS}")
