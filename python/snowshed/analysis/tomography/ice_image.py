"""A binary image of snow: where its ice is."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Optional

import numpy as np

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.arrays import Booleans, Labels, positive

ICE_DENSITY = 917.0  # kg/m3


@checked
@dataclass(frozen=True)
class IceImage:
    """Ice and air on cubic voxels.

    Attributes
    ----------
    ice : (nz, ny, nx)
        Whether a voxel is ice.
    voxel_size
        Edge of a voxel, m.
    source
        Source of the image: a file, or a description of synthetic snow.
    synthetic
        Whether a generator made it.
    labels : (nz, ny, nx)
        Labels of known grains, as in a sphere pack: 0 air, else a grain.

    Raises
    ------
    InputError
        If the image is not three-dimensional, has no voxels, or the voxel size is not positive.

    Examples
    --------
    >>> ice = np.zeros((4, 4, 4), dtype=bool)
    >>> ice[:2] = True
    >>> IceImage(ice, 5e-5, "a plate").density
    458.5
    """

    ice: Booleans
    voxel_size: float
    source: str
    synthetic: bool = False
    labels: Optional[Labels] = None

    def __post_init__(self) -> None:
        positive("voxel size", self.voxel_size)
        if self.ice.dtype != bool or self.ice.ndim != 3 or not self.ice.size:
            raise InputError(
                f"{self.source}: {self.ice.dtype} of shape {self.ice.shape}; an image of ice is "
                "an array of booleans (nz, ny, nx) that is not empty"
            )

    @property
    def ice_fraction(self) -> float:
        """Voxels of ice over all voxels."""
        return float(np.count_nonzero(self.ice) / self.ice.size)

    @property
    def density(self) -> float:
        """Density of the snow, kg/m3."""
        return ICE_DENSITY * self.ice_fraction

    @property
    def size(self) -> tuple[float, float, float]:
        """Edges along x, y and z, m."""
        nz, ny, nx = self.ice.shape
        return nx * self.voxel_size, ny * self.voxel_size, nz * self.voxel_size

    def with_ice(self, ice: Booleans, **changes: float) -> IceImage:
        """Return the image with other voxels; the grains are then no longer known."""
        return replace(self, ice=ice, labels=None, **changes)  # type: ignore[arg-type]


def check_phases(image: IceImage) -> None:
    """Raise InputError if an image shows only ice or only air."""
    if not image.ice.any():
        raise InputError(f"{image.source}: no ice; is the threshold too high, or ice dark?")
    if image.ice.all():
        raise InputError(f"{image.source}: all is ice; is the threshold too low, or ice dark?")
