"""Segmented images for tests of grains."""

import numpy as np

VOXEL = 1e-4  # m


def column_of_grains(count=3, side=4):
    """Return labels of square grains of equal height, stacked along z, (nz, ny, nx)."""
    labels = np.repeat(np.arange(1, count + 1, dtype=np.int32), side)
    return np.broadcast_to(labels[:, None, None], (count * side, side, side)).copy()


def write_labels(folder, labels=None):
    """Write labels, those of `column_of_grains` by default, and return their file."""
    file = folder / "labels.npy"
    np.save(file, column_of_grains() if labels is None else labels)
    return file
