"""Small random samples that resemble snow."""

from __future__ import annotations

import numpy as np
from scipy import ndimage


def random_snow(size: int, grain: float, ice: float = 0.45, seed: int = 1) -> np.ndarray:
    """Return grain labels (size, size, size) of a smoothed random field that is cut into cells.

    Parameters
    ----------
    size
        Voxels along an edge.
    grain
        Approximate width of a grain, voxels.
    ice
        Volume fraction of ice before pieces of fewer than eight voxels are removed.
    """
    random = np.random.default_rng(seed)
    field = ndimage.gaussian_filter(
        random.standard_normal((size,) * 3), 0.35 * grain, mode="nearest"
    )
    solid = field > np.quantile(field, 1 - ice)
    pieces, _ = ndimage.label(solid)
    solid = pieces == np.argmax(np.bincount(pieces.ravel())[1:]) + 1
    seeds = random.uniform(0, size, (round((size / grain) ** 3), 3))
    positions = np.argwhere(np.ones((size,) * 3)) + 0.5
    distance = ((positions[:, None, :] - seeds[None, :, :]) ** 2).sum(axis=2)
    cells = 1 + distance.argmin(axis=1).reshape((size,) * 3)
    labels = np.where(solid, cells, 0)
    small = np.bincount(labels.ravel()) < 8
    return np.where(small[labels], 0, labels).astype(np.int32)
