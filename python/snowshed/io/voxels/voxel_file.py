"""A three-dimensional image of known size, whose layers are read on demand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import prod
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.formatting import number
from snowshed.base.limits import (
    MAX_UNPACKED_RATIO,
    MAX_VOXELS_AT_ONCE,
    MB,
    UNCHECKED_UNPACKED_BYTES,
)
from snowshed.base.messages import shortened

MAX_VOXELS = 1 << 32
MAX_AXIS_LENGTH = 1 << 16
#: Allowed kinds of voxels, by NumPy's letters.
KINDS = "buif"


@checked
@dataclass(frozen=True)
class VoxelFile:
    """An image of one number per voxel.

    Attributes
    ----------
    name
        Name of the file or folder in messages.
    shape
        Voxels (nz, ny, nx).
    dtype
        Type of the numbers.
    read_layers
        Function of the first layer and the one after the last; returns numbers (n, ny, nx).
    voxel_size
        Edge of a voxel from the file, m; None: not stated.
    printed_size
        Edge of a pixel from a resolution that may be meant for printers, m, if any. It is only
        compared with the given voxel size.
    notes
        Notes from opening the file.
    """

    name: str
    shape: tuple[int, int, int]
    dtype: np.dtype[Any]
    read_layers: Callable[[int, int], NDArray[Any]]
    voxel_size: Optional[float] = None
    printed_size: Optional[float] = None
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        check_size(self.name, self.shape)
        check_type(self.name, self.dtype)

    @property
    def layers_at_once(self) -> int:
        """Number of layers to read in one block, so that they occupy little memory."""
        _, ny, nx = self.shape
        return max(1, MAX_VOXELS_AT_ONCE // (ny * nx))

    def layers(self, low: int, high: int) -> NDArray[Any]:
        """Return some layers, in the byte order of this machine.

        Raises
        ------
        InputError
            If the file is damaged.
        """
        layers = self.read_layers(low, high)
        if layers.shape != (high - low, *self.shape[1:]):
            raise InputError(f"{self.name}: layers {low} to {high - 1} have shape {layers.shape}")
        return layers.astype(layers.dtype.newbyteorder("="), copy=False)


def check_size(name: str, shape: tuple[int, ...]) -> None:
    """Raise InputError unless a shape is three-dimensional and of a plausible size."""
    if len(shape) != 3:
        raise InputError(f"{name}: {len(shape)} dimensions; an image of snow has 3 (nz, ny, nx)")
    if min(shape) < 1 or max(shape) > MAX_AXIS_LENGTH or prod(shape) > MAX_VOXELS:
        raise InputError(
            f"{name}: {' x '.join(map(str, shape))} voxels; 1 to {MAX_AXIS_LENGTH:,} along an edge "
            f"and {MAX_VOXELS:,} in all are allowed"
        )


def check_type(name: str, dtype: np.dtype[Any]) -> None:
    """Raise InputError unless a type is numeric."""
    if dtype.kind not in KINDS or not 1 <= dtype.itemsize <= 8:
        raise InputError(
            f"{name}: values of type {shortened(str(dtype))}; whole numbers and floating-point "
            "numbers of up to 8 bytes are allowed"
        )


def check_unpacked(name: str, unpacked: int, stored: int) -> None:
    """Raise InputError if a file unpacks to far more bytes than any image of snow.

    Parameters
    ----------
    name
        Name of the file.
    unpacked
        Size of its numbers, bytes.
    stored
        Size on the disk, bytes.

    Examples
    --------
    >>> check_unpacked("a.mha", 1 << 30, 1 << 20)  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    snowshed._core.InputError: a.mha: 1.05 MB unpack to 1,070 MB, more than 200 times as much, ...
    """
    if unpacked > UNCHECKED_UNPACKED_BYTES and unpacked > MAX_UNPACKED_RATIO * stored:
        raise InputError(
            f"{name}: {number(stored / 1e6)} MB unpack to {number(unpacked / 1e6)} MB, more than "
            f"{MAX_UNPACKED_RATIO} times as much, which is implausible for an image of snow; "
            f"crop it, or save it uncompressed "
            f"(up to {UNCHECKED_UNPACKED_BYTES // MB} MB, any compression is read)"
        )
