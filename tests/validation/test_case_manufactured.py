"""Chosen motions: Newton's law by differences, times of forces, and coarse solutions."""

import numpy as np
import pytest
from validation.manufactured import case as manufactured
from validation.manufactured.case import APIC, CASES, FLIP, SCHEME, VORTEX, WAVES
from validation.manufactured.forced_body import ForcedBody
from validation.manufactured.motions import (
    DENSITY,
    WAVE_SPEED,
    YOUNGS_MODULUS,
    AxialWaves,
    Vortex,
)

MOTIONS = [AxialWaves(0.04), Vortex(1.0)]
TIME_OF_MAXIMUM = 0.4 / WAVE_SPEED  # a time near that of the largest displacement
DIFFERENCE_STEP = 1e-4  # m, for differences in space


def difference(function, at, step):
    """Return the first derivative from values up to two steps away."""
    far = function(at - 2 * step) - function(at + 2 * step)
    return (far + 8 * (function(at + step) - function(at - step))) / (12 * step)


def gradient(field, points):
    """Return d field/dX of vectors or tensors; the last index is that of X."""
    parts = [
        difference(lambda x, axis=axis: field(points + x * np.eye(2)[axis]), 0.0, DIFFERENCE_STEP)
        for axis in range(2)
    ]
    return np.stack(parts, axis=-1)


def first_piola_kirchhoff(motion, points, time):
    """Return P = tau F^-T of Hencky elasticity by an eigendecomposition of F F^T."""
    stretch = np.eye(2) + gradient(lambda x: motion.displacement(x, time), points)
    values, vectors = np.linalg.eigh(stretch @ stretch.transpose(0, 2, 1))
    strains = np.log(values) / 2
    nu = motion.poissons_ratio
    mu = YOUNGS_MODULUS / (2 * (1 + nu))
    lam = YOUNGS_MODULUS * nu / ((1 + nu) * (1 - 2 * nu))
    principal = 2 * mu * strains + lam * strains.sum(axis=1, keepdims=True)
    stress = np.einsum("nik,nk,njk->nij", vectors, principal, vectors)
    return stress @ np.linalg.inv(stretch).transpose(0, 2, 1)


@pytest.mark.parametrize("motion", MOTIONS, ids=["waves", "vortex"])
def test_body_forces_obey_newtons_law(motion):
    points = np.random.default_rng(1).uniform(0.05, 0.95, (100, 2))
    stress = gradient(lambda x: first_piola_kirchhoff(motion, x, TIME_OF_MAXIMUM), points)
    inner = np.einsum("nijj->ni", stress) / DENSITY
    step = 1e-3 / WAVE_SPEED
    acceleration = difference(lambda t: motion.velocity(points, t), TIME_OF_MAXIMUM, step)
    force = motion.body_force(points, TIME_OF_MAXIMUM)
    assert np.abs(acceleration - inner - force).max() < 1e-6 * np.abs(force).max()


@pytest.mark.parametrize("motion", MOTIONS, ids=["waves", "vortex"])
def test_velocities_are_the_rate_of_displacements(motion):
    points = np.random.default_rng(2).uniform(0, 1, (50, 2))
    rate = difference(lambda t: motion.displacement(points, t), TIME_OF_MAXIMUM, 1e-3 / WAVE_SPEED)
    assert motion.velocity(points, TIME_OF_MAXIMUM) == pytest.approx(rate, rel=1e-8, abs=1e-8)


@pytest.mark.parametrize("motion", MOTIONS, ids=["waves", "vortex"])
def test_the_sides_of_the_square_are_free_of_stress(motion):
    along = np.linspace(0, 1, 21)
    for side in (0.0, 1.0):
        for axis in range(2):
            points = np.insert(along[:, np.newaxis], axis, side, axis=1)
            traction = first_piola_kirchhoff(motion, points, TIME_OF_MAXIMUM)[:, :, axis]
            assert np.abs(traction).max() < 1e-5 * YOUNGS_MODULUS


def test_strains_have_their_stated_size():
    points = np.stack(np.meshgrid(*[np.linspace(0, 1, 401)] * 2), axis=-1).reshape(-1, 2)
    time = 0.5 / WAVE_SPEED
    stretch = gradient(lambda x: AxialWaves(0.04).displacement(x, time), points)
    assert np.abs(stretch).max() == pytest.approx(4 * np.pi * 0.04, rel=1e-3)
    turned = np.eye(2) + gradient(lambda x: Vortex(1.0).displacement(x, time), points)
    assert np.linalg.det(turned) == pytest.approx(1.0)
    shear = np.linalg.norm(turned, axis=(1, 2)) ** 2 - 2  # s^2 of a simple shear
    assert np.sqrt(shear.max()) == pytest.approx(0.84, abs=0.01)


def test_a_body_without_motion_stays_at_rest():
    body = ForcedBody(Vortex(0.0), {**SCHEME, **APIC, "dx": 0.1})
    for _ in range(5):
        body.step()
    assert np.abs(body.residual()).max() < 1e-15


def test_the_full_force_is_applied_with_varying_steps(monkeypatch):
    """Momentum is force times time if the force is constant in space and time."""
    monkeypatch.setattr(Vortex, "body_force", lambda self, points, time: 0 * points + [3.0, -1.0])
    body = ForcedBody(Vortex(0.5), {**SCHEME, **FLIP, "dx": 0.1})
    initial = body.drive.mean(body.drive.core.velocities())
    steps = set()
    for _ in range(10):
        body.step()
        steps.add(round(body.drive.core.time_step_s, 12))
    assert len(steps) > 5
    gained = body.drive.mean(body.drive.core.velocities()) - initial
    # The next force corrects the last step's change of length.
    pending = body._velocity_correction.mean(axis=0)
    assert gained[[0, 2]] + pending == pytest.approx(np.array([3.0, -1.0]) * body.time)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_matrices_list_no_entry_twice_and_reach_the_limits(case):
    for full in (False, True):
        entries = case.matrix(full)
        assert len({tuple(sorted(entry.items())) for entry in entries}) == len(entries)
        for settings in entries:
            assert manufactured.motion_of(settings).omega > 0
    for quantity in case.quantities:
        for full in (False, True):
            assert any(quantity.limit_for.items() <= entry.items() for entry in case.matrix(full))


@pytest.mark.parametrize("start", [WAVES, VORTEX], ids=["waves", "vortex"])
@pytest.mark.parametrize("transfer", [FLIP, APIC], ids=["flip", "apic"])
def test_finer_cells_are_more_accurate(start, transfer):
    # Steps are short, because APIC's longest steps would hide some of the error of the cells.
    settings = {**SCHEME, **start, **transfer, "particles_per_voxel": 9, "courant_factor": 0.6}
    errors = [manufactured.measure({**settings, "dx": 1 / n}).measured[0].error for n in (12, 18)]
    assert errors[1] < errors[0] / 1.5**1.6


def test_smaller_steps_approach_the_smallest(monkeypatch):
    monkeypatch.setattr(manufactured, "MIN_COURANT_FACTOR", 0.9 / 16)
    settings = manufactured.steps_matrix(False)[0]
    results = [
        manufactured.measure_steps({**settings, "courant_factor": factor}).measured
        for factor in (0.9, 0.45)
    ]
    assert [result.quantity for result in results[0]] == ["step", "displacement"]
    coarse, fine = (result[0].error for result in results)
    assert fine < 0.6 * coarse
