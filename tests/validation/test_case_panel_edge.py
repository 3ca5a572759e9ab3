"""Slabs thrown from a panel's edge: the rigid slab, made-up flights, and a coarse throw."""

import math

import numpy as np
import pytest
from validation.panel_edge import case as panel_edge
from validation.panel_edge.case import CASE, SLAB, Moment
from validation.panel_edge.rigid_slab import RigidSlab


def test_a_tipping_slab_without_friction_keeps_its_energy():
    slab = RigidSlab(0.4, 0.05, tilt=35, friction=0.0, sliding_distance=0.6)
    state = slab._departure()
    x, z = slab._to_horizontal(state.position)
    tilt = math.radians(35)
    # It started `sliding_distance` up the slope from the edge, half its thickness above the face.
    start = 0.6 * math.sin(tilt) + 0.025 * math.cos(tilt)
    kinetic = (state.velocity @ state.velocity + slab._inertia * state.spin**2) / 2
    assert kinetic == pytest.approx(slab.gravity * (start - z), rel=1e-9)
    assert x > 0
    assert state.spin > 0


def test_friction_slows_a_rigid_slab_down():
    landings = [RigidSlab(0.2, 0.04, 40, mu, 1.0).landing(1.0) for mu in (0.0, 0.3, 0.6)]
    assert landings[0].distance > landings[1].distance > landings[2].distance
    assert landings[0].time_s < landings[1].time_s < landings[2].time_s


def test_long_slabs_fly_farther():
    near, far = (RigidSlab(length, 0.04, 40, 0.0, 1.0).landing(1.0) for length in (0.05, 0.3))
    assert far.distance > near.distance


def parabola(wind):
    """Return a flight with a sideways acceleration `wind`, m/s2."""
    times = np.linspace(0.0, 0.5, 251)
    pull = np.array([wind, 0.0, -9.81])
    return [
        Moment(t, np.array([0.1, 0.0, 0.02]) + t * np.array([2.0, 0, -1.0]) + t**2 / 2 * pull,
               np.array([2.0, 0, -1.0]) + t * pull, 0.0, 1.0)
        for t in times
    ]  # fmt: skip


def test_the_deviation_from_the_parabola():
    assert panel_edge.parabola_deviation(parabola(0.0)) < 1e-12
    flight = parabola(0.1)
    distance = np.linalg.norm(flight[-1].position - flight[0].position)
    assert panel_edge.parabola_deviation(flight) == pytest.approx(0.1 * 0.5**2 / 2 / distance)


def test_landing_is_where_the_drop_is_crossed():
    flight = parabola(0.0)
    while flight[-1].position[2] < -panel_edge.DROP:
        last = flight.pop()
    fall = (math.sqrt(1 + 2 * 9.81 * 1.02) - 1) / 9.81
    assert panel_edge.landing([*flight, last]) == pytest.approx(0.1 + 2 * fall, abs=1e-4)


@pytest.mark.parametrize("settings", CASE.matrix(True) + CASE.matrix(False), ids=str)
def test_every_entry_makes_a_scene(settings):
    data = panel_edge.panel_scene(settings).resolve().data
    assert data["panel"]["friction"] == settings["friction"]
    assert data["numerics"]["dx"] == settings["dx"]


def test_a_coarse_throw_is_within_its_limits():
    outcome = CASE.measure({**SLAB, "dx": 0.02, "transfer": "apic"})
    results = {result.quantity: result for result in outcome.measured}
    assert set(results) == {quantity.name for quantity in CASE.quantities}
    assert abs(results["landing"].error) < 0.01
    assert results["flight"].error < 1e-3
    for quantity in CASE.quantities:
        assert abs(results[quantity.name].error) <= quantity.limit, quantity.name
    assert results["spin"].error > 0.1  # too fast; see the remarks


def test_flip_turns_a_slab_too_fast_and_damps_its_spin():
    results = {result.quantity: result for result in CASE.measure({**SLAB, "dx": 0.02}).measured}
    assert results["spin"].error == pytest.approx(0.18, abs=0.12)
    assert results["spin_kept"].value < 0.1  # the share of PIC damps it away


def test_a_slab_that_stays_is_an_error():
    with pytest.raises(ValueError, match="holds the slab"):
        CASE.measure({**SLAB, "dx": 0.02, "friction": 1.0})
