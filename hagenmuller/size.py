"""Sizes of the reproduction: grains of a sample, and how many samples."""

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
    edge
        Of the samples, in voxels.
    samples
        How many of each snow.
    """

    name: str
    edge: int
    samples: int


#: 2.4 mm and some 90 grains, as the sample that Yade loaded; below a representative volume.
QUICK = Size("quick", 48, 4)
#: 5.6 mm and more than 1000 grains.
FULL = Size("full", 112, 3)
SIZES: Mapping[str, Size] = {size.name: size for size in (QUICK, FULL)}
