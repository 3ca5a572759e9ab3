"""The laboratory's mean stack of four seedings, compared with a record of 24 other seedings."""

import json

import numpy as np
import pytest
from tests.running import laboratory


@pytest.fixture(scope="module")
def recorded():
    return json.loads(laboratory.FILE.read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def stacks():
    return laboratory.stacks(range(1, 5))


def test_the_record_states_its_origin(recorded):
    assert recorded["about"] == laboratory.ABOUT
    assert recorded["settings"] == laboratory.SETTINGS
    assert recorded["seeds"] == [laboratory.SEEDS.start, laboratory.SEEDS.stop - 1]
    assert {"version", "date"} <= set(recorded)


@pytest.mark.parametrize("event", [1, 2, 3, 4])
@pytest.mark.parametrize("name", laboratory.MEASURES)
def test_mean_stacks_stay_within_the_noise_of_seeding(stacks, recorded, name, event):
    """The tolerance is three standard errors of the difference of both means."""
    values = stacks[name][:, event - 1]
    mean, deviation = (recorded[key][name][event - 1] for key in ("mean", "deviation"))
    error = deviation * np.sqrt(1 / len(values) + 1 / len(laboratory.SEEDS))
    assert abs(values.mean() - mean) < 3 * error


@pytest.mark.parametrize("name", laboratory.MEASURES)
def test_the_record_agrees_with_an_independent_program(recorded, name):
    """Compare with stacks of an independent program, and with their noise of 2 to 6 %."""
    expected = {"height": [0.045, 0.072, 0.097, 0.122], "length": [0.22, 0.31, 0.33, 0.38]}[name]
    assert recorded["mean"][name] == pytest.approx(expected, rel=0.2)
    noise = np.array(recorded["deviation"][name]) / recorded["mean"][name]
    assert noise.max() < 0.12
