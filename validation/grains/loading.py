"""Snow of grains for the cases: one microstructure for voxels of any size, and loading tests."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from snowshed.base.arrays import Integers
from snowshed.methods.grains import phases
from snowshed.methods.grains.curve import LoadingCurve
from snowshed.methods.grains.settings import GrainsSettings
from snowshed.scene import grains_scene
from snowshed.scene.loading import Cone, LoadingStage
from snowshed.snow.accuracy.measurements import CaseSettings
from validation.framework.drive import TimedEventDriver

GRAIN = 3e-4  # m, edge of the cells that cut the ice into grains
WAVES = 80  # waves in the random field
WAVELENGTH = 1.4  # over GRAIN
THRESHOLD = 0.45  # level of the field above which there is ice, in standard deviations


def snow_labels(across: int, voxels: int, seed: int = 1) -> Integers:
    """Return the labels of synthetic snow: a random field of waves, cut at a level and into cells.

    Field and cells are functions of space, so the snow is the same for voxels of any size.

    Parameters
    ----------
    across
        Cells along each edge.
    voxels
        Voxels along the edge of a cell.
    seed
        Seed of the field and the cells.

    Examples
    --------
    >>> labels = snow_labels(2, 4)
    >>> labels.shape, bool(0.2 < (labels > 0).mean() < 0.5)
    ((8, 8, 8), True)
    """
    random = np.random.default_rng(seed)
    waves = random.standard_normal((WAVES, 3))
    waves *= 2 * np.pi / WAVELENGTH / np.linalg.norm(waves, axis=1)[:, None]
    phase = random.uniform(0, 2 * np.pi, WAVES)
    axis = (np.arange(across * voxels) + 0.5) / voxels
    field = np.zeros((len(axis),) * 3)
    for (x, y, z), shift in zip(waves, phase):
        angles = np.add.outer(np.add.outer(z * axis, y * axis), x * axis) + shift
        field += np.cos(angles) * np.sqrt(2 / WAVES)
    cells = np.argwhere(np.ones((across,) * 3)) + random.uniform(0.2, 0.8, (across**3, 3))
    nearest, labels = np.full(field.shape, np.inf), np.zeros(field.shape, dtype=np.int64)
    for label, (z, y, x) in enumerate(cells, start=1):
        square = np.add.outer(np.add.outer((axis - z) ** 2, (axis - y) ** 2), (axis - x) ** 2)
        labels[square < nearest] = label
        nearest = np.minimum(nearest, square)
    return np.where(field > THRESHOLD, labels, 0)


def grains_drive(
    labels: Integers,
    voxel: float,
    stages: Sequence[LoadingStage],
    settings: CaseSettings,
    case_settings: Collection[str] = (),
    cone_radius: float = GRAIN,
) -> TimedEventDriver:
    """Return a loading test before its first step, with an energy balance and without gravity.

    Parameters
    ----------
    settings
        Parameters of `GrainsSettings`; the test uses one thread.
    case_settings
        Names of settings that belong to the case, not to the method.
    cone_radius
        Radius of the cone in stages that penetrate, m.
    """
    chosen = GrainsSettings(threads=1)
    for name, value in settings.items():
        if name not in case_settings:
            setattr(chosen, name, value)
    with TemporaryDirectory() as folder:
        file = Path(folder) / "labels.npy"
        np.save(file, labels)
        pushed = any(stage.kind == "penetrate" for stage in stages)
        cone = Cone(radius=cone_radius, half_angle=30.0) if pushed else None
        scene = grains_scene(file, voxel, stages, settings=chosen, cone=cone)
        return TimedEventDriver(scene.update({"gravity": 0, "output.energy": True}))


def load_all(
    drive: TimedEventDriver, stages: Sequence[LoadingStage], height: float
) -> LoadingCurve:
    """Take steps until the planned end of all stages, and return the measured curve.

    Parameters
    ----------
    height
        Height of the sample, m.
    """
    longest = 0.0
    for stage in stages:
        if stage.strain is None or stage.speed is None:
            raise ValueError("a stage must have a strain and a speed")
        longest += stage.strain * height / stage.speed
    drive.run_to(longest * (1 + 1e-6))
    return LoadingCurve(drive.core.grains_curve())


def residual(curve: LoadingCurve) -> float:
    """Return the energy that is missing at the end, relative to the largest work."""
    return float(abs(curve["residual_j"][-1]) / np.abs(curve["boundary_work_j"]).max())


def mean_stress(curve: LoadingCurve, low: float, high: float) -> float:
    """Return the mean stress on the top plate between two strains, Pa."""
    stress = phases.mean_stress(curve["axial_strain"], curve["top_stress_pa"], low, high)
    if stress is None:
        raise ValueError(f"the test does not go from {low:%} to {high:%}")
    return stress
