"""States of snow at a point, compared with the rate equations and with elasticity."""

import numpy as np
import pandas as pd
import pytest
from validation.material_paths.rate_equations import RateEquations

from snowshed import InputError, Snow
from snowshed.plot import point_figure, save_figure
from snowshed.snow import follow_path

SNOW = Snow.preset("calibrated")
CONSTANTS = (1e6, 0.3, 0.5, 0.2, 0.1)


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("ends", [(-0.02, -0.01, -0.01), (-0.02, 0.01, 0.01), (0.004, -0.01, 0.0)])
def test_a_straight_path_of_strain_follows_the_rate_equations(dimension, ends):
    rate = np.array(ends[:dimension])
    snow = RateEquations(*CONSTANTS, dimension=dimension)
    exact = snow.integrate(snow.initial_state(7e3), rate, np.array([0.5, 1.0]))
    path = {f"strain_{k + 1}": [rate[k]] for k in range(dimension)}
    table = follow_path(SNOW, path, dimension=dimension, steps=4000)
    columns = [f"stress_{k + 1}" for k in range(dimension)]
    assert np.allclose(table[columns].iloc[-1], snow.stress(exact)[-1], rtol=2e-3, atol=5.0)
    assert table.plastic_strain.iloc[-1] == pytest.approx(exact[-1, -1], rel=2e-3)


def test_uniaxial_stress_is_elastic_below_the_strength():
    table = follow_path(SNOW, {"stress_1": [-1000.0], "stress_2": [0.0], "stress_3": [0.0]})
    assert table.strain_1.iloc[-1] == pytest.approx(-1e-3, rel=1e-6)
    assert table.strain_2.iloc[-1] == pytest.approx(0.3e-3, rel=1e-6)


def test_a_confined_test_keeps_its_lateral_stress():
    path = {"strain_1": [0.0, -0.02], "stress_2": [-2000.0] * 2, "stress_3": [-2000.0] * 2}
    table = follow_path(SNOW, path, steps=200)
    assert table.stress_2.iloc[-1] == pytest.approx(-2000.0, abs=0.1)
    assert table.strain_2.iloc[-1] > 0
    # on the yield surface (1.2.6)
    p, q, p0 = table.iloc[-1][["pressure", "mises", "preconsolidation_pressure"]]
    assert 1.4 * q**2 + 0.25 * (p + 0.2 * p0) * (p - p0) == pytest.approx(0, abs=1e-3 * p0**2)


def test_a_stress_beyond_the_strength_is_refused_with_its_place():
    with pytest.raises(InputError, match=r"path: row 1, increment \d+: the snow cannot bear"):
        follow_path(SNOW, {"stress_1": [5e3], "stress_2": [0.0], "stress_3": [0.0]})


@pytest.mark.parametrize("stress", [-5e4, -5e5, -5e6, -1e8, -1e300, 5e6])
@pytest.mark.parametrize("steps", [1, 100])
def test_stresses_of_any_size_have_a_finite_state_or_are_refused(stress, steps):
    path = {"stress_1": [stress], "stress_2": [0.0], "stress_3": [0.0]}
    with pytest.raises(InputError, match=r"path: row 1, increment \d+: the snow cannot bear"):
        follow_path(SNOW, path, steps=steps)


def test_a_state_that_is_not_finite_is_refused():
    strains = {f"strain_{k}": [-0.01] for k in (1, 2, 3)}
    with pytest.raises(InputError, match="path: row 1, increment 1: the state is not finite"):
        follow_path(SNOW, strains, law=lambda p, q, plastic: (float("nan"), q, plastic))


def test_a_law_of_ones_own_takes_the_place():
    elastic = follow_path(
        SNOW, pd.DataFrame({"strain_1": [-0.05], "strain_2": [0.0]}), dimension=2,
        law=lambda p, q, plastic: (p, q, plastic),
    )  # fmt: skip
    slope = 1e6 * 0.7 / (1.3 * 0.4)  # plane strain
    assert elastic.stress_1.iloc[-1] == pytest.approx(-0.05 * slope)


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ({"strain_1": [0.1]}, "strain_2 and stress_2"),
        ({"strain_1": [0.1], "stress_1": [0], "strain_2": [0], "strain_3": [0]}, "strain_1 and"),
        ({"strain_1": [0.1], "strain_2": [0], "strain_3": [0], "e": [0]}, "unknown columns e"),
        ({"strain_1": [0.1, 0], "strain_2": [0], "strain_3": [0]}, "different lengths"),
        ({"strain_1": [float("nan")], "strain_2": [0], "strain_3": [0]}, "not finite"),
    ],
)
def test_wrong_paths_are_refused(path, message):
    with pytest.raises(InputError, match=message):
        follow_path(SNOW, path)


def test_the_picture_is_drawn(tmp_path):
    table = follow_path(SNOW, {"strain_1": [-0.02], "strain_2": [0.0], "strain_3": [0.0]})
    save_figure(point_figure(table, SNOW), tmp_path / "point.png")
    assert (tmp_path / "point.png").stat().st_size > 10_000
