"""Sizes of the reproduction: distances between particles, and whether slopes 1 and 2 are solid."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Size:
    """The size of a reproduction.

    Attributes
    ----------
    name
        "quick" or "full".
    wooden_spacing
        Between particles on the wooden slope, m; the paper has 0.01 m.
    wooden_width
        Of the wooden slope, m.
    slope_dimension
        Of slopes 1 and 2. In two dimensions snow does not spread sideways.
    """

    name: str
    wooden_spacing: float
    wooden_width: float
    slope_dimension: int


QUICK = Size("quick", 0.02, 0.24, 2)
FULL = Size("full", 0.01, 0.4, 3)
SIZES: Mapping[str, Size] = {size.name: size for size in (QUICK, FULL)}
