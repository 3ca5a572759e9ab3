"""The recorded stacks, and the case that compares with them."""

import json

import numpy as np
import pytest
from validation.laboratory import case_stack_convergence as stack_convergence
from validation.laboratory import lab_stack
from validation.laboratory.case_stack_convergence import CASE
from validation.laboratory.lab_stack import lab_scene, record, recorded, run_lab

from snowshed import Scene

QUICK = {"dimension": 2, "dx": 0.02, "events": 1}


@pytest.fixture(scope="module")
def runs():
    return json.loads(lab_stack.FILE.read_text(encoding="utf-8"))["runs"]


def test_recorded_runs_say_what_made_them(runs):
    for run in runs:
        assert {"dimension", "dx", "seed", "version", "date", "particles", "steps"} <= set(run)
        assert run["ended"] == ["rest"]
        for name in lab_stack.COMPARED:
            assert len(run[name]) == 5
            assert 0.01 < min(run[name]) <= max(run[name]) < 2.0
    keys = [(run["dimension"], run["dx"], run["seed"]) for run in runs]
    assert len(set(keys)) == len(keys)


def test_all_of_the_reference_was_recorded(runs):
    for dimension, dx, seedings in lab_stack.RECORDED:
        seeds = [r["seed"] for r in runs if (r["dimension"], r["dx"]) == (dimension, dx)]
        assert sorted(seeds) == list(range(1, seedings + 1))


def test_mean_and_spread_are_those_of_the_runs(runs):
    heights = [r["height"][2] for r in runs if (r["dimension"], r["dx"]) == (2, 0.01)]
    mean = sum(heights) / len(heights)
    variance = sum((height - mean) ** 2 for height in heights) / (len(heights) - 1)
    assert recorded(2, 0.01).mean("height", 3) == pytest.approx(mean)
    assert recorded(2, 0.01).spread("height", 3) == pytest.approx(variance**0.5)


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_reference_is_the_finest_grid(dimension, runs):
    finest = min(run["dx"] for run in runs if run["dimension"] == dimension)
    assert recorded(dimension).dx == finest


def test_an_unknown_grid_is_an_error():
    with pytest.raises(LookupError, match=r"0\.3.*0\.01"):
        recorded(2, 0.3)


def test_finer_grids_come_nearer_to_the_reference():
    for event in (1, 2, 3, 4):
        exact = recorded(2).mean("height", event)
        errors = [abs(recorded(2, dx).mean("height", event) - exact) for dx in (0.01, 0.005)]
        assert errors[1] < errors[0]


def test_stacks_are_measured_as_the_recorded_ones_were():
    run = run_lab({"dimension": 2, "dx": 0.02, "events": 1})
    assert {stack.trimming for stack in run.stacks} == {"equal_pace"}


def test_recording_reproduces_what_was_recorded(tmp_path):
    """Within four deviations: other processors round differently, and stacks are chaotic."""
    path = tmp_path / "stacks.json"
    record(path, [(2, 0.02, 1)], events=1)
    (run,) = json.loads(path.read_text(encoding="utf-8"))["runs"]
    there = recorded(2, 0.02)
    for name in lab_stack.COMPARED:
        assert run[name][0] == pytest.approx(there.mean(name, 1), abs=4 * there.spread(name, 1))


def test_what_is_recorded_is_not_run_again(tmp_path, monkeypatch):
    path = tmp_path / "stacks.json"
    record(path, [(2, 0.02, 1)], events=1)
    before = path.read_bytes()
    monkeypatch.setattr(lab_stack, "run_lab", None)
    record(path, [(2, 0.02, 1)], events=1)
    assert path.read_bytes() == before


def test_a_run_has_a_stack_for_each_event_and_all_its_mass():
    run = run_lab({**QUICK, "events": 2})
    assert run.ended == ["rest", "rest"]
    assert run.series("height") == [stack.height for stack in run.stacks]
    assert run.series("body_length") == [stack.body.length for stack in run.stacks]
    assert run.brought_mass == pytest.approx(2 * 210 * 0.245 * 0.02)
    assert run.mass == pytest.approx(run.brought_mass, rel=1e-6)
    assert 0 < run.updates <= run.steps * run.particles


