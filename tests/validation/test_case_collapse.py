"""Collapse of a column: the laws, the snow, the measure, and the quick entries."""

import numpy as np
import pytest
from validation.collapse import case as collapse
from validation.collapse import granular_column
from validation.collapse.case import CASE

from snowshed import InputError
from snowshed._core import CamClay


@pytest.mark.parametrize(
    "aspect, dimension, runout, height",
    [
        (0.5, 2, 0.6, 0.5),
        (1.8, 2, 2.16, 1.265),
        (4.0, 2, 4.788, 1.741),
        (8.0, 2, 7.6, 2.297),
        (0.5, 3, 0.62, 0.5),
        (1.0, 3, 1.24, 0.88),
        (4.0, 3, 3.2, 1.109),
    ],
)
def test_the_laws_have_the_expected_values(aspect, dimension, runout, height):
    assert granular_column.runout_law(aspect, dimension) == pytest.approx(runout, abs=1e-3)
    assert granular_column.height_law(aspect, dimension) == pytest.approx(height, abs=1e-3)


def test_the_plane_law_rises_through_the_changeover():
    aspects = np.linspace(1.5, 3.5, 81)
    runouts = [granular_column.runout_law(a, 2) for a in aspects]
    assert np.all(np.diff(runouts) > 0)
    assert np.all(np.diff(runouts) < 0.1)


def principal_stresses(p, q, dimension):
    """Return the largest and smallest compression in plane strain or triaxial compression."""
    if dimension == 2:
        return p + q / np.sqrt(3), p - q / np.sqrt(3)
    return p + 2 * q / 3, p - q / 3


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("angle", [22.0, 30.0])
def test_sheared_snow_reaches_coulombs_friction(dimension, angle):
    """The core's return mapping gives sin phi in shear at constant volume."""
    slope = granular_column.critical_state_slope(angle, dimension)
    law = CamClay(1e5, 0.3, slope, 0.0, collapse.HARDENING, dimension)
    p, q, ev = 300.0, 0.0, law.initial_plastic_strain(20.0)
    for _ in range(3000):
        p, q, ev = law.return_map(p, q + 3 * law.shear * 1e-5, ev)
    largest, smallest = principal_stresses(p, q, dimension)
    assert (largest - smallest) / (largest + smallest) == pytest.approx(
        np.sin(np.radians(angle)), rel=1e-3
    )


def test_the_snow_has_negligible_strength():
    scene = collapse.column_scene({"dimension": 2, "dx": 0.01, "friction_angle": 30.0}, 2.0)
    snow = scene.resolve().data["snow"]
    weight = snow["density"] * 9.81 * 2.0 * collapse.RADIUS
    assert snow["cohesion"] == 0
    assert snow["preconsolidation_pressure"] < 0.05 * weight
    assert weight / snow["youngs_modulus"] < 0.01


def test_front_of_a_plane_deposit_is_the_mean_of_both_sides():
    x = np.linspace(-0.2, 0.4, 61)
    deposit = np.column_stack([x, 0 * x, 0 * x])
    assert granular_column.front(deposit) == pytest.approx(0.3)


def test_front_of_a_round_deposit_is_its_radius():
    random = np.random.default_rng(1)
    radius, angle = 0.3 * np.sqrt(random.uniform(0, 1, 50_000)), random.uniform(-4, 4, 50_000)
    deposit = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), 0 * radius])
    assert granular_column.front(deposit) == pytest.approx(0.3, rel=0.002)


@pytest.mark.parametrize("settings", CASE.matrix(True) + CASE.matrix(False), ids=str)
def test_every_entry_makes_a_scene(settings):
    aspect = 4.0 if settings["aspect"] == "tall" else settings["aspect"]
    data = collapse.column_scene(settings, aspect).resolve().data
    assert data["numerics"]["dx"] == settings["dx"]
    assert data["snow"]["critical_state_slope"] > 0.5


def test_an_unknown_setting_is_an_error():
    with pytest.raises(InputError, match="viscosity"):
        collapse.column_scene({"dimension": 2, "dx": 0.01, "viscosity": 1.0}, 1.0)


@pytest.fixture(scope="module")
def deposits():
    settings = {"dimension": 2, "dx": 0.02, "friction_angle": 30.0}
    return {aspect: collapse.collapse(settings, aspect) for aspect in (0.5, 1.0, 3.0)}


def test_taller_columns_run_farther_and_stay_higher(deposits):
    assert {deposit.ended for deposit in deposits.values()} == {"rest"}
    runouts = [deposit.runout for deposit in deposits.values()]
    heights = [deposit.height for deposit in deposits.values()]
    assert runouts == sorted(runouts)
    assert heights == sorted(heights)
    assert deposits[0.5].height == pytest.approx(0.5, abs=0.03)  # the middle never moves


@pytest.mark.parametrize("dimension", [2, 3])
def test_measure_compares_with_the_laws(dimension):
    settings = {"dimension": dimension, "dx": 0.02, "aspect": 1.0, "friction_angle": 30.0}
    outcome = CASE.measure(settings)
    runout, height = outcome.measured
    assert (runout.quantity, height.quantity) == ("runout", "height")
    assert runout.exact == granular_column.runout_law(1.0, dimension)
    for result in outcome.measured:
        assert result.error == pytest.approx(result.value / result.exact - 1)
    # This is the run-out of the method with five cells per radius; see the remarks.
    assert runout.error == pytest.approx({2: -0.30, 3: -0.51}[dimension], abs=0.06)
    assert height.error == pytest.approx(-0.15, abs=0.04)
    assert outcome.updates == outcome.steps * outcome.particles
    assert outcome.wall_s > 0


def test_glass_beads_have_their_own_law():
    settings = {"dimension": 2, "dx": 0.025, "aspect": 1.0, "friction_angle": 22.0}
    assert [result.quantity for result in CASE.measure(settings).measured] == ["runout_glass"]


def test_the_exponent_of_a_power_law_is_recovered(monkeypatch):
    def power(settings, aspect):
        return collapse.Deposit(3 * aspect**0.6, 1.0, "rest", 1.0, 100, 10, 10)

    monkeypatch.setattr(collapse, "collapse", power)
    outcome = CASE.measure({"dimension": 2, "dx": 0.02, "aspect": "tall", "friction_angle": 30.0})
    (exponent,) = outcome.measured
    assert exponent.value == pytest.approx(0.6)
    assert exponent.error == pytest.approx(0.6 / (2 / 3) - 1)
    assert outcome.wall_s == len(collapse.TALL_ASPECTS[2])
