"""Synthetic snow: spheres that touch, joined by sintered necks.

Spheres are added one after another at random. Each overlaps an earlier sphere, so that both meet
in a disc of the neck's radius, and comes no nearer to any other one. The ice is therefore
connected, and its grains are known.
"""

from __future__ import annotations

from typing import Optional

import numpy as np

from snowshed._core import InputError
from snowshed.analysis.tomography.ice_image import IceImage
from snowshed.analysis.tomography.request import asked_fraction, check_shape
from snowshed.base.arguments import checked
from snowshed.base.arrays import Booleans, Floats, Labels, SingleFloats, finite, positive

#: Spheres in a row that do not fit, after which the pack is full.
MAX_FAILURES = 20_000
MAX_SPREAD = 0.5
MAX_SPHERES = 1_000_000


@checked
def sphere_snow(
    shape: tuple[int, int, int],
    voxel_size: float,
    *,
    diameter: float,
    ice_fraction: Optional[float] = None,
    density: Optional[float] = None,
    neck_ratio: float = 0.4,
    spread: float = 0.0,
    seed: int = 0,
) -> IceImage:
    """Return synthetic snow: spheres, joined by sintered necks, with their labels.

    Parameters
    ----------
    shape, voxel_size, ice_fraction, density, seed
        As for `snowshed.analysis.tomography.gaussian_field.gaussian_snow`. No sphere is added after
        the ice fraction is reached. Fractions up to some 0.35 are possible, and more with wider
        necks.
    diameter
        Mean diameter of the spheres, m.
    neck_ratio
        Radius of a neck over that of the smaller of its spheres. 0.1 <= ratio <= 0.9.
    spread
        Half-width of the uniform distribution of diameters over its mean. 0 <= spread <= 0.5.

    Raises
    ------
    InputError
        If a value is out of range, or the spheres cannot be packed as densely as asked.

    Examples
    --------
    >>> snow = sphere_snow((40, 40, 40), 5e-5, diameter=5e-4, density=200, seed=1)
    >>> int(snow.labels.max()) > 10, bool((snow.ice == (snow.labels > 0)).all())
    (True, True)
    """
    check_shape(shape)
    size = positive("voxel size", voxel_size)
    fraction = asked_fraction(ice_fraction, density)
    radius = positive("diameter", diameter) / size / 2
    if not 2 <= radius <= max(shape) / 2:
        raise InputError(
            f"diameter {diameter:g} m: {2 * radius:.3g} voxels; 4 voxels to the length of the "
            "sample are allowed"
        )
    ratio, width = finite("neck_ratio", neck_ratio), finite("spread", spread)
    if not 0.1 <= ratio <= 0.9:
        raise InputError(f"neck_ratio {ratio:g}: 0.1 to 0.9 are allowed")
    if not 0 <= width <= MAX_SPREAD:
        raise InputError(f"spread {width:g}: 0 to {MAX_SPREAD} are allowed")
    pack = _Pack(shape, ratio)
    random = np.random.default_rng(seed)
    target = fraction * np.prod(shape, dtype=np.int64)
    failures = 0
    while pack.voxels < target:
        failures = (
            0 if pack.add(radius * random.uniform(1 - width, 1 + width), random) else failures + 1
        )
        if failures > MAX_FAILURES or pack.count > MAX_SPHERES:
            reached = pack.voxels / np.prod(shape, dtype=np.int64)
            raise InputError(
                f"ice fraction {fraction:.3g}: the spheres fill {reached:.3g}, and no other fits; "
                "ask for less, or for wider necks"
            )
    source = (
        f"synthetic: {pack.count} sintered spheres of diameter {diameter * 1e6:g} um, spread "
        f"{width:g}, neck ratio {ratio:g}, seed {seed}"
    )
    return IceImage(pack.labels > 0, voxel_size, source, synthetic=True, labels=pack.labels)


class _Pack:
    """Spheres in a box, and the voxels that they fill; lengths are in voxels, order is z, y, x."""

    def __init__(self, shape: tuple[int, int, int], neck_ratio: float) -> None:
        self.shape = np.array(shape)
        self.neck_ratio = neck_ratio
        self.labels: Labels = np.zeros(shape, dtype=np.int32)
        #: Squared distance of each voxel from its sphere's centre, less the squared radius.
        self.power: SingleFloats = np.zeros(shape, dtype=np.float32)
        self.centres: Floats = np.empty((64, 3))
        self.radii: Floats = np.empty(64)
        self.count = 0
        self.voxels = 0

    def add(self, radius: float, random: np.random.Generator) -> bool:
        """Add a sphere where it touches another at random; return whether it fits."""
        if not self.count:
            self._place(random.uniform(0.3, 0.7, 3) * self.shape, radius)
            return True
        other = int(random.integers(self.count))
        direction = random.normal(size=3)
        apart = self._distance(radius, self.radii[other])
        centre = self.centres[other] + direction * (apart / np.linalg.norm(direction))
        if (centre < 0).any() or (centre >= self.shape).any():
            return False
        gaps = np.linalg.norm(self.centres[: self.count] - centre, axis=1) - self._distance(
            radius, self.radii[: self.count]
        )
        gaps[other] = 0.0
        if gaps.min() < 0:
            return False
        self._place(centre, radius)
        return True

    def _distance(self, radius: float, others: Floats) -> Floats:
        """Return the distance of the centres of spheres that meet in a disc of the neck."""
        neck = self.neck_ratio * np.minimum(radius, others)
        return np.asarray(np.sqrt(radius**2 - neck**2) + np.sqrt(others**2 - neck**2))

    def _place(self, centre: Floats, radius: float) -> None:
        if self.count == len(self.radii):
            self.centres = np.concatenate([self.centres, np.empty_like(self.centres)])
            self.radii = np.concatenate([self.radii, np.empty_like(self.radii)])
        self.centres[self.count], self.radii[self.count] = centre, radius
        self.count += 1
        low = np.maximum(np.floor(centre - radius).astype(int), 0)
        high = np.minimum(np.ceil(centre + radius).astype(int) + 1, self.shape)
        box = tuple(slice(*ends) for ends in zip(low, high))
        axes = [np.arange(*ends) + 0.5 - at for ends, at in zip(zip(low, high), centre)]
        z, y, x = np.meshgrid(*axes, indexing="ij", sparse=True)
        power = (z**2 + y**2 + x**2 - radius**2).astype(np.float32)
        nearer: Booleans = power < self.power[box]
        self.voxels += int(np.count_nonzero(nearer & (self.labels[box] == 0)))
        self.labels[box][nearer] = self.count
        self.power[box][nearer] = power[nearer]
