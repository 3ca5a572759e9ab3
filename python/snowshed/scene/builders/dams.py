"""Dams of a slide from files of lines."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.base.extras import require
from snowshed.base.formatting import number_in
from snowshed.base.messages import quoted
from snowshed.io.raster.areas import names_of, read_map_layer
from snowshed.io.raster.raster import Raster
from snowshed.scene.terrain_components import Dam, DamCorner

#: Beginnings of the names of fields; a shapefile cuts names after ten letters.
FIELDS = ("height", "slope", "restit")


def read_dams(file: Path, terrain: Raster) -> tuple[list[Dam], str]:
    """Return the dams of a file of lines, and its coordinate system.

    A field "height" is the height of the crown above the ground, m. Without it, the lines of a
    shapefile need z: the elevation of the crown. The fields "slope" (degrees) and "restitution" are
    optional.

    Raises
    ------
    InputError
        If the file is damaged, holds no line, a height is missing or not above the ground, or a
        line leaves the terrain.
    OSError
        If it cannot be read.
    """
    shapely: Any = require("shapely", "terrain", "reading dams")
    layer = read_map_layer(file, lines=True)
    dams = []
    for name, shape, record in zip(names_of(layer, "dam"), layer.shapes, layer.records):
        where = f"{file}, {name}"
        if shape is None or shape.geom_type not in ("LineString", "MultiLineString"):
            raise InputError(f"{where}: not a line")
        values = {key: _number(record, key, where) for key in FIELDS}
        for line in shapely.get_parts(shape):
            corners = _corners(line, values["height"], terrain, where)
            dams.append(
                Dam(
                    name=name,
                    corners=corners,
                    slope=values["slope"],
                    restitution=values["restit"],
                )
            )
    if not dams:
        raise InputError(f"{file}: holds no line")
    return dams, layer.crs


def _number(record: Mapping[str, Any], key: str, where: str) -> Optional[float]:
    """Return the value of the field whose name begins with a key; None without a value."""
    for name, value in record.items():
        if name.strip().lower().startswith(key):
            if value is None or str(value).strip().lower() in ("", "none", "nan"):
                return None
            number = float(value) if isinstance(value, (int, float)) else number_in(str(value))
            if not math.isfinite(number):
                raise InputError(f"{where}: {name} {quoted(str(value))} is not a number")
            return number
    return None


def _corners(line: Any, height: Optional[float], terrain: Raster, where: str) -> list[DamCorner]:
    shapely: Any = require("shapely", "terrain", "reading dams")
    points = shapely.get_coordinates(line, include_z=True)
    points = points[np.r_[True, np.any(np.diff(points[:, :2], axis=0) != 0.0, axis=1)]]
    east, north, crown = points.T
    ground = terrain.height_at(east, north)
    if np.isnan(ground).any():
        raise InputError(f"{where}: reaches beyond the terrain or into a hole of it")
    if height is not None:
        heights = np.full(len(points), height)
    elif np.isnan(crown).any():
        raise InputError(
            f'{where}: has neither a field "height" nor elevations of the crown (z, which '
            "only shapefiles give)"
        )
    else:
        heights = crown - ground
    if not (heights > 0.0).all():
        raise InputError(
            f"{where}: {heights.min():.3g} m high; its crown must be above the ground everywhere"
        )
    return [
        DamCorner(x=float(x), y=float(y), height=float(h)) for x, y, h in zip(east, north, heights)
    ]
