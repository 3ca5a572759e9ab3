"""A folder in which snow is fitted to the loading tests of samples."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional

from snowshed.analysis.grains.material.figures import material_figure
from snowshed.analysis.grains.material.fit import FittedSnow, fit_material, isotropic_strength
from snowshed.analysis.grains.material.loading_tests import MaterialTests, read_curves
from snowshed.analysis.grains.material.report import write_snow, write_table
from snowshed.analysis.grains.samples import LabelledSample
from snowshed.analysis.grains.variants import Comparison
from snowshed.methods.grains.settings import GrainsSettings

#: Ratio of densities from which two samples count as different snow.
MIN_DENSITY_RATIO = 1.1


@dataclass(frozen=True)
class MaterialFolder:
    """The results of ``snowshed grains material``.

    Attributes
    ----------
    path
        The folder: ``samples/``, ``runs/`` (the store), ``snow-DENSITY.json``,
        ``material-DENSITY.png`` and ``material.csv``.
    settings
        Settings of the tests.
    modulus
        Young's modulus of the snow, Pa; None: that of the grains.
    """

    path: Path
    settings: GrainsSettings
    modulus: Optional[float] = None

    @property
    def runs(self) -> Path:
        """The store."""
        return self.path / "runs"

    def tests(self, samples: Sequence[LabelledSample]) -> MaterialTests:
        """Return the tests of samples of one snow."""
        return MaterialTests(samples, self.path / "samples", self.settings)

    def strength(self, tests: MaterialTests) -> float:
        """Return p0 of the computed tests, Pa."""
        return isotropic_strength(read_curves(tests.without_shear(), self.runs))

    def write(self, tests: MaterialTests, shear: Comparison) -> FittedSnow:
        """Fit the snow of the computed tests, write it and its figure, and return it.

        Raises
        ------
        InputError
            If no snow can be fitted.
        """
        from snowshed.plot.figure_style import save_figure

        curves = {**read_curves(tests.without_shear(), self.runs), **read_curves(shear, self.runs)}
        fitted = fit_material(
            curves, tests.density, modulus=self.modulus, min_grains=tests.min_grains
        )
        synthetic = any(sample.source for sample in tests.samples)
        if synthetic:
            fitted.notes.append("the snow is synthetic")
        write_snow(self.path, fitted, _source(tests, self.settings))
        figure = material_figure(fitted, curves, synthetic=synthetic)
        save_figure(figure, self.path / f"material-{tests.density:.0f}.png")
        return fitted

    def write_table(self, fits: Sequence[FittedSnow]) -> None:
        """Write ``material.csv``."""
        write_table(self.path, fits)


def _source(tests: MaterialTests, settings: GrainsSettings) -> dict[str, Any]:
    return {
        "samples": [
            {
                "name": sample.name,
                "grains": sample.grains,
                "voxels": list(sample.labels.shape),
                "voxel_size_m": sample.voxel_size,
                "ice_fraction": round(sample.ice_fraction, 6),
                "synthetic": sample.source,
            }
            for sample in tests.samples
        ],
        "settings": settings.to_data(),
    }


def by_density(samples: Sequence[LabelledSample]) -> list[list[LabelledSample]]:
    """Return samples in groups of about the same density, the lightest first.

    Examples
    --------
    >>> import numpy as np
    >>> samples = [LabelledSample(str(n), np.ones((6, 6, n), dtype=int), 1e-4) for n in (6, 7)]
    >>> len(by_density(samples))
    1
    """
    groups: list[list[LabelledSample]] = []
    for candidate in sorted(samples, key=lambda sample: sample.ice_fraction):
        if groups and candidate.ice_fraction < MIN_DENSITY_RATIO * groups[-1][0].ice_fraction:
            groups[-1].append(candidate)
        else:
            groups.append([candidate])
    return groups
