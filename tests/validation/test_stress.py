"""Runs of the stress suite, their balances, and the verdicts on them."""

import math
from typing import Any, cast

import numpy as np
import pandas as pd
import pytest
from validation.stress import run_trials, summarise
from validation.stress.conservation import Conservation
from validation.stress.design import Trial, trials
from validation.stress.judge import GAIN_BOUND, judge
from validation.stress.scenes import build
from validation.stress.solve import solve
from validation.stress.space import reference

from snowshed import _core

TERMS = ("kinetic", "gravitational", "elastic", "plastic", "friction", "sticking", "impact")


class Ledger:
    """Stand-in for a simulation, with energies and two particles."""

    def __init__(self) -> None:
        self.values = {f"{name}_j": 0.0 for name in (*TERMS, "transfer", "sleep", "damping")}
        self.velocity = np.zeros((2, 3))

    def energy(self) -> dict[str, float]:
        return dict(self.values)

    def masses(self) -> Any:
        return np.array([1.0, 3.0])

    def velocities(self) -> Any:
        return self.velocity


def balances_of(ledger: Ledger, **laid: float) -> Conservation:
    balances = Conservation(cast(_core.Simulation, ledger), gravity=10.0, dx=0.1)
    before = ledger.energy()
    ledger.values.update(laid)
    balances.begin(before)
    return balances


def test_balances_are_relative_to_the_input() -> None:
    ledger = Ledger()
    balances = balances_of(ledger, kinetic_j=20.0, gravitational_j=100.0)
    ledger.values.update(
        kinetic_j=15.0, gravitational_j=70.0, plastic_j=30.0, transfer_j=3.0, sleep_j=1.0
    )
    balances.sample()  # input 50 J; 15 J stored, 34 J dissipated: 1 J is missing
    errors = balances.energy_errors()
    assert errors["energy_error"] == pytest.approx(1 / 50)
    assert errors["energy_gain"] == 0
    assert errors["stored_excess"] == pytest.approx((15 - 50) / 50)
    ledger.values.update(kinetic_j=40.0, elastic_j=12.0)  # 2 J more than the input
    balances.sample()
    errors = balances.energy_errors()
    assert errors["stored_excess"] == errors["final_excess"] == pytest.approx(2 / 50)
    assert errors["energy_gain"] == pytest.approx((2 + 34) / 50)


def test_balances_of_a_second_event_include_its_input() -> None:
    ledger = Ledger()
    balances = balances_of(ledger, kinetic_j=20.0, gravitational_j=100.0)
    ledger.values.update(kinetic_j=0.0, gravitational_j=90.0, sticking_j=30.0)
    balances.sample()
    before = ledger.energy()
    ledger.values.update(kinetic_j=5.0, gravitational_j=150.0)
    balances.begin(before)
    balances.sample()
    assert balances.energy_errors()["energy_error"] == pytest.approx(0.0, abs=1e-15)


def test_the_momentum_is_compared_with_free_flight() -> None:
    ledger = Ledger()
    ledger.velocity = np.array([[1.0, 0, 0], [0, 0, 2.0]])
    balances = balances_of(ledger)
    ledger.velocity = np.array([[1.0, 0, -5.0], [0, 0, -3.0]])  # 0.5 s later
    assert balances.momentum_error(0.5) == pytest.approx(0.0, abs=1e-15)
    ledger.velocity[0, 0] = 1.5
    assert balances.momentum_error(0.5) == pytest.approx(0.5 / (1 + 6 + 20))


VALID: dict[str, Any] = {
    "ended": "rest",
    "message": "",
    "precision": "float",
    "steps": 100,
    "finite": True,
    "checkpoint": True,
    "mass_error": 0.0,
    "momentum_error": math.nan,
    "energy_error": 0.01,
    "stored_excess": -0.2,
    "final_excess": -0.3,
}


