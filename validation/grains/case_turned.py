"""Snow that is turned in its grid of voxels: the same strength, whatever the grid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from snowshed.analysis.tomography.segmentation import SegmentationSettings, segment
from snowshed.base.arrays import Floats
from snowshed.methods.grains.phases import find_phases
from snowshed.scene.loading import LoadingStage
from snowshed.snow.accuracy.measurements import CaseSettings, Measured
from validation.framework.case import Case, Outcome, Quantity
from validation.grains.loading import grains_drive, load_all
from validation.grains.turned_body import DIAMETER, HEIGHT, MARGIN, TurnedBody

TURNS = (30, 45)  # degrees
SHIFT = 0.5  # voxels
#: Largest distance of a ratio from 1, in its standard errors.
MAX_STANDARD_ERRORS = 2.0
CASE_SETTINGS = frozenset({"voxel", "samples", "grains", "speed", "strain"})
DEFAULTS: CaseSettings = {
    "voxel": 5e-5,
    "samples": 10,
    "grains": "watershed",
    "speed": 0.02,
    "strain": 0.01,
    "density_scaling": 10.0,
}


@dataclass(frozen=True)
class Ratio:
    """Ratio of two mean strengths of the same samples.

    Attributes
    ----------
    mean
        Ratio of the means.
    error
        Its standard error, from the scatter of the samples (delta method).
    """

    mean: float
    error: float

    @classmethod
    def of(cls, changed: Floats, base: Floats) -> Ratio:
        """Return the ratio of paired strengths.

        Examples
        --------
        >>> Ratio.of(np.array([2.0, 4.0, 6.0]), np.array([1.0, 2.0, 3.0]))
        Ratio(mean=2.0, error=0.0)
        """
        ratio = float(changed.mean() / base.mean())
        rest = np.std(changed - ratio * base, ddof=1) / np.sqrt(len(base))
        return cls(ratio, float(rest / base.mean()))


@dataclass
class _Tests:
    """Loading tests of some bodies, with their cost."""

    settings: CaseSettings
    wall_s: float = 0.0
    updates: int = 0
    steps: int = 0
    particles: int = 0

    def strengths(self, *, turn: float = 0.0, shift: float = 0.0) -> Floats:
        """Return the strengths of all samples, Pa of the cylinder's area."""
        seeds = range(1, int(self.settings["samples"]) + 1)
        voxel = float(self.settings["voxel"])
        return np.array([self._strength(TurnedBody(seed, voxel, turn, shift)) for seed in seeds])

    def _strength(self, body: TurnedBody) -> float:
        image = body.image()
        if self.settings["grains"] == "cells":
            labels = body.cells(image.ice)
        else:
            labels = segment(image, SegmentationSettings(threads=1)).labels
        speed, strain = float(self.settings["speed"]), float(self.settings["strain"])
        stages = [LoadingStage(kind="compress", speed=speed, strain=strain)]
        drive = grains_drive(
            labels.astype(np.int64), body.voxel, stages, self.settings, CASE_SETTINGS
        )
        curve = load_all(drive, stages, HEIGHT)
        cost = drive.outcome([])
        self.wall_s += cost.wall_s
        self.updates += cost.updates
        self.steps += cost.steps
        self.particles += cost.particles
        strength = find_phases(curve.of_stage(1), "compress").strength
        if strength is None:
            raise ValueError(f"{image.source}: the plates never touched it")
        grid = (DIAMETER + 2 * MARGIN * body.voxel) ** 2
        return strength * grid / (0.25 * np.pi * DIAMETER**2)


def measure(settings: CaseSettings) -> Outcome:
    """Compress samples in turned and in shifted grids, and return the ratios of their strengths."""
    tests = _Tests(settings)
    base = tests.strengths()
    turned = {f"turned_{turn}": tests.strengths(turn=turn) for turn in TURNS}
    measured: list[Measured] = []
    for name, strengths in {**turned, "shifted": tests.strengths(shift=SHIFT)}.items():
        ratio = Ratio.of(strengths, base)
        away = abs(ratio.mean - 1.0) / ratio.error
        measured += [
            Measured(name, ratio.mean, 1.0, ratio.mean - 1.0),
            Measured(f"{name}_error", ratio.error, 0.0, ratio.error),
            Measured(f"{name}_away", away, 0.0, away),
            Measured(f"{name}_scatter", *_scatter(float(np.std(np.log(strengths / base), ddof=1)))),
        ]
    measured.append(Measured("scatter", *_scatter(float(base.std(ddof=1) / base.mean()))))
    return Outcome(measured, tests.wall_s, tests.updates, tests.steps, tests.particles)


def _scatter(value: float) -> tuple[float, float, float]:
    return value, 0.0, value


def matrix(full: bool) -> list[CaseSettings]:
    """Return sizes of voxels, and grains from the watershed or known cells."""
    if not full:
        return [{**DEFAULTS, "voxel": 1e-4, "samples": 2, "grains": "cells", "strain": 2e-3}]
    return [
        dict(DEFAULTS),
        {**DEFAULTS, "voxel": 7.5e-5},
        {**DEFAULTS, "voxel": 7.5e-5, "grains": "cells"},
    ]


def _quantities(name: str, title: str) -> tuple[Quantity, ...]:
    """Return a ratio, its standard error, its distance from 1, and the scatter of its samples."""
    return (
        Quantity(name, f"{title}: ratio of the mean strengths"),
        Quantity(f"{name}_error", f"{title}: standard error of the ratio"),
        Quantity(
            f"{name}_away",
            f"{title}: distance of the ratio from 1, standard errors",
            limit=MAX_STANDARD_ERRORS,
            limit_for={"voxel": 5e-5},
            relative=False,
        ),
        Quantity(f"{name}_scatter", f"{title}: standard deviation of a sample's log of the ratio"),
    )


CASE = Case(
    name="grains_turned",
    title="Snow turned in its grid of voxels: the same strength",
    source="the same body under the same load",
    description="""
    Cylinders of a random field are turned about their axis by 0, 30 and 45 degrees, become voxels,
    are cut into grains, and are compressed along the axis, without side walls. Only the grid
    differs, so the strengths must be the same. A grid that is shifted by half a voxel along x and y
    shows how much of the scatter comes from the voxels themselves. The largest stress below a
    strain of 1 % is compared, as the ratio of the means over the samples with its paired standard
    error. Grains come from the watershed, or are known cells of space that turn with the body.
    """,
    quantities=(
        *(q for turn in TURNS for q in _quantities(f"turned_{turn}", f"turned by {turn} degrees")),
        *_quantities("shifted", "shifted by half a voxel"),
        Quantity("scatter", "standard deviation of the samples' strengths over their mean"),
    ),
    matrix=matrix,
    measure=measure,
    remarks="""
    With coarse voxels the watershed finds other grains in a turned grid, because its depth and its
    smallest grain are counts of voxels. A sample's strength then changes much, while with known
    cells it does not. Finer voxels reduce this. The grid is only turned about the direction of the
    load: plates are layers of voxels, so a tilted grid would need tilted plates.
    """,
)
