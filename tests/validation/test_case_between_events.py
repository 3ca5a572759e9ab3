"""Stacks that are carried over, and reseeded stacks."""

import numpy as np
import pytest
from validation.laboratory import case_between_events as between_events
from validation.laboratory.case_between_events import CASE
from validation.laboratory.lab_records import recorded
from validation.laboratory.lab_stack import (
    COMPARED,
    Conversion,
    lab_scene,
    measure_of,
    run_lab,
)

from snowshed.snow.stack.measure import measure_stack

SMALL = {"dimension": 2, "dx": 0.02, "events": 2, "seedings": 2, "seed": 101}


@pytest.fixture(scope="module")
def reseeded():
    outcome = CASE.measure({**SMALL, "between": "reseed"})
    return {result.quantity: result for result in outcome.measured}


@pytest.fixture(scope="module")
def runs():
    scenes = [{"dx": 0.02, "events": 2, "between": "reseed", "seed": seed} for seed in (101, 102)]
    return [run_lab(scene) for scene in scenes]


def test_reseeding_measures_all_quantities_within_their_limits(reseeded):
    assert set(reseeded) == {quantity.name for quantity in CASE.quantities}
    for quantity in CASE.quantities:
        if quantity.limit is not None:
            assert abs(reseeded[quantity.name].error) <= quantity.limit, quantity.name


def test_carried_stacks_have_no_conversion():
    names = [result.quantity for result in CASE.measure({**SMALL, "between": "carry"}).measured]
    assert names == ["mass", "height", "height_noise", "length", "length_noise"]


def test_the_largest_change_of_all_conversions_is_given_in_cells(reseeded, runs):
    for name in COMPARED:
        changes = [conversion.change(name) / 0.02 for run in runs for conversion in run.conversions]
        result = reseeded[f"conversion_{name}"]
        assert abs(result.error) == max(abs(change) for change in changes)
        assert result.error in changes


def test_a_conversion_starts_from_the_last_measured_stack(runs):
    for run in runs:
        (conversion,) = run.conversions
        for name in COMPARED:
            assert measure_of(conversion.before, name) == run.series(name)[0]


def heap(chunk):
    """Return a body 1 m long and 0.1 m high, and a row of particles beyond a gap of 0.5 m."""
    x, z = np.meshgrid(np.linspace(0, 1, 101), np.linspace(0, 0.1, 11))
    x, z = np.append(x, 1.5 + 0.01 * np.arange(chunk)), np.append(z, np.zeros(chunk))
    positions, masses = np.column_stack([x, 0 * x, z]), np.ones(len(x))
    return measure_stack(positions, masses, masses, dimension=2, dx=0.02)


def test_a_chunk_that_vanishes_shortens_the_stack_but_not_its_body():
    before, after = heap(60), heap(0)
    conversion = Conversion(before, after, 1171.0, 1171.0, 1111)
    assert conversion.change("length") < -0.5
    assert conversion.change("body_length") == pytest.approx(0, abs=0.011)
    assert conversion.change("height") == conversion.outline_moved == 0
    assert conversion.loose_change == pytest.approx(-60 / 1171)


def test_the_space_of_particles_is_relative_to_the_slabs(reseeded, runs):
    """A slab of 0.245 m x 0.02 m has as many particles per volume as the stack."""
    in_the_stack = [run.conversions[-1].particles_after for run in runs]
    in_the_slab = [run.cost.particles - count for run, count in zip(runs, in_the_stack)]
    assert np.std(in_the_slab) < 1
    assert reseeded["conversion_space"].value == pytest.approx(
        np.mean(in_the_stack) / np.mean(in_the_slab), rel=0.02
    )
    assert reseeded["conversion_space"].value > 1


def test_noise_is_in_deviations_of_carried_stacks(reseeded, runs):
    carried = recorded(2, 0.02)
    mean = np.mean([run.stacks[-1].height for run in runs])
    deviations = (mean - carried.mean("height", 2)) / carried.spread("height", 2)
    assert reseeded["height_noise"].error == pytest.approx(deviations)
    assert reseeded["height"].error == pytest.approx(mean / carried.mean("height", 2) - 1)


@pytest.mark.parametrize("settings", CASE.matrix(True) + CASE.matrix(False), ids=str)
def test_stacks_are_carried_in_every_scene_of_the_matrix(settings):
    scene_settings = {name: value for name, value in settings.items() if name != "seedings"}
    data = lab_scene(scene_settings).resolve().data
    assert data["events"]["between"] == settings["between"]
    assert recorded(data["dimension"], settings["dx"]).spread("height", settings["events"]) > 0
    assert settings["seed"] >= between_events.FIRST_SEED
