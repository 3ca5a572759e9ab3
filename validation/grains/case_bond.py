"""Bonds between two grains that are pulled, sheared and pressed, against closed forms."""

from __future__ import annotations

import numpy as np

from snowshed.scene.loading import LoadingStage
from snowshed.snow.accuracy.measurements import CaseSettings, Measured
from validation.framework.case import Case, Outcome, Quantity
from validation.framework.drive import relative
from validation.grains.loading import grains_drive, load_all, residual

VOXEL = 5e-5  # m
BLOCK_WIDTH = 5  # voxels
SAMPLE_HEIGHT = 6  # voxels; the bond lies in the middle
MODULUS, RATIO, STRENGTH = 1e9, 0.3, 1e6  # Pa, 1, Pa
CASE_SETTINGS = frozenset({"test", "speed"})
DEFAULTS: CaseSettings = {
    "test": "pull",
    "speed": 0.005,
    "courant_factor": 0.3,
    "density_scaling": 1.0,
    "damping": 0.5,
    "elastic_modulus": MODULUS,
    "stiffness_ratio": RATIO,
    "tensile_strength": STRENGTH,
    "shear_strength": STRENGTH,
    "friction": 0.0,
}
#: Springs in a row: at both plates and in the bond.
SPRINGS = 3
#: Compliance of each spring, (2 r)²/(E r), m/Pa.
COMPLIANCE = 4 * (VOXEL / 2) / MODULUS


def stage_of(test: str, speed: float) -> LoadingStage:
    """Return the stage that loads the bond, until it breaks or only elastically."""
    breaking_strain = STRENGTH * SPRINGS * COMPLIANCE / (SAMPLE_HEIGHT * VOXEL)
    if test == "pull":
        return LoadingStage(kind="stretch", speed=speed, strain=1.3 * breaking_strain)
    if test == "shear":
        return LoadingStage(kind="shear", speed=speed, strain=1.3 * breaking_strain / RATIO)
    return LoadingStage(kind="compress", speed=speed, strain=breaking_strain)


def measure(settings: CaseSettings) -> Outcome:
    """Load two blocks that fill the box and are frozen to the plates; return the errors."""
    test = str(settings["test"])
    labels = np.ones((SAMPLE_HEIGHT, BLOCK_WIDTH, BLOCK_WIDTH), dtype=np.int64)
    labels[SAMPLE_HEIGHT // 2 :] = 2
    settings = {**settings, "bonded_plates": True}
    if test == "shear":  # the blocks tilt elastically alone, and the bond breaks in shear alone
        settings["tensile_strength"] = 1e3 * STRENGTH
    stages = [stage_of(test, float(settings["speed"]))]
    drive = grains_drive(labels, VOXEL, stages, settings, CASE_SETTINGS)
    curve = load_all(drive, stages, SAMPLE_HEIGHT * VOXEL)
    missing = residual(curve)
    measured = [Measured("residual", missing, 0.0, missing)]
    if test == "pull":
        measured.append(relative("strength", -float(curve["top_stress_pa"].min()), STRENGTH))
    elif test == "shear":
        measured.append(relative("strength", float(curve["shear_stress_pa"].max()), STRENGTH))
    else:
        exact = SAMPLE_HEIGHT * VOXEL / (SPRINGS * COMPLIANCE)
        slope = np.polyfit(curve["axial_strain"], curve["top_stress_pa"], 1)[0]
        measured.append(relative("modulus", float(slope), exact))
    return drive.outcome(measured)


def matrix(full: bool) -> list[CaseSettings]:
    """Return loadings at several speeds, Courant factors and density scalings."""
    settings_list: list[CaseSettings] = []
    for test in ("pull", "shear", "press"):
        base: CaseSettings = {**DEFAULTS, "test": test}
        speeds = (0.1, 0.03, 0.01, 0.005, 0.002) if full else (0.02, 0.005)
        settings_list += [{**base, "speed": speed} for speed in speeds]
        factors = (1.0, 0.6, 0.15) if full else (0.6,)
        settings_list += [{**base, "courant_factor": factor} for factor in factors]
        scalings = (4.0, 16.0, 100.0) if full else (16.0,)
        settings_list += [{**base, "density_scaling": scaling} for scaling in scalings]
    return settings_list


CASE = Case(
    name="grains_bond",
    title="A bond between two grains, pulled, sheared and pressed",
    source="springs in a row, and strength times area, in closed form",
    description="""
    Two blocks of 5 x 5 x 3 voxels fill the box and are frozen to each other and to both plates. The
    top plate moves until the bond breaks, or it presses. The bond bears its strength times its
    area, and the modulus follows from three layers of springs with the stiffness E r. The largest
    stress and the slope of the stress are compared with these values. The energy residual at the
    end is relative to the work of the plate.
    """,
    quantities=(
        Quantity("strength", "strength, Pa", limit=0.02, limit_for={"speed": 0.005}),
        Quantity("modulus", "modulus, Pa", limit=0.01, limit_for={"speed": 0.005}),
        Quantity("residual", "energy that is missing", limit=0.01),
    ),
    matrix=matrix,
    measure=measure,
    remarks="""
    The stress is not averaged in time. It therefore oscillates with the waves that the start of the
    plate sends through the blocks. The amplitude is proportional to the speed and to the root of
    the scaled density.
    """,
)
