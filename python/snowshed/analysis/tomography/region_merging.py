"""Merging labels that are one grain: by the depth of the neck between them, and by contiguity."""

from __future__ import annotations

import heapq

import numpy as np

from snowshed.analysis.tomography.adjacency import Adjacency
from snowshed.base.arrays import Floats, Integers


def merge_shallow(touching: Adjacency, peaks: Floats, depth: float) -> Integers:
    """Return new labels, in which shallow maxima of the distance are no grains of their own.

    The depth of a maximum is its height above the saddle towards a higher one, its dynamics. The
    merged basins are those of the maxima of the h-maxima transform (Soille 2004, Morphological
    Image Analysis, chapter 6).

    Parameters
    ----------
    touching
        Basins of all maxima.
    peaks : (n + 1,)
        Largest distance from the air in each basin.
    depth
        Depth up to which a maximum is shallow, in the unit of the distance.

    Returns
    -------
    (n + 1,)
        The new label of each label, from 1.
    """
    root = np.arange(len(peaks))
    height = peaks.copy()
    for edge in np.argsort(-touching.saddles, kind="stable"):
        first, other = (_root(root, label) for label in touching.pairs[edge])
        if first != other and min(height[first], height[other]) - touching.saddles[edge] < depth:
            root[max(first, other)] = min(first, other)
            height[min(first, other)] = max(height[first], height[other])
    return _consecutive(root)


def merge_contiguous(
    touching: Adjacency, voxels: Integers, contiguity: float, smallest: int = 0
) -> Integers:
    """Return new labels, in which labels with a contact above a share of their surface are merged.

    The contiguity of two labels is the ratio of the area of their contact to the smaller of their
    whole surfaces. The most contiguous pair is merged first, and its contiguities are computed
    again. Afterwards, a label of fewer voxels than `smallest` joins the label with the largest
    contact to it.

    Parameters
    ----------
    touching
        The labels.
    voxels : (n + 1,)
        Number of voxels of each region.
    contiguity
        The largest that two grains may have.
    smallest
        Voxels of the smallest grain.

    Returns
    -------
    (n + 1,)
        The new label of each label, from 1.
    """
    graph = _Graph(touching, voxels)
    graph.merge_above(contiguity)
    graph.merge_small(smallest)
    return _consecutive(graph.root)


class _Graph:
    """Labels and their contacts, merged one by one."""

    def __init__(self, touching: Adjacency, voxels: Integers) -> None:
        self.root = np.arange(len(touching.air))
        self.surface = touching.surfaces
        self.voxels = voxels.copy()
        self.areas: list[dict[int, float]] = [{} for _ in self.root]
        for (first, other), area in zip(touching.pairs.tolist(), touching.areas.tolist()):
            self.areas[first][other] = self.areas[other][first] = area

    def merge_above(self, contiguity: float) -> None:
        """Merge pairs of a larger contiguity, the largest first."""
        queue = [
            (-self._contiguity(label, other), label, other)
            for label, touched in enumerate(self.areas)
            for other in touched
            if label < other
        ]
        heapq.heapify(queue)
        while queue and -queue[0][0] > contiguity:
            negative, first, other = heapq.heappop(queue)
            if other not in self.areas[first] or -self._contiguity(first, other) != negative:
                continue  # merged, or changed and queued again
            self._merge(first, other)
            for third in self.areas[first]:
                pair = (first, third) if first < third else (third, first)
                heapq.heappush(queue, (-self._contiguity(*pair), *pair))

    def merge_small(self, smallest: int) -> None:
        """Merge labels of fewer voxels into that of their largest contact, the smallest first."""
        queue = [(int(n), label) for label, n in enumerate(self.voxels) if label and n < smallest]
        heapq.heapify(queue)
        while queue:
            count, label = heapq.heappop(queue)
            if self.root[label] != label or count != self.voxels[label] or not self.areas[label]:
                continue
            other = max(
                self.areas[label], key=lambda neighbour: (self.areas[label][neighbour], -neighbour)
            )
            remaining = min(label, other)
            self._merge(remaining, max(label, other))
            if self.voxels[remaining] < smallest:
                heapq.heappush(queue, (int(self.voxels[remaining]), remaining))

    def _contiguity(self, first: int, other: int) -> float:
        surface = min(self.surface[first], self.surface[other])
        return float(self.areas[first][other] / surface) if surface > 0 else np.inf

    def _merge(self, remaining: int, gone: int) -> None:
        """Merge a label into one with a smaller number."""
        area = self.areas[remaining].pop(gone)
        self.areas[gone].pop(remaining)
        for third, shared in self.areas[gone].items():
            total = self.areas[remaining].get(third, 0.0) + shared
            self.areas[third].pop(gone)
            self.areas[remaining][third] = self.areas[third][remaining] = total
        self.areas[gone] = {}
        self.surface[remaining] += self.surface[gone] - 2 * area
        self.voxels[remaining] += self.voxels[gone]
        self.root[gone] = remaining


def _root(root: Integers, label: int) -> int:
    """Return the label into which a label was merged, and shorten the path to it."""
    while root[label] != label:
        root[label] = root[root[label]]
        label = int(root[label])
    return label


def _consecutive(root: Integers) -> Integers:
    """Return labels from 1 without gaps, in the order of their roots."""
    ends = np.array([_root(root, label) for label in range(len(root))])
    return np.unique(ends, return_inverse=True)[1].astype(np.int64)
