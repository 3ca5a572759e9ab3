"""Spinning bodies: the closed form against its equation, and the effect of radial damping."""

import numpy as np
import pytest
from validation.elastic import case_spin as spin
from validation.elastic.case_spin import APIC, CASE, CYLINDER, DISC, FLIP, RADIUS, RATE, Spinning

COARSE = {**DISC, "dx": 0.25, "turns": 0.5}
COARSE_CYLINDER = {**CYLINDER, "dx": 0.25, "turns": 0.5}
MU = spin.YOUNGS_MODULUS / (2 * (1 + spin.POISSONS_RATIO))
LAMBDA = 2 * MU * spin.POISSONS_RATIO / (1 - 2 * spin.POISSONS_RATIO)


def measured(outcome):
    return {result.quantity: result for result in outcome.measured}


def test_the_expanded_disc_is_in_equilibrium():
    """The closed form solves d sigma_rr/dr + (sigma_rr - sigma_tt)/r = -rho omega^2 r."""
    r = np.linspace(1e-3, RADIUS, 20001)
    u = spin.expansion(r)
    radial, hoop = np.gradient(u, r, edge_order=2), u / r
    sigma_rr = (LAMBDA + 2 * MU) * radial + LAMBDA * hoop
    sigma_tt = (LAMBDA + 2 * MU) * hoop + LAMBDA * radial
    load = np.gradient(sigma_rr, r, edge_order=2) + (sigma_rr - sigma_tt) / r
    inner = slice(100, -2)
    assert load[inner] == pytest.approx(-spin.DENSITY * RATE**2 * r[inner], rel=1e-3)
    assert abs(sigma_rr[-1]) < 1e-6 * sigma_rr[0]


def test_the_change_per_turn_is_measured():
    assert spin.per_turn(1.0, 3 * spin.TURN) == 0
    assert spin.per_turn(0.81, 2 * spin.TURN) == pytest.approx(-0.1)
    assert spin.per_turn(1.0 + 1e-12, spin.TURN) == pytest.approx(1e-12, rel=1e-3)


@pytest.mark.parametrize("settings", [COARSE, COARSE_CYLINDER], ids=["disc", "cylinder"])
def test_a_body_begins_in_rigid_rotation(settings):
    body = Spinning({**settings, **APIC})
    drive = body.drive
    area = np.pi * RADIUS**2 * (spin.HEIGHT if settings["dimension"] == 3 else 1)
    assert drive.masses.sum() == pytest.approx(spin.DENSITY * area, rel=0.05)
    inertia = drive.masses @ body.radii**2
    assert body.angular_momentum == pytest.approx(RATE * inertia)
    assert body.energy == pytest.approx(RATE**2 * inertia / 2)
    assert inertia == pytest.approx(drive.masses.sum() * RADIUS**2 / 2, rel=0.05)
    assert body.expansion == 0


def test_settling_damps_radial_motion_but_keeps_angular_momentum():
    body = Spinning({**COARSE, **APIC})
    momentum = body.angular_momentum
    body.settle()
    assert body.angular_momentum == pytest.approx(momentum, rel=1e-12)
    expansions = []
    for _ in range(100):
        body.drive.step(2)
        expansions.append(body.expansion)
    assert np.ptp(expansions) < 0.05 * np.mean(expansions)


@pytest.mark.parametrize("full", [False, True])
def test_every_entry_makes_a_scene_and_occurs_once(full):
    entries = CASE.matrix(full)
    assert len({tuple(sorted(entry.items())) for entry in entries}) == len(entries)
    for settings in entries:
        data = spin.spin_scene(settings).resolve().data
        assert data["dimension"] == settings["dimension"]
        assert data["gravity"] == 0
        assert data["numerics"]["sleep_speed"] == 0
    for quantity in CASE.quantities:
        assert any(quantity.limit_for.items() <= entry.items() for entry in entries)


@pytest.mark.parametrize("settings", [COARSE, COARSE_CYLINDER], ids=["disc", "cylinder"])
@pytest.mark.parametrize("basis", ["quadratic", "cubic"])
def test_apic_keeps_angular_momentum_and_flip_does_not(settings, basis):
    apic = measured(CASE.measure({**settings, **APIC, "basis": basis}))
    flip = measured(CASE.measure({**settings, **FLIP, "basis": basis}))
    assert abs(apic["angular_momentum"].error) < 1e-10
    assert flip["angular_momentum"].error < -1e-3
    assert 0 < apic["energy"].error < flip["energy"].error
    assert ("expansion" in apic) == (settings["dimension"] == 2)
