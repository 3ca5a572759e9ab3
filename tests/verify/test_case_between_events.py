"""Carrying over against reseeding."""

import numpy as np
import pytest

from snowshed.verify.cases import between_events
from snowshed.verify.cases.between_events import CASE
from snowshed.verify.lab_stack import lab_scene, recorded, run_lab

SMALL = {"dimension": 2, "dx": 0.02, "events": 2, "seedings": 2, "seed": 101}


@pytest.fixture(scope="module")
def reseeded():
    outcome = CASE.measure({**SMALL, "between": "reseed"})
    return {one.quantity: one for one in outcome.measured}


@pytest.fixture(scope="module")
def runs():
    scenes = [{"dx": 0.02, "events": 2, "between": "reseed", "seed": seed} for seed in (101, 102)]
    return [run_lab(scene) for scene in scenes]


def test_reseeding_measures_all_quantities_within_their_bars(reseeded):
    assert set(reseeded) == {quantity.name for quantity in CASE.quantities}
    for quantity in CASE.quantities:
        if quantity.bar is not None:
            assert abs(reseeded[quantity.name].error) <= quantity.bar, quantity.name


def test_carrying_over_converts_nothing():
    names = [one.quantity for one in CASE.measure({**SMALL, "between": "carry"}).measured]
    assert names == ["mass", "height", "height_noise", "length", "length_noise"]


def test_conversions_are_counted_in_cells(reseeded, runs):
    for name in ("height", "length"):
        changes = [
            (row[f"{name}_after_m"] - row[f"{name}_before_m"]) / 0.02
            for run in runs
            for row in run.conversions
        ]
        found = reseeded[f"conversion_{name}"]
        assert abs(found.error) == pytest.approx(max(abs(change) for change in changes))
        assert found.value - found.exact == pytest.approx(found.error)


def test_space_is_counted_in_particles_of_the_slabs(reseeded, runs):
    """A slab is 0.245 m x 0.02 m, and as densely seeded as the stack."""
    found = [run.conversions[-1]["particles_after"] for run in runs]
    in_a_slab = [run.particles - count for run, count in zip(runs, found)]
    assert np.std(in_a_slab) < 1
    assert reseeded["conversion_space"].value == pytest.approx(
        np.mean(found) / np.mean(in_a_slab), rel=0.02
    )
    assert reseeded["conversion_space"].value > 1


def test_noise_is_in_deviations_of_carried_stacks(reseeded, runs):
    carried = recorded(2, 0.02)
    mean = np.mean([run.stacks[-1].height for run in runs])
    deviations = (mean - carried.mean("height", 2)) / carried.spread("height", 2)
    assert reseeded["height_noise"].error == pytest.approx(deviations)
    assert reseeded["height"].error == pytest.approx(mean / carried.mean("height", 2) - 1)


@pytest.mark.parametrize("settings", CASE.matrix(True) + CASE.matrix(False), ids=str)
def test_every_entry_makes_a_scene_that_has_carried_stacks(settings):
    rest = {name: value for name, value in settings.items() if name != "seedings"}
    data = lab_scene(rest).initialise().data
    assert data["events"]["between"] == settings["between"]
    assert recorded(data["dimension"], settings["dx"]).spread("height", settings["events"]) > 0
    assert settings["seed"] >= between_events.FIRST_SEED
