"""Material paths: rate equations against closed forms, and the core against the rate equations."""

import numpy as np
import pytest
from scipy.optimize import brentq
from validation.material_paths import case as material_paths
from validation.material_paths.case import CASES, StrainPath
from validation.material_paths.rate_equations import RateEquations, evenly

from snowshed._core import CamClay

CONSTANTS, STRENGTH = material_paths.calibrated_snow()


def equations(dimension=3, **changes):
    return RateEquations(**{**CONSTANTS._asdict(), **changes}, dimension=dimension)


def measured(outcome):
    return {result.quantity: result for result in outcome.measured}


# --- the rate equations -----------------------------------------------------------------------


@pytest.mark.parametrize("dimension", [2, 3])
def test_elastic_constants_agree_with_the_core(dimension):
    law, core = equations(dimension), CamClay(*CONSTANTS, dimension)
    assert law.shear_modulus == pytest.approx(core.shear)
    assert law.stiffness.mean() == pytest.approx(core.bulk)
    assert law.strength(-0.05) == pytest.approx(core.preconsolidation(-0.05))
    assert law.initial_state(STRENGTH)[-1] == pytest.approx(core.initial_plastic_strain(STRENGTH))


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("sense", [-1, 1])
def test_isotropic_paths_satisfy_the_volume_balance(dimension, sense):
    law = equations(dimension)
    bulk, start, strain = law.stiffness.mean(), law.initial_state(STRENGTH), sense * 0.05

    def surplus(ev):
        p = law.strength(ev) if sense < 0 else -law.cohesion * law.strength(ev)
        return -p / bulk + ev - start[-1] - strain

    ev = brentq(surplus, start[-1] - 0.1, -1e-9, xtol=1e-15)
    rate = np.full(dimension, sense / dimension)
    state = law.integrate(start, rate, np.array([abs(strain)]))[0]
    assert state[-1] == pytest.approx(ev, rel=1e-9)


@pytest.mark.parametrize("lateral", [0.0, -0.5, 0.3])
@pytest.mark.parametrize("sense", [-1, 1])
def test_yielding_states_stay_on_the_ellipse_and_balance_volume(lateral, sense):
    law = equations()
    rate = sense * np.array([1.0, lateral, lateral])
    times = evenly(0.05, 10)
    start = law.initial_state(STRENGTH)
    states = law.integrate(start, rate, times)
    for state in states:
        size = law.critical_state_slope**2 * law.strength(state[-1]) ** 2
        assert abs(law.yield_function(state)) < 1e-7 * size
    added = states.sum(axis=1) - start.sum()
    assert np.allclose(added, times * rate.sum(), atol=1e-12)


def test_plastic_work_is_never_negative():
    law = equations()
    rate = np.array([-1.0, 0.2, 0.4])
    times = evenly(0.05, 400)
    states = np.vstack(
        [law.initial_state(STRENGTH), law.integrate(law.initial_state(STRENGTH), rate, times)]
    )
    plastic = np.diff(times, prepend=0.0)[:, np.newaxis] * rate - np.diff(states[:, :-1], axis=0)
    stress = law.stress(states)
    work = np.sum(plastic * (stress[1:] + stress[:-1]) / 2, axis=1)
    assert work.min() > -1e-9 * work.max()
    assert work.max() > 0


def test_elastic_paths_are_straight():
    law = equations()
    start = law.initial_state(STRENGTH, 0.4 * STRENGTH)
    states = law.integrate(start, np.array([-1.0, 0.5, 0.5]), np.array([1e-4, 2e-4]))
    p, q = law.invariants(states)
    assert np.allclose(p, 0.4 * STRENGTH)
    assert q.tolist() == pytest.approx([3e-4 * law.shear_modulus, 6e-4 * law.shear_modulus])
    assert np.all(states[:, -1] == start[-1])


def test_fully_softened_snow_opens_without_stress():
    law = equations()
    start = law.initial_state(STRENGTH)
    states = law.integrate(start, np.array([1.0, 0.0, 0.0]), np.array([0.09, 0.1]))
    assert np.all(states[:, :-1] == 0)
    assert states[:, -1] == pytest.approx(start[-1] + np.array([0.09, 0.1]))


def test_vanishing_strength_is_an_error():
    law = equations()
    start = law.initial_state(STRENGTH)
    with pytest.raises(ArithmeticError, match="strength"):
        law.integrate(start, np.array([1.0, 0.0, 0.0]), np.array([-start[-1]]))


# --- the cases --------------------------------------------------------------------------------


def test_without_cohesion_the_critical_state_is_on_q_equal_m_p(monkeypatch):
    loose = CONSTANTS._replace(cohesion=0.0)
    monkeypatch.setattr(material_paths, "calibrated_snow", lambda: (loose, STRENGTH))
    p, q = material_paths.critical_state(0.8)
    assert q == pytest.approx(loose.critical_state_slope * p)
    states, _ = StrainPath(-0.16, lateral=-0.5, pressure=0.8).mapped(1e-4)
    assert states[-1, :2] == pytest.approx([p, q], rel=1e-6)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
@pytest.mark.parametrize("full", [False, True])
def test_matrices_list_no_entry_twice_and_reach_the_limits(case, full):
    entries = case.matrix(full)
    assert len({tuple(sorted(entry.items())) for entry in entries}) == len(entries)
    for quantity in case.quantities if full else ():
        assert any(quantity.limit_for.items() <= entry.items() for entry in entries)


@pytest.mark.parametrize("case", CASES[1:], ids=lambda case: case.name)
def test_errors_fall_with_the_increment(case):
    settings = {**case.matrix(True)[0], "method": "backward Euler"}
    errors = [
        measured(case.measure({**settings, "increment": increment}))["stress"].error
        for increment in (1e-4, 1e-5)
    ]
    assert errors[0] / errors[1] == pytest.approx(10, rel=0.1)
    assert errors[1] < 3e-4


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_entries_measure_the_quantities_of_their_case(case):
    names = {quantity.name for quantity in case.quantities}
    measured_names = set()
    for method in ("backward Euler", "extrapolated"):
        settings = {**case.matrix(True)[-1], "method": method, "increment": 1e-4}
        outcome = case.measure(settings)
        measured_names |= set(measured(outcome))
        assert outcome.updates > 0
        assert outcome.wall_s > 0
    assert names <= measured_names


def test_another_law_is_detected(monkeypatch):
    """A core with a slightly different slope exceeds the limit, even with small steps."""
    changed = CONSTANTS._replace(critical_state_slope=CONSTANTS.critical_state_slope * 1.0001)
    reference = StrainPath(-0.06, lateral=0.0).reference()
    monkeypatch.setattr(material_paths, "calibrated_snow", lambda: (changed, STRENGTH))
    monkeypatch.setattr(StrainPath, "reference", lambda self: reference)
    settings = {"dimension": 3, "increment": 1e-5, "method": "extrapolated"}
    error = measured(material_paths.measure_oedometer(settings))["extrapolated_stress"].error
    assert error > 10 * material_paths.MAX_DEVIATION


def test_the_opening_of_softened_snow_is_exact():
    settings = {"dimension": 3, "increment": 1e-4, "method": "backward Euler"}
    opening = measured(material_paths.measure_tension(settings))["opening"]
    assert opening.value > 0
    assert abs(opening.error) < 1e-9
