"""Recorded stacks, and the case that compares new stacks with them."""

import json

import numpy as np
import pytest
from validation.framework.case import alternatives
from validation.laboratory import case_stack_convergence as stack_convergence
from validation.laboratory import lab_records
from validation.laboratory.case_stack_convergence import CASE
from validation.laboratory.lab_records import REFERENCES, Grid, record, recorded
from validation.laboratory.lab_stack import COMPARED, lab_scene, run_lab

from snowshed import Scene
from snowshed.snow.accuracy.mechanisms import scheme_of

QUICK = {"dimension": 2, "dx": 0.02, "events": 1}


@pytest.fixture(scope="module")
def runs():
    return json.loads(lab_records.FILE.read_text(encoding="utf-8"))["runs"]


def test_recorded_runs_state_their_origin(runs):
    for run in runs:
        assert {"dimension", "dx", "seed", "version", "date", "particles", "steps"} <= set(run)
        assert run["ended"] == ["rest"]
        for name in COMPARED:
            assert len(run[name]) == run.get("events", 5)
            assert 0.01 < min(run[name]) <= max(run[name]) < 2.0
    keys = [(scheme_of(run), run["dimension"], run["dx"], run["seed"]) for run in runs]
    assert len(set(keys)) == len(keys)


@pytest.mark.parametrize("scheme", REFERENCES)
def test_every_run_of_a_reference_is_recorded(scheme, runs):
    of_scheme = [run for run in runs if scheme_of(run) == scheme]
    for grid in REFERENCES[scheme].grids:
        seeds = [
            r["seed"] for r in of_scheme if (r["dimension"], r["dx"]) == (grid.dimension, grid.dx)
        ]
        assert sorted(seeds) == list(range(1, grid.seedings + 1))
    assert len(of_scheme) == sum(grid.seedings for grid in REFERENCES[scheme].grids)
    for name, value in REFERENCES[scheme].settings.items():
        assert {run[name] for run in of_scheme} == {value}


def test_mean_and_spread_follow_from_the_runs(runs):
    for scheme in REFERENCES:
        of_scheme = [r for r in runs if scheme_of(r) == scheme]
        heights = [r["height"][2] for r in of_scheme if (r["dimension"], r["dx"]) == (2, 0.01)]
        mean = sum(heights) / len(heights)
        variance = sum((height - mean) ** 2 for height in heights) / (len(heights) - 1)
        record = recorded(2, 0.01, scheme)
        assert record.mean("height", 3) == pytest.approx(mean)
        assert record.spread("height", 3) == pytest.approx(variance**0.5)


