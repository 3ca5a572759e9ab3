"""The loading tests from which a snow is fitted, and their curves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from snowshed.analysis.grains.samples import LabelledSample
from snowshed.analysis.grains.variants import Comparison, Variant
from snowshed.methods.grains.curve import LoadingCurve
from snowshed.methods.grains.settings import GrainsSettings
from snowshed.scene.builders.grains import grains_scene
from snowshed.scene.loading import LoadingStage
from snowshed.study.store import Store

CONFINED, ISOTROPIC, COMPACTION, TENSION, SHEAR = (
    "confined", "isotropic", "compaction", "tension", "shear"
)  # fmt: skip
BONDED_PLATES: Mapping[str, Any] = {"numerics.bonded_plates": True}
#: Settings of each test. Tests of strength are slow; otherwise the plate's impact on soft snow
#: would be as large as the strength. The snow is frozen to the plates; otherwise only the few
#: spheres that touch them would yield.
SLOW_LOADING: Mapping[str, Any] = {
    "loading.0.speed": 1e-3,
    "loading.0.strain": 0.01,
    **BONDED_PLATES,
}
LOADINGS: Mapping[str, Mapping[str, Any]] = {
    CONFINED: {"loading.0.kind": "compress", **SLOW_LOADING},
    ISOTROPIC: {"loading.0.kind": "isotropic", **SLOW_LOADING},
    COMPACTION: {"loading.0.kind": "isotropic", **BONDED_PLATES},
    TENSION: {"loading.0.kind": "stretch", **SLOW_LOADING},
}
SHEAR_SETTINGS: Mapping[str, Any] = {
    "loading.0.kind": "shear", "loading.0.speed": 2e-3, "loading.0.strain": 0.02,
    "numerics.sides": "periodic", **BONDED_PLATES,
}  # fmt: skip
#: Normal stresses of the shear tests, as shares of p0.
NORMAL_STRESSES = (0.1, 0.3)
COMPACTION_SPEED = 0.02  # speed of the plates in compaction, m/s
#: Volume fraction of ice up to which snow is compacted: loose grains carry almost no stress below
#: it.
COMPACTED_FRACTION = 0.51
MIN_COMPACTION = 0.12  # smallest strain of the compaction along each axis

Curves = Mapping[tuple[str, int], LoadingCurve]


class MaterialTests:
    """The tests of samples of one snow.

    Parameters
    ----------
    samples
        Samples of about the same density and of one voxel size.
    folder
        Folder for the samples' files.
    settings
        Settings of the method.
    """

    def __init__(
        self, samples: Sequence[LabelledSample], folder: Path, settings: GrainsSettings
    ) -> None:
        self.samples = list(samples)
        self.files = [sample.write(folder) for sample in samples]
        self.voxel_size = samples[0].voxel_size
        density = settings.density or 917.0
        self.ice_fraction = sum(sample.ice_fraction for sample in samples) / len(samples)
        self.density = density * self.ice_fraction
        self.scene = grains_scene(
            self.files[0],
            self.voxel_size,
            [LoadingStage(speed=COMPACTION_SPEED)],
            settings=settings,
        )

    @property
    def min_grains(self) -> int:
        """Number of grains of the smallest sample."""
        return min(sample.grains for sample in self.samples)

    def without_shear(self) -> Comparison:
        """Return the tests that do not depend on the results of others."""
        tests = {name: dict(loading) for name, loading in LOADINGS.items()}
        tests[COMPACTION]["loading.0.strain"] = compaction_strain(self.ice_fraction)
        return self._comparison("", tests)

    def shear(self, pressure: float) -> Comparison:
        """Return the shear tests, with shares of a pressure (Pa) as normal stresses."""
        stresses = {
            f"{SHEAR} under {part:g} p0": {
                **SHEAR_SETTINGS,
                "loading.0.stress": float(f"{part * pressure:.2g}"),
            }
            for part in NORMAL_STRESSES
        }
        return self._comparison("-shear", stresses)

    def _comparison(self, ending: str, tests: Mapping[str, Mapping[str, Any]]) -> Comparison:
        variants = [
            Variant(name, name.partition(" ")[0], self.files, self.voxel_size, changes)
            for name, changes in tests.items()
        ]
        return Comparison(self.scene, variants, f"material-{self.density:.0f}{ending}")


def compaction_strain(ice_fraction: float) -> float:
    """Return the strain along each axis that compacts snow of an ice fraction.

    Examples
    --------
    >>> compaction_strain(0.35), compaction_strain(0.23)
    (0.12, 0.233)
    """
    strain = 1 - (ice_fraction / COMPACTED_FRACTION) ** (1 / 3)
    return max(round(float(strain), 3), MIN_COMPACTION)


def read_curves(comparison: Comparison, runs: Path) -> Curves:
    """Return the curves of the computed tests, by their names and the samples' numbers.

    Parameters
    ----------
    comparison
        The tests; they were computed with their particles kept.
    runs
        Folder of the store.
    """
    hashes = comparison.hashes()
    with Store.open(runs) as store:
        particles = {key: store.particles(hash_) for key, hash_ in hashes.items()}
    return {
        key: LoadingCurve.parse(stored[1].decode("utf-8"), f"{runs}: {key[0]}")
        for key, stored in particles.items()
        if 1 in stored
    }
