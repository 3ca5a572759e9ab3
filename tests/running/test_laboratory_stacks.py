"""The laboratory's stacks in the mean of four seedings, against a record of 24 others."""

import json

import numpy as np
import pytest
from tests.running import laboratory


@pytest.fixture(scope="module")
def recorded():
    return json.loads(laboratory.FILE.read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def found():
    return laboratory.stacks(range(1, 5))


def test_the_record_says_what_made_it(recorded):
    assert recorded["about"] == laboratory.ABOUT
    assert recorded["settings"] == laboratory.SETTINGS
    assert recorded["seeds"] == [laboratory.SEEDS.start, laboratory.SEEDS.stop - 1]
    assert {"version", "date"} <= set(recorded)


@pytest.mark.parametrize("event", [1, 2, 3, 4])
@pytest.mark.parametrize("name", laboratory.COMPARED)
def test_mean_stacks_stay_within_the_noise_of_seeding(found, recorded, name, event):
    """Three standard errors of the difference of both means."""
    values = found[name][:, event - 1]
    mean, deviation = (recorded[key][name][event - 1] for key in ("mean", "deviation"))
    error = deviation * np.sqrt(1 / len(values) + 1 / len(laboratory.SEEDS))
    assert abs(values.mean() - mean) < 3 * error


@pytest.mark.parametrize("name", laboratory.COMPARED)
def test_the_record_is_of_sensible_stacks(recorded, name):
    """Stacks that an independent program makes of the same scene, and their noise of 2 to 6 %."""
    other = {"height": [0.045, 0.072, 0.097, 0.122], "length": [0.22, 0.31, 0.33, 0.38]}[name]
    assert recorded["mean"][name] == pytest.approx(other, rel=0.2)
    noise = np.array(recorded["deviation"][name]) / recorded["mean"][name]
    assert noise.max() < 0.12
