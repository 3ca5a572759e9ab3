"""Compression of synthetic snow: the effect of numerical settings on the stress."""

from __future__ import annotations

from snowshed.scene.loading import LoadingStage
from snowshed.snow.accuracy.measurements import CaseSettings, Measured
from validation.framework.case import Case, Outcome, Quantity
from validation.framework.drive import relative
from validation.grains.loading import (
    GRAIN,
    grains_drive,
    load_all,
    mean_stress,
    residual,
    snow_labels,
)

STRAIN = 0.05
CASE_SETTINGS = frozenset({"across", "voxels", "speed", "seed"})
DEFAULTS: CaseSettings = {
    "across": 3,
    "voxels": 5,
    "seed": 1,
    "speed": 0.1,
    "courant_factor": 0.3,
    "density_scaling": 1.0,
}
SCALINGS = (1e4, 1e3, 100.0, 10.0, 1.0)
#: Mean stress from 4 to 5 % of strain of the default snow, Pa, at 0.02 m/s without scaled density:
#: recorded once with this case.
REFERENCE = 2250477.8267052164


def measure(settings: CaseSettings) -> Outcome:
    """Compress a cube by 5 %, and return the errors of stress and balances."""
    across, voxels = int(settings["across"]), int(settings["voxels"])
    labels = snow_labels(across, voxels, int(settings["seed"]))
    stages = [LoadingStage(kind="compress", speed=float(settings["speed"]), strain=STRAIN)]
    drive = grains_drive(labels, GRAIN / voxels, stages, settings, CASE_SETTINGS)
    curve = load_all(drive, stages, across * GRAIN)
    stress, missing = mean_stress(curve, STRAIN - 0.01, STRAIN), residual(curve)
    bottom_share = abs(
        float(curve["bottom_stress_pa"][-30:].mean()) / curve["top_stress_pa"][-30:].mean()
    )
    return drive.outcome(
        [
            relative("stress", stress, REFERENCE),
            Measured("residual", missing, 0.0, missing),
            relative("bottom", bottom_share, 1.0),
        ]
    )


def matrix(full: bool) -> list[CaseSettings]:
    """Return density scalings, speeds, Courant factors, voxels per cell and sizes of the sample."""
    if not full:
        fast: CaseSettings = {**DEFAULTS, "density_scaling": 100.0}
        return [fast, {**fast, "courant_factor": 0.6}, {**fast, "voxels": 4}]
    fast = {**DEFAULTS, "density_scaling": 100.0}
    settings_list: list[CaseSettings] = [{**DEFAULTS, "density_scaling": s} for s in SCALINGS]
    settings_list += [{**DEFAULTS, "speed": speed} for speed in (0.3, 1.0)]
    settings_list += [{**fast, "courant_factor": factor} for factor in (0.05, 0.1, 0.6, 1.0)]
    settings_list += [{**fast, "voxels": voxels} for voxels in (3, 4, 6, 8)]
    settings_list += [
        {**fast, "across": across, "seed": s} for across in (3, 4, 6) for s in (1, 2, 3)
    ]
    slow: CaseSettings = {**DEFAULTS, "speed": 0.02}
    return [*settings_list, slow]


CASE = Case(
    name="grains_press",
    title="Snow of grains in confined compression: the stress at 5 % strain",
    source="itself, with the slowest plate and without scaled density; the balance of energy",
    description="""
    Synthetic snow, a random field of waves that is cut at a level and into cells, is compressed by
    5 % between plates and smooth walls. The mean stress from 4 to 5 % is compared for several time
    steps, scaled densities, speeds, sphere sizes (of the same snow) and volumes (with three samples
    each). There is no exact answer. The reference is snow of 27 cells with 5 voxels per cell,
    loaded at 0.02 m/s without scaled density. For volumes the error is mostly the scatter between
    samples. The energy balance and, at rest, the balance of the forces on the two plates have exact
    answers.
    """,
    quantities=(
        Quantity("stress", "mean stress from 4 to 5 % strain, Pa"),
        Quantity("residual", "energy that is missing", limit=0.005),
        Quantity("bottom", "stress on the bottom plate over that on the top plate"),
    ),
    matrix=matrix,
    measure=measure,
    remarks="""
    Without gravity the equations contain the scaled density s and the speed v only as s v². Twice
    the speed therefore has the same error as four times the density, and saves the same time.
    """,
)
