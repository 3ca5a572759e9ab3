"""Images whose axes are stored in another order or direction."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from snowshed.io.voxels.voxel_file import VoxelFile


@dataclass(frozen=True)
class Turn:
    """The axes of an image in terms of those of its file, both in the order z, y, x.

    Attributes
    ----------
    axes
        The axis of the file (0, 1, 2) that each axis of the image is.
    mirrored
        Whether each axis of the image runs in the opposite direction.
    """

    axes: tuple[int, int, int] = (0, 1, 2)
    mirrored: tuple[bool, bool, bool] = (False, False, False)

    @property
    def is_none(self) -> bool:
        """Whether the axes of the image are those of its file."""
        return self == Turn()

    def of(self, array: NDArray[Any]) -> NDArray[Any]:
        """Return a view of an array, turned.

        Examples
        --------
        >>> Turn((0, 2, 1), (False, True, False)).of(np.arange(6).reshape(1, 2, 3)).tolist()
        [[[2, 5], [1, 4], [0, 3]]]
        """
        steps = tuple(slice(None, None, -1 if mirrored else 1) for mirrored in self.mirrored)
        return np.transpose(array, self.axes)[steps]


def turned(file: VoxelFile, turn: Turn) -> VoxelFile:
    """Return an image, turned; only some layers of its file are in memory at a time.

    If layers of the image are not layers of the file, each reading passes through the whole file.
    """
    if turn.is_none:
        return file
    nz, ny, nx = (file.shape[axis] for axis in turn.axes)
    same_layers = turn.axes[0] == 0
    read: Callable[[int, int], NDArray[Any]]

    def within(low: int, high: int) -> tuple[int, int]:
        """Return the range of layers in the file for some layers of the image."""
        return (nz - high, nz - low) if turn.mirrored[0] else (low, high)

    def layers(low: int, high: int) -> NDArray[Any]:
        return turn.of(file.layers(*within(low, high)))

    def cuts(low: int, high: int) -> NDArray[Any]:
        first, end = within(low, high)
        cut = [slice(None)] * 3
        cut[turn.axes[0]] = slice(first, end)
        shape = [high - low if axis == turn.axes[0] else file.shape[axis] for axis in range(3)]
        turned = np.empty(shape, dtype=file.dtype.newbyteorder("="))
        for start in range(0, file.shape[0], file.layers_at_once):
            stop = min(start + file.layers_at_once, file.shape[0])
            turned[start:stop] = file.layers(start, stop)[tuple(cut)]
        return turn.of(turned)

    read = layers if same_layers else cuts
    return VoxelFile(file.name, (nz, ny, nx), file.dtype, read, file.voxel_size, file.printed_size)
