"""The loading tests of the reproduction: a stage for each group of the paper's claims."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from reproductions.hagenmuller2015.snows import (
    DEEP_NECKS,
    DENSITY,
    HEAVY_DENSITY,
    LIGHT_DENSITY,
    THIN_NECK_RATIO,
    VOXELS_PER_SPHERE,
    WIDE_NECK_RATIO,
    Samples,
    field_snow,
    pack_snow,
)
from snowshed.analysis.grains.samples import LabelledSample
from snowshed.analysis.grains.variants import (
    BASE,
    Comparison,
    Variant,
    sensitivity_variants,
)
from snowshed.methods.grains.settings import GrainsSettings
from snowshed.scene.builders.grains import grains_scene
from snowshed.scene.loading import LoadingStage
from snowshed.scene.scene import Scene

#: 20 mm/s up to 30 %, with ice ten times as dense: the largest inertia that did not change
#: stresses.
STAGE = LoadingStage(kind="compress", speed=0.02, strain=0.3)
#: Claims about the brittle phase alone need only a sixth of this strain.
BRITTLE_STAGE = LoadingStage(kind="compress", speed=0.02, strain=0.05)
#: Steps are three times the default: peaks of four samples stayed within 5 %, and energies balanced
#: within 2e-4 of the work.
SETTINGS = GrainsSettings(density_scaling=10.0, courant_factor=0.9)
#: Strain within the elastic phase, for loading and unloading.
ELASTIC_STRAIN = 1e-4
#: Speed of this loading, m/s; slow, so that waves are small.
ELASTIC_SPEED = 5e-4
#: Density scaling with far too much inertia.
EXCESSIVE_SCALING = 1e4
LIGHT_SNOW, HEAVY_SNOW = f"{LIGHT_DENSITY:.0f} kg/m3", f"{HEAVY_DENSITY:.0f} kg/m3"
THIN_NECKS, WIDE_NECKS = "thin necks", "wide necks"
FEWER_GRAINS, EXCESSIVE_INERTIA, ELASTIC = "fewer grains", "density of ice x 10000", "elastic"
#: Settings of the variants that are compressed by 30 %, by their names in `sensitivity_variants`.
SOFT_ICE, STRONG_BONDS, HIGH_FRICTION = (
    "elastic modulus 1e+08 Pa",
    "strength of bonds 2e+06 Pa",
    "friction 0.5",
)
DENSE_SETTINGS: Mapping[str, tuple[str, Mapping[str, float]]] = {
    SOFT_ICE: ("elastic modulus", {"elastic_modulus": 1e8}),
    STRONG_BONDS: ("strength of bonds", {"tensile_strength": 2e6, "shear_strength": 2e6}),
    HIGH_FRICTION: ("friction", {"friction": 0.5}),
}

Snow = Callable[[int], LabelledSample]


class Comparisons:
    """The comparisons of a reproduction. They are made on request, because samples take time.

    Parameters
    ----------
    samples
        Size and number of the samples of each snow.
    folder
        Folder of the samples' files.
    """

    def __init__(self, samples: Samples, folder: Path) -> None:
        self.edge = samples.edge
        self._count = samples.count
        self.folder = folder
        self._comparisons: dict[str, Comparison] = {}

    def __getitem__(self, stage: str) -> Comparison:
        if stage not in self._comparisons:
            self._comparisons[stage] = MAKERS[stage](self)
        return self._comparisons[stage]

    def base_snow(self) -> list[LabelledSample]:
        """Return the samples of the base before they are made coarser."""
        return self.samples(lambda seed: field_snow(self.edge, seed, DENSITY))

    def samples(self, snow: Snow) -> list[LabelledSample]:
        """Return the samples of a snow."""
        return [snow(seed) for seed in range(1, self._count + 1)]

    def variant(self, name: str, varied: str, snow: Snow) -> Variant:
        """Return a variant with another snow."""
        coarse = [sample.coarser(VOXELS_PER_SPHERE) for sample in self.samples(snow)]
        files = [sample.write(self.folder) for sample in coarse]
        return Variant(name, varied, files, coarse[0].voxel_size)


def dense_tests(comparisons: Comparisons) -> Comparison:
    """Return the tests up to a strain of 30 %: other settings, densities and necks."""
    edge = comparisons.edge
    base = comparisons.variant(BASE, BASE, lambda seed: field_snow(edge, seed, DENSITY))
    settings = [
        Variant(
            name,
            varied,
            base.samples,
            base.voxel_size,
            {f"numerics.{key}": value for key, value in changes.items()},
        )
        for name, (varied, changes) in DENSE_SETTINGS.items()
    ]
    snows = [
        comparisons.variant(
            LIGHT_SNOW, "density", lambda seed: field_snow(edge, seed, LIGHT_DENSITY)
        ),
        comparisons.variant(
            HEAVY_SNOW, "density", lambda seed: field_snow(edge, seed, HEAVY_DENSITY)
        ),
        comparisons.variant(
            THIN_NECKS, "necks", lambda seed: pack_snow(edge, seed, THIN_NECK_RATIO)
        ),
        comparisons.variant(
            WIDE_NECKS, "necks", lambda seed: pack_snow(edge, seed, WIDE_NECK_RATIO)
        ),
    ]
    return Comparison(_scene(base, [STAGE]), [base, *settings, *snows], "hagenmuller-dense")


def brittle_tests(comparisons: Comparisons) -> Comparison:
    """Return the tests of the brittle phase.

    They are the variants of `snowshed grains sensitivity`, a variant with fewer grains, and one
    with far too much inertia. One variant has spheres half as large, and takes ten times as long.
    """
    comparison = sensitivity_variants(
        comparisons.base_snow(),
        comparisons.folder,
        BRITTLE_STAGE,
        SETTINGS,
        coarser=VOXELS_PER_SPHERE,
        finer=True,
    )
    edge, base = comparisons.edge, comparison.variants[0]
    fewer = comparisons.variant(
        FEWER_GRAINS, "segmentation", lambda seed: field_snow(edge, seed, DENSITY, DEEP_NECKS)
    )
    scaling = {"numerics.density_scaling": EXCESSIVE_SCALING}
    inertia = Variant(EXCESSIVE_INERTIA, "density of ice", base.samples, base.voxel_size, scaling)
    return Comparison(
        comparison.scene, [*comparison.variants, fewer, inertia], "hagenmuller-brittle"
    )


def elastic_tests(comparisons: Comparisons) -> Comparison:
    """Return the tests that load within the elastic phase, and unload until the plate is free."""
    edge = comparisons.edge
    base = comparisons.variant(ELASTIC, ELASTIC, lambda seed: field_snow(edge, seed, DENSITY))
    load = LoadingStage(kind="compress", speed=ELASTIC_SPEED, strain=ELASTIC_STRAIN)
    unload = LoadingStage(kind="unload", speed=ELASTIC_SPEED, strain=2 * ELASTIC_STRAIN)
    return Comparison(_scene(base, [load, unload]), [base], "hagenmuller-elastic")


def _scene(base: Variant, stages: Sequence[LoadingStage]) -> Scene:
    return grains_scene(base.samples[0], base.voxel_size, stages, settings=SETTINGS)


MAKERS: Mapping[str, Callable[[Comparisons], Comparison]] = {
    "elastic": elastic_tests,
    "brittle": brittle_tests,
    "dense": dense_tests,
}
