"""Hand calculations and rules of standards: their numbers, inputs and limits."""

import math

import numpy as np
import pytest

from snowshed import InputError
from snowshed.analysis.loads import RuleInputs, distance_passed_by, landing, rules
from snowshed.analysis.loads.free_flight import edge_speed
from snowshed.analysis.loads.peak_errors import LOADS, grid_dependence


def test_flight_obeys_the_equations_of_motion():
    tilt, friction, height, ground = 50.0, 0.2, 2.5, 15.0
    flight = landing(3.0, tilt, friction, height, ground_tilt=ground)
    angle = math.radians(tilt)
    exact = math.sqrt(2 * 9.81 * 3.0 * (math.sin(angle) - friction * math.cos(angle)))
    assert flight.edge_speed == pytest.approx(exact)
    fall = exact * math.sin(angle) * flight.time + 9.81 * flight.time**2 / 2
    assert fall == pytest.approx(height + flight.distance * math.tan(math.radians(ground)))
    energy = exact**2 / 2 + 9.81 * fall
    assert flight.speed**2 / 2 == pytest.approx(energy)
    assert math.cos(math.radians(flight.angle)) * flight.speed == pytest.approx(
        exact * math.cos(angle)
    )


def test_snow_that_friction_holds_has_no_speed_and_falls_straight_down():
    assert edge_speed(3.0, 20.0, 0.5) == 0.0
    flight = landing(3.0, 20.0, 0.5, 2.0)
    assert (flight.distance, flight.angle) == (0.0, 90.0)
    assert flight.speed == pytest.approx(math.sqrt(2 * 9.81 * 2.0))


def test_negative_lengths_are_refused():
    with pytest.raises(InputError, match="below 0"):
        landing(-1.0, 40.0, 0.2, 2.0)


def test_shares_beyond_a_distance_count_mass():
    distances, masses = np.array([1.0, 5.0, 2.0]), np.array([8.0, 1.0, 1.0])
    assert distance_passed_by(0.1, distances, masses) == 5.0
    assert distance_passed_by(0.2, distances, masses) == 2.0
    assert distance_passed_by(0.5, distances, masses) == 1.0


def test_rules_have_their_numbers():
    inputs = RuleInputs(snow_load=4.0, snow_depth=1.5, snow_density=400.0, creep_factor=0.8,
                        glide_factor=2.0, efficiency=3.0)  # fmt: skip
    sliding, overhang, guard, creep, post = rules(5.0, 60.0, inputs)
    assert sliding.value == pytest.approx(0.4 * 4.0 * 2.5)
    assert overhang.value == pytest.approx(2.0 * 16.0 / 3.0)  # k = 3/d = 2 is below d gamma = 4.5
    assert guard.value == pytest.approx(4.0 * 2.5 * math.sin(math.radians(60.0)))
    assert creep.value == pytest.approx(0.4 * 9.81 * 1.5**2 / 2 * 0.8 * 2.0)
    assert post.value == pytest.approx(3.0 * creep.value)
    assert all(rule.clause and rule.limits and rule.source for rule in (sliding, creep, post))


def test_thin_snow_limits_the_overhang():
    overhang = rules(5.0, 60.0, RuleInputs(snow_load=2.0, snow_depth=0.5))[1]
    assert overhang.value == pytest.approx(0.5 * 3.0 * 4.0 / 3.0)  # k = d gamma


def test_rules_without_inputs_have_no_value_and_name_the_options():
    for rule in rules(5.0, 60.0, RuleInputs()):
        assert rule.value is None and rule.missing
    missing = rules(5.0, 60.0, RuleInputs())[3].missing
    assert missing == ["`snow_density=`", "`snow_depth=`", "`creep_factor=`", "`glide_factor=`"]


@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), 1e9])
def test_impossible_inputs_are_refused(value):
    with pytest.raises(InputError, match="snow_load"):
        RuleInputs(snow_load=value)


def test_recorded_dependence_covers_both_schemes():
    for scheme in ("thesis", "objective"):
        dependence = grid_dependence(scheme)
        assert len(dependence) == 4 and all(
            set(of_case) == set(LOADS) for of_case in dependence.values()
        )
        assert dependence["lab50 on ground"]["rest_n"] == 0.0  # the weight
        assert max(of_case["peak_10ms_n"] for of_case in dependence.values()) < 0.25
