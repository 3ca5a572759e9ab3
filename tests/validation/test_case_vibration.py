"""Vibrations: the beam against its energies, smoothing against interpolation, and coarse bodies."""

import math

import numpy as np
import pytest
from scipy.integrate import trapezoid
from validation.elastic import case_vibration as vibration
from validation.elastic.bodies import TRANSFERS
from validation.elastic.cantilever import Cantilever
from validation.elastic.case_vibration import BAR_DEFAULTS, CANTILEVER_DEFAULTS, CASES, ELASTIC_BAR
from validation.elastic.smoothing import Smoothing
from validation.elastic.swing import Swing

BEAM = Cantilever(1.0, 0.2, 1e6, 0.3, 210.0)
APIC = {"transfer": "apic"}


def measured(outcome):
    return {result.quantity: result for result in outcome.measured}


def test_the_beams_frequency_agrees_with_rayleighs_quotient():
    """Rayleigh's quotient is the elastic energy of the mode over its kinetic energy."""
    x = np.linspace(0, 1, 2001)
    w, psi = BEAM.shape(x)
    shear = 1e6 / 2.6 * 0.2 * 10 * (1 + 3 / 7) / (12 + 11 * 3 / 7)
    bent = 1e6 / 0.91 * 0.2**3 / 12 * np.gradient(psi, x, edge_order=2) ** 2
    sheared = shear * (np.gradient(w, x, edge_order=2) - psi) ** 2
    moving = 210.0 * (0.2 * w**2 + 0.2**3 / 12 * psi**2)
    omega = math.sqrt(trapezoid(bent + sheared, x) / trapezoid(moving, x))
    assert pytest.approx(omega, rel=1e-5) == 2 * math.pi * BEAM.frequency


def test_the_beam_is_clamped_at_one_end_and_free_at_the_other():
    x = np.linspace(0, 1, 2001)
    w, psi = BEAM.shape(x)
    assert w[0] == psi[0] == 0
    assert w[-1] == pytest.approx(1.0)
    assert abs(np.gradient(psi, x, edge_order=2)[-1]) < 1e-4  # no moment
    assert np.gradient(w, x, edge_order=2)[-1] == pytest.approx(psi[-1], abs=1e-4)  # no shear


@pytest.mark.parametrize("slenderness", [5, 10, 50])
def test_timoshenkos_beam_is_slower_than_eulers(slenderness):
    beam = Cantilever(1.0, 1 / slenderness, 1e6, 0.3, 210.0)
    missing = 1 - beam.frequency / beam.euler_frequency
    assert 0 < missing < 1 / slenderness**2
    assert missing == pytest.approx(0.84 / slenderness**2, rel=0.1)


def test_a_fit_recovers_the_slower_of_two_vibrations():
    t = np.linspace(0, 3, 400)
    slow = np.exp(-0.3 * t) * np.sin(2 * np.pi * 2 * t)
    swing = Swing.fit(t, slow + 1e-3 * np.sin(2 * np.pi * 17 * t), frequency=2.1)
    assert swing.frequency == pytest.approx(2.0, rel=1e-4)
    assert swing.decay == pytest.approx(0.3, rel=1e-2)
    assert swing.loss_per_period == pytest.approx(1 - math.exp(-0.15), rel=1e-2)


def spline(basis, u):
    """Return the quadratic or cubic B-spline, as a sum of truncated powers, and its support."""
    n = 2 if basis == "quadratic" else 3
    knots = np.arange(n + 2) - (n + 1) / 2
    signs = np.array([(-1) ** k * math.comb(n + 1, k) for k in range(n + 2)])
    return np.maximum(u[..., np.newaxis] - knots, 0) ** n @ signs / math.factorial(n)