@pytest.mark.parametrize(
    ("change", "outcome"),
    [
        ({}, "rest"),
        ({"ended": "crashed", "message": "exit code -11"}, "failed"),
        ({"ended": "stopped", "message": "particle 3 at (0, 1) m: too much"}, "stopped"),
        ({"ended": "stopped", "message": "it went wrong"}, "failed"),
        ({"ended": "stopped", "message": "particle 3: so", "checkpoint": False}, "failed"),
        ({"finite": False}, "failed"),
        ({"mass_error": 1e-6}, "failed"),
        ({"momentum_error": 1e-3}, "failed"),
        ({"final_excess": 2 * GAIN_BOUND}, "failed"),
        ({"energy_error": math.inf}, "failed"),
    ],
)
def test_verdicts_on_records(change: dict[str, Any], outcome: str) -> None:
    verdict, reason = judge({**VALID, **change})
    assert verdict == outcome
    assert bool(reason) == (outcome == "failed")


def test_bad_input_is_refused_without_measures() -> None:
    record = {"ended": "refused", "message": "/panel/tilt: 95 is outside the allowed range"}
    assert judge(record) == ("refused", "")


def test_the_balance_of_free_fall_has_the_error_of_symplectic_euler() -> None:
    """A block in free fall has only one error: it falls too far by g t dt/2."""
    point = {**reference(), "kind": "throw", "speed": 0.1, "precision": "double"}
    scene = build(point, max_time=0.005)
    assert scene.events is not None
    scene.events.count = 1
    simulation = _core.Simulation(scene.resolve().json)
    balances = Conservation(simulation, gravity=9.81, dx=0.02)
    before = simulation.energy()
    simulation.begin_event()
    balances.begin(before)
    simulation.run(lambda report: True)
    balances.sample()
    time, dt = simulation.time_s, simulation.time_step_s
    assert balances.momentum_error(time) < 1e-12
    input_energy = 0.5 * 0.1**2 + 9.81 * (0.08 * time + 0.5 * 9.81 * time**2)
    excess_fall = 0.5 * 9.81 * time * dt
    expected = 9.81 * excess_fall / input_energy
    assert balances.energy_errors()["energy_error"] == pytest.approx(expected, rel=0.05)


@pytest.fixture(scope="module")
def sample_runs() -> pd.DataFrame:
    quick = trials(full=False)
    return run_trials([Trial(t.design, t.varied, t.point, 100) for t in quick[::4]])


def test_no_run_of_a_sample_fails(sample_runs: pd.DataFrame) -> None:
    failed = sample_runs[sample_runs.outcome == "failed"]
    assert failed.empty, failed.reason.tolist()
    assert set(sample_runs.design) == {"reference", "single", "pairwise", "random"}


def test_tables_count_every_run_once(sample_runs: pd.DataFrame) -> None:
    tables = {table.name: table for table in summarise(sample_runs)}
    assert tables["outcomes"].frame["all"].sum() == len(sample_runs)
    stopped = sample_runs.outcome.isin(["refused", "stopped"]).sum()
    assert tables["errors"].frame["runs"].sum() == stopped
    assert tables["cost"].frame["runs"].sum() == len(sample_runs) - stopped
    assert tables["savings"].frame["runs"].sum() == len(sample_runs) - stopped
    assert tables["failures"].frame.empty
    assert all(table.title and table.remark for table in tables.values())


def test_snow_comes_to_rest() -> None:
    """Soft snow, which needs few steps, falls from a small height."""
    point = {**reference(), "kind": "throw", "youngs_modulus": 1e4, "cells": 1, "thickness": 0.1}
    record = solve(point, steps=5000)
    assert record["ended"] == "rest"
    assert judge({**point, **record}) == ("rest", "")


def test_an_extremely_compressed_particle_is_named() -> None:
    """Nothing stops elastic snow of 10 kPa at Mach 15."""
    point = {**reference(), "kind": "collide", "model": "elastic", "youngs_modulus": 1e4}
    record = solve({**point, "density": 917.0, "speed": 100.0, "transfer": "apic"}, steps=500)
    assert record["ended"] == "stopped"
    assert record["message"].startswith("particle ")
    assert record["finite"] and record["checkpoint"]