@pytest.mark.parametrize("scheme", REFERENCES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_the_reference_is_the_finest_grid_of_the_scheme(dimension, scheme, runs):
    of_scheme = [run for run in runs if run["dimension"] == dimension and scheme_of(run) == scheme]
    finest = recorded(dimension, scheme=scheme)
    assert finest.dx == min(run["dx"] for run in of_scheme)
    heights = [run["height"][0] for run in of_scheme if run["dx"] == finest.dx]
    assert sorted(finest.runs["height"][:, 0]) == sorted(heights)


def test_events_missing_in_the_reference_have_no_exact_value():
    """The finest grid in 3D has two events. Coarser grids do not replace it for more events."""
    reference = recorded(3, scheme="objective")
    assert reference.events == 2
    assert reference.mean("height", 2) > 0 and np.isnan(reference.mean("height", 3))


def test_an_unknown_grid_is_an_error():
    with pytest.raises(LookupError, match=r"0\.3.*0\.01"):
        recorded(2, 0.3)


def test_finer_grids_are_closer_to_the_reference():
    for event in (1, 2, 3, 4):
        exact = recorded(2).mean("height", event)
        errors = [abs(recorded(2, dx).mean("height", event) - exact) for dx in (0.01, 0.005)]
        assert errors[1] < errors[0]


def test_stacks_are_measured_like_the_recorded_stacks():
    run = run_lab({"dimension": 2, "dx": 0.02, "events": 1})
    assert {stack.trimming for stack in run.stacks} == {"equal_pace"}


@pytest.mark.parametrize("scheme", REFERENCES)
def test_recording_reproduces_the_recorded_stacks(tmp_path, scheme):
    """Stacks agree within four deviations: other processors round differently, and stacks are
    chaotic."""
    path = tmp_path / "stacks.json"
    record(path, scheme, [Grid(2, 0.02, 1, events=1)])
    (run,) = json.loads(path.read_text(encoding="utf-8"))["runs"]
    assert scheme_of(run) == scheme
    reference = recorded(2, 0.02, scheme)
    for name in COMPARED:
        assert run[name][0] == pytest.approx(
            reference.mean(name, 1), abs=4 * reference.spread(name, 1)
        )


def test_recorded_runs_are_not_repeated(tmp_path, monkeypatch):
    path = tmp_path / "stacks.json"
    record(path, grids=[Grid(2, 0.02, 1, events=1)])
    record(path, "objective", [Grid(2, 0.02, 1, events=1)])
    before = path.read_bytes()
    monkeypatch.setattr(lab_records, "run_lab", None)
    record(path, grids=[Grid(2, 0.02, 1, events=1)])
    record(path, "objective", [Grid(2, 0.02, 1, events=1)])
    assert path.read_bytes() == before


def test_a_run_without_a_scheme_does_not_match_another_scheme():
    key = {"dimension": 2, "dx": 0.02, "seed": 1, "sleep_speed": 0.02}
    with_scheme = {**key, "scheme": "objective", "version": "1"}
    assert not lab_records.is_of(with_scheme, key)
    assert lab_records.is_of({**key, "version": "1"}, key)
    assert lab_records.is_of(with_scheme, {**key, "scheme": "objective"})


def test_a_run_has_a_stack_for_each_event_and_all_its_mass():
    run = run_lab({**QUICK, "events": 2})
    assert run.ended == ["rest", "rest"]
    assert run.series("height") == [stack.height for stack in run.stacks]
    assert run.series("body_length") == [stack.body.length for stack in run.stacks]
    assert run.brought_mass == pytest.approx(2 * 210 * 0.245 * 0.02)
    assert run.mass == pytest.approx(run.brought_mass, rel=1e-6)
    first, last = run.costs
    assert run.cost == last
    assert first.particles == last.particles / 2
    assert 0 < first.updates <= first.steps * first.particles
    assert first.updates < last.updates and first.steps < last.steps
    assert 0 < first.wall_s < last.wall_s


@pytest.mark.parametrize("settings", CASE.matrix(True) + CASE.matrix(False), ids=str)
def test_every_entry_makes_a_scene_with_a_reference(settings):
    scene_settings = {name: value for name, value in settings.items() if name != "seedings"}
    data = lab_scene(scene_settings).resolve().data
    assert data["panel"]["friction"] == 0.3
    assert data["events"]["count"] == settings["events"] <= 5
    assert data["numerics"]["scheme"] == scheme_of(settings)
    reference = recorded(data["dimension"], scheme=scheme_of(settings))
    assert reference.mean("height", min(settings["events"], reference.events)) > 0


def test_snow_sleeps_by_default_except_in_the_reference():
    default = Scene.preset("lab-50").resolve().data["numerics"]["sleep_speed"]
    assert lab_scene(QUICK).resolve().data["numerics"]["sleep_speed"] == default > 0
    awake = lab_scene({**QUICK, **lab_records.NO_SLEEP}).resolve()
    assert awake.data["numerics"]["sleep_speed"] == 0


def test_events_can_be_set():
    scene = lab_scene({"dimension": 3, "dx": 0.02, "between": "reseed", "events": 2})
    assert (scene.dimension, scene.events.count, scene.events.between) == (3, 2, "reseed")


def test_measure_gives_the_error_of_a_single_run_and_the_spread():
    outcome = CASE.measure({**QUICK, "seedings": 3})
    heights = np.array([run_lab({**QUICK, "seed": seed}).stacks[0].height for seed in (1, 2, 3)])
    exact = recorded(2).mean("height", 1)
    results = {result.quantity: result for result in outcome.measured}
    assert results["height"].value == pytest.approx(heights.mean())
    assert results["height"].exact == exact
    assert results["height"].error == pytest.approx(np.sqrt(np.mean((heights / exact - 1) ** 2)))
    assert results["height_spread"].error == pytest.approx(heights.std(ddof=1) / heights.mean())
    assert set(results) <= {quantity.name for quantity in CASE.quantities}


def test_each_scheme_is_compared_with_its_own_reference():
    settings = {**QUICK, "scheme": "objective", "seedings": 2}
    results = {result.quantity: result for result in CASE.measure(settings).measured}
    assert results["height"].exact == recorded(2, scheme="objective").mean("height", 1)
    same_grid = recorded(2, 0.02, "objective")
    departure = (results["height"].value - same_grid.mean("height", 1)) / same_grid.spread(
        "height", 1
    )
    assert results["height_noise"].error == pytest.approx(departure)
    assert abs(departure) < stack_convergence.MAX_NOISE


def test_a_single_seeding_has_no_spread():
    names = {result.quantity for result in CASE.measure(QUICK).measured}
    assert names == {*COMPARED, "height_noise", "length_noise"}


def test_without_sleep_stacks_agree_with_the_recorded_stacks():
    """The mean of four stacks has half the deviation of a single stack."""
    settings = {**QUICK, "seedings": 4, "sleep_speed": 0.0}
    results = {result.quantity: result for result in CASE.measure(settings).measured}
    same_grid = recorded(2, 0.02)
    for name in ("height", "length"):
        departure = (results[name].value - same_grid.mean(name, 1)) / same_grid.spread(name, 1)
        assert results[f"{name}_noise"].error == pytest.approx(departure)
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


def test_stacks_in_3d_are_compared_with_2d(monkeypatch):
    run = run_lab(QUICK)
    monkeypatch.setattr(stack_convergence, "run_seedings", lambda settings: [run])
    outcome = CASE.measure({**QUICK, "dimension": 3})
    ratio = outcome.measured[-1]
    assert ratio.quantity == "height_over_2d"
    assert ratio.value == pytest.approx(run.stacks[0].height / recorded(2, 0.02).mean("height", 1))


def test_stacks_of_the_default_scheme_are_within_their_limits():
    outcome = CASE.measure({**QUICK, "transfer": "flip", "seedings": 4, "events": 3})
    criteria = {
        quantity.name: quantity for quantity in CASE.quantities if quantity.limit is not None
    }
    assert set(criteria) == {"height_noise", "length_noise"}
    for result in outcome.measured:
        if result.quantity in criteria:
            assert abs(result.error) <= criteria[result.quantity].limit, result


@pytest.mark.parametrize("full", [True, False])
def test_the_limits_apply_to_the_scheme_of_the_recorded_runs(full):
    recorded_settings = stack_convergence.AS_RECORDED.items()
    settings_list = [
        settings
        for settings in CASE.matrix(full)
        if all(settings.get(key) in alternatives(value) for key, value in recorded_settings)
    ]
    assert len(settings_list) >= 4
    assert not any(
        "flip_ratio" in settings or settings.get("transfer") == "apic" for settings in settings_list
    )
    assert {scheme_of(settings) for settings in settings_list} == set(REFERENCES)