@pytest.mark.parametrize("settings", CASE.matrix(True) + CASE.matrix(False), ids=str)
def test_every_entry_makes_a_scene_with_a_reference(settings):
    rest = {name: value for name, value in settings.items() if name != "seedings"}
    data = lab_scene(rest).resolve().data
    assert data["panel"]["friction"] == 0.3
    assert data["events"]["count"] == settings["events"] <= 5
    assert recorded(data["dimension"]).mean("height", settings["events"]) > 0


def test_snow_sleeps_as_by_default_but_in_the_reference():
    default = Scene.preset("lab-50").resolve().data["numerics"]["sleep_speed"]
    assert lab_scene(QUICK).resolve().data["numerics"]["sleep_speed"] == default > 0
    awake = lab_scene({**QUICK, **lab_stack.AWAKE}).resolve()
    assert awake.data["numerics"]["sleep_speed"] == 0


def test_events_are_set_too():
    scene = lab_scene({"dimension": 3, "dx": 0.02, "between": "reseed", "events": 2})
    assert (scene.dimension, scene.events.count, scene.events.between) == (3, 2, "reseed")


def test_measure_gives_the_error_of_a_single_run_and_the_spread():
    outcome = CASE.measure({**QUICK, "seedings": 3})
    heights = np.array([run_lab({**QUICK, "seed": seed}).stacks[0].height for seed in (1, 2, 3)])
    exact = recorded(2).mean("height", 1)
    found = {one.quantity: one for one in outcome.measured}
    assert found["height"].value == pytest.approx(heights.mean())
    assert found["height"].exact == exact
    assert found["height"].error == pytest.approx(np.sqrt(np.mean((heights / exact - 1) ** 2)))
    assert found["height_spread"].error == pytest.approx(heights.std(ddof=1) / heights.mean())
    assert set(found) <= {quantity.name for quantity in CASE.quantities}


def test_one_seeding_has_no_spread():
    names = {one.quantity for one in CASE.measure(QUICK).measured}
    assert names == {*lab_stack.COMPARED, "height_noise", "length_noise"}


def test_without_sleep_a_stack_is_like_the_recorded_ones():
    """The mean of four: its own deviation is half of a single one's."""
    settings = {**QUICK, "seedings": 4, "sleep_speed": 0.0}
    found = {one.quantity: one for one in CASE.measure(settings).measured}
    there = recorded(2, 0.02)
    for name in ("height", "length"):
        departure = (found[name].value - there.mean(name, 1)) / there.spread(name, 1)
        assert found[f"{name}_noise"].error == pytest.approx(departure)
        assert abs(departure) < 2


def test_the_full_matrix_runs_every_grid_with_sleep_and_without():
    entries = CASE.matrix(True)
    awake = [entry for entry in entries if entry.get("sleep_speed") == 0]
    for entry in awake:
        asleep = {name: value for name, value in entry.items() if name != "sleep_speed"}
        assert asleep in entries
    assert {(entry["dimension"], entry["dx"]) for entry in awake} >= {(2, 0.005), (3, 0.01)}
    for dimension in (2, 3):
        events = {e["events"] for e in entries if e["dimension"] == dimension}
        assert events == {1, 2, 3, 5}


def test_three_dimensions_are_compared_with_two(monkeypatch):
    run = run_lab(QUICK)
    monkeypatch.setattr(stack_convergence, "run_seedings", lambda settings: [run])
    outcome = CASE.measure({**QUICK, "dimension": 3})
    ratio = outcome.measured[-1]
    assert ratio.quantity == "height_over_2d"
    assert ratio.value == pytest.approx(run.stacks[0].height / recorded(2, 0.02).mean("height", 1))


def test_stacks_of_the_default_scheme_are_within_their_bar():
    outcome = CASE.measure({**QUICK, "transfer": "flip", "seedings": 4, "events": 3})
    bars = {one.name: one for one in CASE.quantities if one.bar is not None}
    assert set(bars) == {"height_noise", "length_noise"}
    for one in outcome.measured:
        if one.quantity in bars:
            assert abs(one.error) <= bars[one.quantity].bar, one


@pytest.mark.parametrize("full", [True, False])
def test_the_bars_are_for_the_scheme_of_the_recorded_runs(full):
    meant = [
        one
        for one in CASE.matrix(full)
        if all(one.get(key) == value for key, value in stack_convergence.DEFAULT_SCHEME.items())
    ]
    assert len(meant) >= 4
    assert not any("flip_ratio" in one or one["transfer"] == "apic" for one in meant)