@pytest.mark.parametrize("basis", ["quadratic", "cubic"])
@pytest.mark.parametrize("transfer", TRANSFERS, ids=str)
def test_smoothing_agrees_with_interpolating_a_wave(basis, transfer):
    """Interpolate once from particles to grid and back, on a ring of 20 cells with 64 particles
    each."""
    cells, count = 20, 64
    positions = (np.arange(cells * count) + 0.5) / count
    offsets = (np.arange(cells) - positions[:, np.newaxis] + cells / 2) % cells - cells / 2
    weights = spline(basis, offsets)
    k = 2 * np.pi / cells
    speeds = np.cos(k * positions)
    affine = -k * np.sin(k * positions)
    # These are the grid's velocities of a wave that has passed the grid once before.
    grid = weights.T @ speeds / count
    if transfer == APIC:
        scale = 4 if basis == "quadratic" else 3
        speeds, affine = weights @ grid, scale * (weights * offsets) @ grid
        next_grid = weights.T @ speeds + np.sum(weights * offsets * affine[:, np.newaxis], axis=0)
    else:
        ratio = transfer["flip_ratio"]
        next_grid = weights.T @ (ratio * speeds + (1 - ratio) * (weights @ grid))
    remaining = (next_grid / count) @ grid / (grid @ grid)
    settings = {**transfer, "basis": basis, "dx": 1.0}
    assert Smoothing.of(settings, k).velocity_share == pytest.approx(remaining, abs=1e-4)


@pytest.mark.parametrize("transfer", TRANSFERS, ids=str)
def test_the_loss_per_period_agrees_with_the_recurrence(transfer):
    smoothing = Smoothing.of({**transfer, "basis": "quadratic", "dx": 0.05}, np.pi)
    frequency, dt = 2.0, 0.001
    # Symplectic Euler raises a frequency by (omega dt)^2/24, which is left out.
    stiffness = (2 * np.pi * frequency) ** 2 / smoothing.force_share
    q, v, values = 0.0, 1.0, []
    for _ in range(1500):
        force = -stiffness * q
        q += dt * (v + dt * force)
        v = smoothing.velocity_share * v + smoothing.force_share * dt * force
        values.append(q)
    swing = Swing.fit(dt * np.arange(1, 1501), np.array(values), frequency)
    assert smoothing.loss_per_period(frequency, dt) == pytest.approx(
        swing.loss_per_period, rel=2e-2, abs=1e-6
    )


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_every_entry_makes_a_scene_and_occurs_once(case):
    make = vibration.bar_scene if case is ELASTIC_BAR else vibration.cantilever_scene
    for full in (False, True):
        entries = case.matrix(full)
        assert len({tuple(sorted(entry.items())) for entry in entries}) == len(entries)
        for settings in entries:
            data = make(settings).resolve().data
            assert data["numerics"]["dx"] == settings["dx"]
            assert data["numerics"]["sleep_speed"] == 0
            assert len(data["obstacles"]) == (case is not ELASTIC_BAR)
        for quantity in case.quantities:
            assert any(quantity.limit_for.items() <= entry.items() for entry in entries)


@pytest.mark.parametrize("offset", [0.0, 0.3])
def test_bodies_have_the_offset_to_the_grid(offset):
    settings = {**BAR_DEFAULTS, **APIC, "grid_offset": offset}
    x = vibration.TimedEventDriver(vibration.bar_scene(settings)).core.positions()[:, 0]
    assert x.min() == pytest.approx((offset + 0.25) * 0.05)
    assert x.max() == pytest.approx(1 + (offset - 0.25) * 0.05)
    settings = {**CANTILEVER_DEFAULTS, **APIC, "grid_offset": offset}
    drive = vibration.TimedEventDriver(vibration.cantilever_scene(settings))
    x = drive.core.positions()[:, 0]
    assert x.min() == pytest.approx((offset - 4 + 0.25) * 0.025)
    assert x.max() == pytest.approx(1 + (offset - 0.25) * 0.025)
    inside = drive.core.obstacle_distance(drive.core.positions()) < 0
    assert inside.mean() == pytest.approx(4 / 44, abs=0.01)


def test_a_coarse_bar_has_the_expected_frequency_and_loss():
    results = {
        str(transfer): measured(ELASTIC_BAR.measure({**BAR_DEFAULTS, **transfer}))
        for transfer in TRANSFERS
    }
    for result in results.values():
        assert abs(result["frequency"].error) < 0.01
        assert abs(result["unexplained_loss"].error) < 5e-4
    losses = [result["loss_per_period"].value for result in results.values()]
    flip, flip_99, flip_95, apic, pic = losses
    assert apic < flip < flip_99 < flip_95 < pic


def test_a_coarse_cantilever_has_about_its_frequency():
    settings = {**CANTILEVER_DEFAULTS, **APIC, "dx": 0.05}
    results = measured(vibration.CANTILEVER.measure(settings))
    assert abs(results["frequency"].error) < 0.04
    assert 0 < results["loss_per_period"].value < 0.02
