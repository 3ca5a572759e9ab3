"""Variants of a loading test; each differs from the base in one parameter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from snowshed._core import InputError
from snowshed.analysis.grains.samples import LabelledSample
from snowshed.base.arguments import checked
from snowshed.methods.grains.settings import GrainsSettings
from snowshed.scene.builders.grains import grains_scene
from snowshed.scene.loading import LoadingStage
from snowshed.scene.scene import Scene
from snowshed.study.definition import Study
from snowshed.study.factors import Factor
from snowshed.study.table import read_table

if TYPE_CHECKING:
    import pandas as pd

BASE = "base"
#: Columns that every variant's rows have besides the figures of the tests.
KEYS = ("variant", "varied", "sample")


@dataclass(frozen=True)
class Variant:
    """A variant of a loading test.

    Attributes
    ----------
    name
        Label: the varied parameter, and its value.
    varied
        Name of the varied parameter, which several variants share.
    samples
        Files of the samples, which correspond to those of the base one by one.
    voxel_size
        Voxel size of the samples, m.
    changes
        Values of the scene that differ from the base, by their dotted paths.
    """

    name: str
    varied: str
    samples: Sequence[Path]
    voxel_size: float
    changes: Mapping[str, Any] = field(default_factory=dict)

    @property
    def part(self) -> list[Factor]:
        """The part of a study that computes the variant."""
        files: dict[str, list[Any]] = {
            "sample.file": [str(file) for file in self.samples],
            "sample.voxel_size": [self.voxel_size] * len(self.samples),
        }
        if not self.changes:
            return [Factor(files)]
        return [Factor(files), Factor({path: [value] for path, value in self.changes.items()})]


@dataclass(frozen=True)
class Comparison:
    """A study of variants.

    Attributes
    ----------
    scene
        Common scene of all variants.
    variants
        The base first.
    name
        Name of the study.
    """

    scene: Scene
    variants: Sequence[Variant]
    name: str

    def study(self) -> Study:
        """Return the study that computes all variants."""
        return Study(self.scene, [variant.part for variant in self.variants], self.name)

    def hashes(self) -> dict[tuple[str, int], str]:
        """Return the hash of each test, by its variant's name and its sample's number."""
        return {
            (variant.name, sample): run.hash
            for variant in self.variants
            for sample, run in enumerate(Study(self.scene, [variant.part], self.name).runs())
        }

    def table(self, runs: Path) -> pd.DataFrame:
        """Return the computed tests, one row per variant and sample.

        A test that two variants share has a row for each. Tests that failed or are missing have
        none.

        Parameters
        ----------
        runs
            The folder of the store.

        Returns
        -------
        pandas.DataFrame
            The columns `KEYS`, ``hash``, and the figures of `GrainsSummary` as studies have them.
        """
        import pandas as pd

        done = read_table(runs, self.name)
        done = done[done["ended"].notna() & (done["ended"] != "failed")].set_index("hash")
        varied = {variant.name: variant.varied for variant in self.variants}
        rows = [
            {**dict(zip(KEYS, (name, varied[name], sample))), "hash": hash_, **done.loc[hash_]}
            for (name, sample), hash_ in self.hashes().items()
            if hash_ in done.index
        ]
        return pd.DataFrame(rows, columns=list(dict.fromkeys([*KEYS, "hash", *done.columns])))


#: Changes of the settings in a sensitivity study: label, paths, and factors.
SETTINGS = (
    ("friction", ("friction",), (0.5, 2.5)),
    ("elastic modulus", ("elastic_modulus",), (0.1, 0.3)),
    ("strength of bonds", ("tensile_strength", "shear_strength"), (0.5, 2.0)),
    ("density of ice", ("density_scaling",), (0.1, 10.0)),
)
SPEEDS = (0.5, 2.0)
SMALLER_EDGE = 0.5  # edges of the smaller volume, relative to the sample's


@checked
def sensitivity_variants(
    samples: Sequence[LabelledSample],
    folder: Path,
    stage: LoadingStage,
    settings: GrainsSettings,
    *,
    coarser: int = 1,
    finer: bool = False,
) -> Comparison:
    """Return the variants of a sensitivity study, and write their samples.

    Parameters
    ----------
    samples
        Samples of one snow and voxel size; each is loaded with every variant.
    folder
        Folder for the samples' files.
    stage
        The test.
    settings
        Settings of the base.
    coarser
        Ratio of voxel sizes of base and samples. The next larger ratio is a variant.
    finer
        Whether the next smaller ratio is a variant, too, which takes far longer: spheres of half
        the size are four times as many, and need twice as many steps.

    Raises
    ------
    InputError
        If a sample is too small.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import numpy as np
    >>> sample = LabelledSample("one", np.ones((24, 24, 24), dtype=int), 1e-4)
    >>> with TemporaryDirectory() as folder:
    ...     found = sensitivity_variants([sample], Path(folder), LoadingStage(), GrainsSettings())
    >>> [one.name for one in found.variants][:4]
    ['base', 'friction 0.1', 'friction 0.5', 'elastic modulus 1e+08 Pa']
    """
    base = [sample.coarser(coarser) for sample in samples]
    files = [sample.write(folder) for sample in base]
    voxel = base[0].voxel_size
    title = "synthetic snow" if any(sample.source for sample in samples) else ""
    scene = grains_scene(files[0], voxel, [stage], settings=settings, title=title)
    full = scene.resolve().data

    variants = [Variant(BASE, BASE, files, voxel)]
    for varied, names, factors in SETTINGS:
        for factor in factors:
            changes = {name: _scaled(full["numerics"][name], factor) for name in names}
            if changes.get("density_scaling", 1.0) >= 1.0:  # ice is not made lighter
                paths = {f"numerics.{name}": value for name, value in changes.items()}
                title = _variant_title(varied, next(iter(changes.values())))
                variants.append(Variant(title, varied, files, voxel, paths))
    for factor in SPEEDS:
        speed = _scaled(full["loading"][0]["speed"], factor)
        title, path = f"speed {1e3 * speed:g} mm/s", {"loading.0.speed": speed}
        variants.append(Variant(title, "speed", files, voxel, path))
    for voxels_per_sphere in ([coarser - 1] if finer else []) + [coarser + 1]:
        variants.append(sphere_size_variant(samples, folder, voxels_per_sphere))
    small = [sample.middle(SMALLER_EDGE).write(folder) for sample in base]
    variants.append(Variant("volume / 8", "volume", small, voxel))
    return Comparison(scene, variants, "grains-sensitivity")


def sphere_size_variant(
    samples: Sequence[LabelledSample], folder: Path, voxels_per_sphere: int
) -> Variant:
    """Return the variant whose spheres are `voxels_per_sphere` voxels of the samples wide.

    Raises
    ------
    InputError
        If `voxels_per_sphere` is not positive, or too large for the samples.
    """
    if voxels_per_sphere < 1:
        raise InputError("finer spheres: the samples have no finer voxels; needs coarser above 1")
    other = [sample.coarser(voxels_per_sphere) for sample in samples]
    size = other[0].voxel_size
    files = [sample.write(folder) for sample in other]
    return Variant(f"spheres {1e6 * size:g} um", "sphere size", files, size)


def _scaled(value: float, factor: float) -> float:
    """Return a product without rounding errors in its last digits."""
    return float(f"{value * factor:.12g}")


def _variant_title(varied: str, value: float) -> str:
    unit = {"elastic modulus": " Pa", "strength of bonds": " Pa"}.get(varied, "")
    times = "x " if varied == "density of ice" else ""
    return f"{varied} {times}{value:g}{unit}"
