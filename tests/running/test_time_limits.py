"""Steps that are too short, and time limits, in all methods."""

import json

import pytest
from conftest import tiny_mps, tiny_scene
from helpers.grain_files import write_labels
from helpers.processes import snowshed_run

from snowshed import InputError, Simulation, run_events
from snowshed.running.run import run
from snowshed.scene import example_slide
from snowshed.scene.builders.grains import grains_scene
from snowshed.scene.loading import LoadingStage

TINY = (1e-300, 1e-30, 1e-14)


def scene_of(method, folder):
    if method == "slide":
        return example_slide(folder).set("events.max_time", 2.0)
    if method == "grains":
        loading = [LoadingStage(kind="compress", speed=0.1, strain=0.002)]
        return grains_scene(write_labels(folder), 1e-4, loading)
    if method == "mps":
        return tiny_mps(**{"events": {"count": 1, "max_time": 0.2}})
    return tiny_scene(**{"events.count": 1})


STEPS = {
    "mpm": ["courant_factor"],
    "slide": ["time_step"],
    "mps": ["max_time_step", "courant_factor"],
    "grains": ["courant_factor"],
}


@pytest.mark.parametrize(("method", "name"), [(m, n) for m, names in STEPS.items() for n in names])
def test_a_tiny_step_is_refused_before_the_run(method, name, tmp_path):
    scene = scene_of(method, tmp_path)
    for value in TINY:
        scene.set(f"numerics.{name}", value)
        with pytest.raises(InputError, match=rf"^/numerics/{name}: .*(1e12 are allowed|fallen to)"):
            run(scene, tmp_path / "out", pictures=False)
        scene.resolve().save(tmp_path / "scene.json")
        done = snowshed_run(tmp_path / "scene.json", "-o", tmp_path / "out", "-q")
        assert done.returncode == 2 and f"/numerics/{name}" in done.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("method", STEPS)
@pytest.mark.parametrize("interval", ["snapshot_interval", "film_interval"])
def test_tiny_output_intervals_are_refused(method, interval, tmp_path):
    scene = scene_of(method, tmp_path).set(f"output.{interval}", 1e-300)
    with pytest.raises(InputError, match=rf"^/output/{interval}: .*at most 1e6 are allowed"):
        run(scene, tmp_path / "out", pictures=False)


@pytest.mark.parametrize("method", ["mpm", "mps", "slide"])
def test_an_event_ends_within_a_step_of_its_time_limit(method, tmp_path):
    limit = {"mpm": 0.0501, "mps": 0.1234, "slide": 0.9}[method]
    scene = scene_of(method, tmp_path).update({"events.max_time": limit, "events.rest_time": limit})
    run(scene, tmp_path / "out", pictures=False)
    (event,) = json.loads((tmp_path / "out" / "run.json").read_text())["finished_events"]
    assert event["ended"] == "time_limit"
    simulation = Simulation(scene)
    simulation.begin_event()
    simulation.step(event["steps"] - 1)
    before = simulation.time
    simulation.step(1)
    step = simulation.time - before
    assert simulation.time == pytest.approx(event["sim_time_s"], rel=1e-12)
    assert before < limit - 1e-6 * step <= simulation.time < limit + step


@pytest.mark.parametrize(("mixing_rate", "steps"), [(0.0, 10), (8.0, 40)])
def test_steps_that_divide_the_time_limit_reach_it_exactly(tmp_path, mixing_rate, steps):
    """Ten steps of 0.1 s make 0.99999 s in floating point: no eleventh follows."""
    scene = scene_of("slide", tmp_path).update({"events.max_time": 1.0, "numerics.time_step": 0.1})
    scene.update({"numerics.bonds": False, "numerics.mixing_rate": mixing_rate})
    run(scene, tmp_path / "out", pictures=False)
    (event,) = json.loads((tmp_path / "out" / "run.json").read_text())["finished_events"]
    assert event["steps"] == steps


def test_a_rest_time_of_zero_does_not_end_an_event_at_once(tmp_path):
    scene = tiny_scene(**{"events.count": 1, "events.rest_time": 0.0})
    table = run_events(scene, tmp_path / "out", pictures=False)
    assert table["steps"].iloc[0] > 0 and table["sim_time_s"].iloc[0] > 0
