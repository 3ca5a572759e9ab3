"""The threshold that an image of grey values suggests by itself."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Union

import numpy as np
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.base.callers import argument
from snowshed.base.extras import require
from snowshed.base.formatting import number

BINS = 1024  # of a histogram, except for small whole numbers
MAX_VALUES = 1 << 16  # whole numbers with a bin each
#: Minimum number of different values above 0 in an image of labels.
MIN_LABELS = 8
#: Maximum share of the ice with the same label.
MAX_SHARE_OF_LABEL = 0.5
#: Minimum share of neighbouring ice voxels with equal labels; grey values are rarely equal.
MIN_EQUAL_NEIGHBOURS = 0.75

Parts = Callable[[], Iterable[NDArray[Any]]]


def automatic_threshold(name: str, parts: Parts) -> tuple[float, str]:
    """Return the threshold between ice and air, and its origin: "two values" or "Otsu".

    Parameters
    ----------
    name
        Name of the image in messages.
    parts
        Returns the numbers of the image in parts along z, from the first at each call.

    Raises
    ------
    InputError
        If all values are the same or too far apart, or are labels of grains.

    Examples
    --------
    >>> automatic_threshold("a", lambda: [np.array([[[0, 200], [200, 0]]], dtype=np.uint8)])
    (100.0, 'two values')
    """
    ends = [(part.min().item(), part.max().item()) for part in parts()]
    lowest, highest = min(low for low, _ in ends), max(high for _, high in ends)
    if lowest == highest:
        raise InputError(
            f"{name}: empty: every voxel has the value {number(float(lowest))}; it shows only ice "
            "or only air"
        )
    histogram = _Histogram.between(name, lowest, highest)
    neighbours = _Neighbours()
    only_two_values = True
    for part in parts():
        only_two_values &= bool(((part == lowest) | (part == highest)).all())
        histogram.add(part)
        if not only_two_values and lowest == 0 and part.dtype.kind in "iu":
            neighbours.add(part)
    if only_two_values:
        return 0.5 * lowest + 0.5 * highest, "two values"
    if neighbours.are_same and histogram.has_many_values:
        raise InputError(
            f"{name}: labels of grains, not grey values: there are many numbers, and neighbouring "
            "voxels share them; `snowshed grains compress` takes labels as they are, and "
            f"{argument('threshold', 0.5)} takes all numbers above 0 for ice"
        )
    return histogram.otsu(), "Otsu"


@dataclass
class _Histogram:
    """Counts of values; whole numbers of a small range have a bin each."""

    lowest: Union[int, float]
    width: float  # of a bin
    bins: int
    is_integer: bool
    counts: NDArray[np.int64]

    @classmethod
    def between(
        cls, name: str, lowest: Union[int, float], highest: Union[int, float]
    ) -> _Histogram:
        integers = isinstance(lowest, int) and isinstance(highest, int)
        if integers and highest - lowest < MAX_VALUES:
            bins = int(highest - lowest) + 1
            return cls(lowest, 1.0, bins, True, np.zeros(bins, dtype=np.int64))
        width = (float(highest) - float(lowest)) / BINS
        if not (np.isfinite(width) and float(lowest) + width > float(lowest)):
            raise InputError(
                f"{name}: values from {float(lowest):g} to {float(highest):g} have no histogram; "
                f"scale them, or give {argument('threshold')}"
            )
        return cls(lowest, width, BINS, False, np.zeros(BINS, dtype=np.int64))

    def add(self, part: NDArray[Any]) -> None:
        if self.is_integer:
            # Differences of 8 bytes fit, those of fewer bytes may overflow.
            wide = part if part.dtype.itemsize == 8 else part.astype(np.int64)
            bins = (wide - wide.dtype.type(self.lowest)).astype(np.int64)
        else:
            shifted = part.astype(np.float64) - float(self.lowest)
            bins = np.minimum((shifted / self.width).astype(np.int64), self.bins - 1)
        self.counts += np.bincount(bins.ravel(), minlength=self.bins)

    @property
    def has_many_values(self) -> bool:
        """Whether many values occur above 0, and none of them dominates."""
        above = self.counts[1:] if self.is_integer else self.counts
        distinct_values = int(np.count_nonzero(above))
        is_shared = above.max() < MAX_SHARE_OF_LABEL * above.sum()
        return bool(distinct_values >= MIN_LABELS and is_shared)

    def otsu(self) -> float:
        """Return Otsu's threshold, which is searched in bins, so that values may have any size."""
        filters = require("skimage.filters", "images", "Otsu's threshold")
        bin_index = float(filters.threshold_otsu(hist=(self.counts, np.arange(float(self.bins)))))
        return float(self.lowest) + self.width * (bin_index + (0.0 if self.is_integer else 0.5))


@dataclass
class _Neighbours:
    """Number of neighbouring voxels along y and x that are ice, and have the same value."""

    pairs: int = 0
    same: int = 0

    def add(self, part: NDArray[Any]) -> None:
        for first, other in ((part[:, 1:], part[:, :-1]), (part[:, :, 1:], part[:, :, :-1])):
            ice = (first > 0) & (other > 0)
            self.pairs += int(np.count_nonzero(ice))
            self.same += int(np.count_nonzero(ice & (first == other)))

    @property
    def are_same(self) -> bool:
        """Whether most of the neighbours have the same value."""
        return self.same > MIN_EQUAL_NEIGHBOURS * max(self.pairs, 1)
