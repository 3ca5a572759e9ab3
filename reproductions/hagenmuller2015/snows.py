"""The synthetic snow that replaces the paper's tomography images, which are not available to us.

A Gaussian random field of 500 um wavelength on voxels of 50 um at 318 kg/m3, downscaled twice,
makes some 90 grains of about 4200 spheres in 2.4 mm.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Optional

from snowshed._core import InputError
from snowshed.analysis.grains.samples import LabelledSample
from snowshed.analysis.tomography.gaussian_field import gaussian_snow
from snowshed.analysis.tomography.ice_image import IceImage
from snowshed.analysis.tomography.segmentation import SegmentationSettings, segment
from snowshed.analysis.tomography.sphere_packing import sphere_snow

VOXEL, WAVELENGTH = 5e-5, 5e-4  # m
VOXELS_PER_SPHERE = 2  # voxels along the edge of a sphere
DENSITY, LIGHT_DENSITY, HEAVY_DENSITY = 318.0, 192.0, 427.0  # kg/m3
# Sphere packs of equal density.
PACK_DENSITY = 250.0  # kg/m3
PACK_DIAMETER = 4.5e-4  # m, of the spheres
THIN_NECK_RATIO, WIDE_NECK_RATIO = 0.3, 0.6  # radius of the necks over that of the spheres
MAX_FIELDS = 20  # fields that are tried for one sample
#: Smallest depth of a neck. This depth gives fewer grains than the default (0.75 voxels).
DEEP_NECKS = SegmentationSettings(depth=1.25)


@dataclass(frozen=True)
class Samples:
    """The samples of each snow.

    Attributes
    ----------
    edge
        Length of an edge, voxels.
    count
        Number of samples.
    """

    edge: int
    count: int


#: 2.4 mm and some 90 grains, like the sample that Yade loaded; less than a representative volume.
QUICK = Samples(48, 4)
#: 5.6 mm and more than 1000 grains.
FULL = Samples(112, 3)


def field_snow(
    edge: int, seed: int, density: float, settings: Optional[SegmentationSettings] = None
) -> LabelledSample:
    """Return a cut Gaussian random field with its grains.

    A field with too little connected ice at this density is replaced by the next one.
    """
    image = _field(edge, seed, density)
    name = f"field-{density:.0f}-{seed}" + ("" if settings is None else "-fewer-grains")
    return LabelledSample(name, segment(image, settings).labels, VOXEL)


def _field(edge: int, seed: int, density: float) -> IceImage:
    for another in range(MAX_FIELDS):
        try:
            return gaussian_snow(
                (edge, edge, edge), VOXEL, density=density, correlation_length=WAVELENGTH,
                seed=seed + 1000 * another,
            )  # fmt: skip
        except InputError:
            if another == MAX_FIELDS - 1:
                raise
    raise AssertionError("unreachable")


def pack_snow(edge: int, seed: int, neck_ratio: float) -> LabelledSample:
    """Return spheres that are joined by necks; each sphere is a grain."""
    image = sphere_snow(
        (edge, edge, edge), VOXEL, diameter=PACK_DIAMETER, density=PACK_DENSITY,
        neck_ratio=neck_ratio, seed=seed,
    )  # fmt: skip
    assert image.labels is not None
    return LabelledSample(f"pack-{neck_ratio:g}-{seed}", image.labels, VOXEL)
