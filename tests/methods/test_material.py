"""The binding of the return mapping; C++ tests compare it with an independent integration."""

import numpy as np
import pytest

from snowshed import Snow
from snowshed._core import CamClay

SNOW = Snow.preset("calibrated")
P0 = SNOW.preconsolidation_pressure


@pytest.fixture
def law() -> CamClay:
    return CamClay(
        SNOW.youngs_modulus,
        SNOW.poissons_ratio,
        SNOW.critical_state_slope,
        SNOW.cohesion,
        SNOW.hardening_factor,
        3,
    )


def test_moduli_follow_from_youngs_modulus_and_poissons_ratio(law):
    assert law.bulk == pytest.approx(1e6 / (3 * 0.4))
    assert law.shear == pytest.approx(1e6 / 2.6)


def test_initial_strain_gives_the_initial_strength(law):
    ev = law.initial_plastic_strain(P0)
    assert ev == pytest.approx(-0.084, abs=5e-4)  # as the thesis states
    assert law.preconsolidation(ev) == pytest.approx(P0)
    assert law.preconsolidation(0.1) == 0


def test_elastic_states_are_unchanged(law):
    ev = law.initial_plastic_strain(P0)
    assert law.yield_function(0.5 * P0, 0.0, P0) < 0
    assert law.return_map(0.5 * P0, 0.0, ev) == (0.5 * P0, 0.0, ev)


# The surface spans p from -0.2 p0 to p0, that is -1.4 to 7 kPa, and q up to 1.8 kPa.
@pytest.mark.parametrize(
    ("p", "q"),
    [(p, q) for p in (-1e5, -2e3, 1e4, 1e6) for q in (0.0, 2e3, 1e5)]
    + [(p, q) for p in (0.0, 0.4 * P0) for q in (2e3, 1e5)],
)
def test_states_outside_return_to_the_yield_surface(law, p, q):
    ev = law.initial_plastic_strain(P0)
    assert law.yield_function(p, q, P0) > 0
    p1, q1, ev1 = law.return_map(p, q, ev)
    p0 = law.preconsolidation(ev1)
    scale = max(law.preconsolidation(ev), p0) ** 2
    assert abs(law.yield_function(p1, q1, p0)) < 1e-6 * scale
    assert 0 <= q1 <= q
    assert np.sign(ev - ev1) in (0, np.sign(p - 0.4 * P0))  # compacts right of the centre
