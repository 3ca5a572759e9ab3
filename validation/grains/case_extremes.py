"""Loading tests at the extremes of samples, stages and settings: finite results, or an error."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from snowshed._core import SimulationError
from snowshed.base.arrays import Integers
from snowshed.scene.loading import LoadingStage
from snowshed.snow.accuracy.measurements import CaseSettings, Measured
from validation.framework.case import Case, Outcome, Quantity
from validation.grains.loading import GRAIN, grains_drive, snow_labels

CASE_SETTINGS = frozenset({"sample", "kind", "speed", "strain", "steps_to_take"})
STEPS = 200
VOXEL = GRAIN / 4


def _balls() -> Integers:
    """Return two balls that touch neither each other nor anything else."""
    labels = np.zeros((12, 12, 12), dtype=np.int64)
    labels[2:5, 2:5, 2:5], labels[7:10, 7:10, 7:10] = 1, 2
    return labels


def _checkers() -> Integers:
    """Grains of one voxel each, all of which touch."""
    return np.arange(1, 217, dtype=np.int64).reshape(6, 6, 6)


SAMPLES: Mapping[str, Integers] = {
    "snow": snow_labels(3, 4),
    "voxel": np.pad(np.ones((1, 1, 1), dtype=np.int64), 2),
    "block": np.ones((6, 6, 6), dtype=np.int64),
    "two apart": _balls(),
    "grains of a voxel": _checkers(),
    "plate of a voxel": np.ones((1, 8, 8), dtype=np.int64),
}
KINDS = ("compress", "stretch", "shear", "isotropic", "penetrate")
DEFAULTS: CaseSettings = {
    "sample": "snow",
    "kind": "compress",
    "speed": 1.0,
    "strain": 0.9,
    "density_scaling": 1.0,
    "bonded_plates": True,
}
#: Settings that differ from the defaults.
EXTREMES: tuple[CaseSettings, ...] = (
    {"elastic_modulus": 1.0},
    {"elastic_modulus": 1e12},
    {"stiffness_ratio": 1e-9},
    {"stiffness_ratio": 10.0},
    {"tensile_strength": 0.0, "shear_strength": 0.0},
    {"tensile_strength": 1e12, "shear_strength": 1e12},
    {"tensile_strength": 0.0},
    {"shear_strength": 0.0},
    {"friction": 0.0},
    {"friction": 100.0},
    {"density": 1e-3},
    {"density": 1e5},
    {"density_scaling": 1e9},
    {"damping": 0.0},
    {"damping": 0.99},
    {"courant_factor": 1e-3},
    {"courant_factor": 1.0},
    {"speed": 1e-6},
    {"speed": 1000.0},
    {"speed": 1000.0, "density_scaling": 1e6},
    {"speed": 100.0, "tensile_strength": 1e12, "shear_strength": 1e12, "steps_to_take": 3000},
    {"sides": "periodic"},
    {"sides": "periodic", "speed": 100.0, "steps_to_take": 3000},
    {"speed": 10.0, "density_scaling": 1e4, "steps_to_take": 6000},
)


def measure(settings: CaseSettings) -> Outcome:
    """Take some steps, and count the numbers that are not finite."""
    kind, strain = str(settings["kind"]), float(settings["strain"])
    stage = LoadingStage(kind=kind, speed=float(settings["speed"]), strain=strain)  # type: ignore[arg-type]
    drive = grains_drive(SAMPLES[str(settings["sample"])], VOXEL, [stage], settings, CASE_SETTINGS)
    stopped = 0.0
    try:
        drive.step(int(settings["steps_to_take"]))
    except SimulationError:  # the error names its cause, and the grains are unchanged
        stopped = 1.0
    energies = [value for name, value in drive.core.energy().items() if name.endswith("_j")]
    spheres = drive.core.grains_spheres()[0]
    not_finite = float(
        np.count_nonzero(~np.isfinite(spheres)) + sum(not math.isfinite(e) for e in energies)
    )
    return drive.outcome(
        [
            Measured("unsound", not_finite, 0.0, not_finite),
            Measured("stopped", stopped, 0.0, stopped),
        ]
    )


def matrix(full: bool) -> list[CaseSettings]:
    """Return every kind of stage for every sample, and settings at their extremes."""
    base: CaseSettings = {**DEFAULTS, "steps_to_take": 5000 if full else STEPS}
    settings_list: list[CaseSettings] = [
        {**base, "sample": sample, "kind": kind, **({"speed": 50.0} if full else {})}
        for sample in SAMPLES
        for kind in KINDS
    ]
    return settings_list + [{**base, **extreme} for extreme in EXTREMES]


CASE = Case(
    name="grains_extremes",
    title="Grains at the extremes",
    source="all numbers are finite",
    description="""
    Six samples are compressed, stretched, sheared, pressed from all sides and penetrated: snow, a
    single voxel, a block, two balls that touch nothing, grains of one voxel and a layer of one
    voxel. In addition, snow is compressed with stiffness, strength, friction, density, damping,
    time step, speed and scaled inertia at the extremes of their allowed ranges, in some tests by
    nine tenths of its height. All coordinates and energies must be finite. A test may stop with an
    error that names its cause.
    """,
    quantities=(
        Quantity("unsound", "numbers that are not finite", limit=0.0, relative=False),
        Quantity("stopped", "tests that stopped with an error", relative=False),
    ),
    matrix=matrix,
    measure=measure,
    remarks="""
    Spheres that are pressed past each other's centres are pushed apart on the far side, because the
    contact law depends on the distance alone. The results of such a test have no meaning. The
    stress shows this, because it is then far above the strength of ice.
    """,
)
