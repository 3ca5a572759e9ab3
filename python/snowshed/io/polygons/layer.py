"""The polygons of a file, in one form for all formats."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

#: Fields are read if their names begin with these words.
FIELD_PREFIXES = ("name", "thick", "d0", "height", "slope", "restit")


@dataclass(frozen=True)
class PolygonLayer:
    """Features of a layer.

    Attributes
    ----------
    shapes
        One shapely geometry per feature; None if the feature has none.
    records
        Values of the requested fields, by field; one for each feature.
    fields
        Names of all fields of the file.
    crs
        Coordinate system as text; empty if the file has none.
    """

    shapes: Sequence[Any]
    records: Sequence[Mapping[str, Any]]
    fields: Sequence[str]
    crs: str


def is_wanted(field: str) -> bool:
    """Return whether a field is read.

    Examples
    --------
    >>> is_wanted("Thickness_cm"), is_wanted("photo")
    (True, False)
    """
    return field.strip().lower().startswith(FIELD_PREFIXES)
