"""Columns under their own weight: references compared with integrals, and coarse columns."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from validation.settlement import case as settlement
from validation.settlement.case import CASES, ELASTIC, ElasticColumn, YieldingColumn

WEIGHT = settlement.DENSITY * settlement.GRAVITY
COLUMNS = {"elastic": ElasticColumn, "yielding": YieldingColumn}
COARSE = {**settlement.REGULAR_SETTINGS, "dx": 0.04}


def measured(outcome):
    return {result.quantity: result for result in outcome.measured}


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_elastic_column_is_in_equilibrium(dimension):
    column, depth = ElasticColumn(dimension), np.linspace(0, 0.4, 9)
    x = column.compression(depth)
    assert column.modulus * x * np.exp(x) == pytest.approx(WEIGHT * depth)


@pytest.mark.parametrize("kind", COLUMNS)
def test_settlement_is_the_integral_of_the_shortening(kind):
    """Integration down the column, with each layer's strain by the law from its pressure."""
    column = COLUMNS[kind](2)
    slope = np.gradient(column.settlement(np.linspace(0.0, 0.4, 2001)), 0.4 / 2000)[20:-20]
    depth = np.linspace(0.0, 0.4, 2001)[20:-20]
    if kind == "elastic":
        assert slope == pytest.approx(1 - np.exp(-column.compression(depth)), rel=1e-4)
        total, _ = quad(lambda h: 1 - np.exp(-float(column.compression(np.array(h)))), 0, 0.4)
        assert float(column.settlement(np.array(0.4))) == pytest.approx(total)
    else:
        assert np.all(np.diff(slope) > -1e-6)  # deeper layers are compressed more


def test_a_column_that_never_yields_equals_the_elastic_column(monkeypatch):
    monkeypatch.setattr(settlement, "STRENGTH", 1e6)
    elastic, yielding = ElasticColumn(2), YieldingColumn(2)
    depth = np.linspace(0.0, 0.4, 9)
    assert yielding.pressure(depth) == pytest.approx(elastic.pressure(depth), rel=1e-5)
    assert yielding.settlement(depth) == pytest.approx(elastic.settlement(depth), rel=1e-4)


def test_the_yielding_column_is_in_equilibrium():
    """Integration down the column with the rate equations, driven by the load, not the strain."""
    column = YieldingColumn(2)
    law = ElasticColumn(2).law
    down = np.array([0.0, -1.0])

    def rates(_, state):
        """Return the rates of strain and settlement over depth; plastic if on the yield surface."""
        *material, x, _ = state
        material = np.array(material)
        flows = law.yield_function(material) >= -1e-6
        rate = law._rates(material, down) if flows else np.append(down, 0.0)
        stress = -law.stress(material)[-1]
        stiffer = -(law.stiffness @ rate[:-1])[-1]
        # d(stress e^x) = weight d(depth)
        per_depth = WEIGHT / ((stiffer + stress) * np.exp(x))
        return np.array([*(rate * per_depth), per_depth, 1 - np.exp(-x)])

    yields = np.interp(0.0, *_overshoot(law, down))
    start = law.initial_state(settlement.STRENGTH) + np.append(down * yields, 0.0)
    depth = law.stiffness[0, 0] * yields * np.exp(yields) / WEIGHT
    settlement_at_yield = float(ElasticColumn(2).settlement(np.array(depth)))
    solution = solve_ivp(
        rates, (depth, 0.4), [*start, yields, settlement_at_yield], rtol=1e-9, atol=1e-12
    )
    p, _ = law.invariants(solution.y[:3, -1])
    assert float(column.pressure(np.array(0.4))) == pytest.approx(float(p), rel=1e-4)
    assert float(column.settlement(np.array(0.4))) == pytest.approx(solution.y[-1, -1], rel=1e-4)


def _overshoot(law, down):
    """Return y along the elastic path, and the strain, for interpolation to y = 0."""
    x = np.linspace(0.001, 0.02, 20001)
    start = law.initial_state(settlement.STRENGTH)
    return [law.yield_function(start + np.append(down * strain, 0.0)) for strain in x], x


def test_depths_beyond_the_table_are_refused():
    with pytest.raises(ValueError, match="tabulated"):
        YieldingColumn(2, deepest=50.0).pressure(np.array(1.0))


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_every_entry_makes_a_scene_and_occurs_once(case):
    for full in (False, True):
        entries = case.matrix(full)
        assert len({tuple(sorted(entry.items())) for entry in entries}) == len(entries)
        for settings in entries:
            data = settlement.column_scene(settings).resolve().data
            assert data["seeding"]["pattern"] == settings["pattern"]
            assert data["snow"]["youngs_modulus"] == settlement.YOUNGS_MODULUS
    for quantity in case.quantities:
        assert any(quantity.limit_for.items() <= entry.items() for entry in case.matrix(True))


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_column_stands_between_its_walls(dimension):
    settings = {**COARSE, "dimension": dimension, "particles_per_voxel": 8, "floor_offset": 0.5}
    drive = settlement.TimedEventDriver(settlement.column_scene(settings))
    low, high = drive.core.positions().min(axis=0), drive.core.positions().max(axis=0)
    assert 0.02 < low[2] < 0.04
    assert 0.40 < high[2] < 0.42
    assert low[0] > 0
    assert (high[1] > 0) == (dimension == 3)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_finer_columns_settle_more_accurately(case):
    results = [measured(case.measure({**COARSE, "dx": dx})) for dx in (0.04, 0.02)]
    errors = [result["settlement"].error for result in results]
    assert 0.02 < errors[1] < errors[0] < 0.1
    assert all(result["pressure"].error < 0.01 for result in results)
    assert set(results[0]) == {quantity.name for quantity in case.quantities}


def test_the_column_rests_when_it_is_measured():
    drive = settlement.TimedEventDriver(settlement.column_scene({**COARSE, "model": "elastic"}))
    settlement.settle(drive, periods=4)
    assert np.abs(drive.core.velocities()).max() < 1e-4
    weight = drive.masses.sum() * settlement.GRAVITY
    settled = drive.core.positions()[:, 2].mean()
    settlement.settle(drive, periods=6)
    assert drive.core.positions()[:, 2].mean() == pytest.approx(settled, abs=1e-7)
    assert weight == pytest.approx(WEIGHT * 0.4 * 0.32)


def test_stiffer_snow_settles_less(monkeypatch):
    soft = measured(ELASTIC.measure(COARSE))["settlement"].value
    monkeypatch.setattr(settlement, "YOUNGS_MODULUS", 2 * settlement.YOUNGS_MODULUS)
    assert measured(ELASTIC.measure(COARSE))["settlement"].value == pytest.approx(
        soft / 2, rel=0.03
    )
