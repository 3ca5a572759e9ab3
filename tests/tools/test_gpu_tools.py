"""The measurements on a graphics card: scenes, measures, comparison and interrupted runs."""

import json
import math
import subprocess
import sys

import numpy as np
import pytest
from helpers.processes import EXECUTABLE
from tools import gpu_measure, gpu_stacks
from tools.snow_measures import measures, read_points

import snowshed._core as _core
from snowshed import Results, Scene

DEVICES = ("cpu", "gpu")


def scene_on(device, scene):
    """Return the scene as snowshed reads it."""
    return Scene.from_data({**scene, "numerics": {**scene["numerics"], "device": device}})


@pytest.mark.parametrize("name", gpu_stacks.SCENES)
def test_the_scenes_of_stacks_are_valid_and_small(name):
    scene = scene_on("auto", gpu_stacks.scene_of(name, 1, "gpu")).resolve()
    plan = _core.plan(scene.core, scene.base_dir)
    assert 0 < plan["particles_total"] < 10_000
    assert plan["card_memory_bytes"] > 0


@pytest.mark.parametrize("group", ["speed", "panel", "rehearsal"])
def test_the_scenes_of_speed_are_valid(group):
    for case in gpu_measure.cases_of(group):
        scene_on("auto", case.scene).resolve()


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Results of a small slab on the processor, with the balance of energy."""
    folder = tmp_path_factory.mktemp("small")
    gpu_measure.write_small_scenes(folder)
    scene = json.loads((folder / "small-thesis.json").read_text(encoding="utf-8"))
    scene["numerics"]["device"] = "cpu"
    (folder / "scene.json").write_text(json.dumps(scene), encoding="utf-8")
    subprocess.run([EXECUTABLE, folder / "scene.json", "-o", folder / "o", "--quiet"], check=True)
    return folder / "o"


def test_measures_are_those_of_the_particles(results):
    particles = Results(results).particle_table()
    position = particles[["position_x", "position_y", "position_z"]].to_numpy()
    read = np.array(read_points(next((results / "particles").glob("*.vtp")))["position"])
    assert np.allclose(np.sort(read.reshape(-1, 3), axis=0), np.sort(position, axis=0))
    measured = measures(results)
    assert measured["height_m"] == pytest.approx(np.quantile(position[:, 2], 0.99), rel=0.01)
    assert measured["mean_z_m"] == pytest.approx(position[:, 2].mean())
    assert measured["mean_x_m"] == pytest.approx(position[:, 0].mean())
    length = np.quantile(position[:, 0], 0.95) - np.quantile(position[:, 0], 0.05)
    assert measured["length_m"] == pytest.approx(length, rel=0.01)
    assert measured["plastic_j"] > 0


def runs_of(card, processor):
    """Return rows of runs whose only measure has these values by seed."""
    return [
        {"scene": "laboratory", "seed": seed, "device": device, "measures": {"height_m": value}}
        for device, values in zip(DEVICES, (processor, card))
        for seed, value in enumerate(values)
    ]


def test_the_difference_of_means_is_in_standard_errors():
    # Both have the variance 1, so the error of the difference of two means of four is sqrt(1/2).
    first, second = [2.0, 3.0, 4.0, 3.0], [1.0, 2.0, 3.0, 2.0]
    scale = math.sqrt(2.0 / 3.0 / 2.0)
    assert gpu_stacks.standard_errors(first, second) == pytest.approx(1.0 / scale)
    assert gpu_stacks.standard_errors(first, first) == 0.0
    assert gpu_stacks.standard_errors([1.0, 1.0], [2.0, 2.0]) == -math.inf


def test_a_bias_of_the_card_is_missed():
    noise = [1.00, 1.02, 0.99, 1.01]
    (row,) = gpu_stacks.compared(runs_of([v + 0.005 for v in noise], noise))
    assert row["holds"]
    assert row["largest_pair_difference"] == pytest.approx(0.005)
    (row,) = gpu_stacks.compared(runs_of([v + 0.05 for v in noise], noise))
    assert not row["holds"]


def test_only_seeds_of_both_devices_count():
    rows = runs_of([1.0, 2.0, 50.0], [1.0, 2.0, 3.0])
    rows[-1] = {"scene": "laboratory", "seed": 2, "device": "gpu", "error": "no card"}
    (row,) = gpu_stacks.compared(rows)
    assert row["seeds"] == 2
    assert row["card"] == row["processor"] == 1.5


def test_a_run_that_takes_too_long_is_interrupted():
    waiting = [sys.executable, "-c", "import time; time.sleep(60)"]
    assert gpu_measure.run_for(waiting, 1.0) == "interrupted after 1 s"
    assert gpu_measure.run_for(waiting, 0.0) == "not begun: the time was over"
    assert gpu_measure.run_for([sys.executable, "-c", "raise SystemExit('why')"], 9.0) == "why"


def test_an_interrupted_run_has_the_numbers_up_to_then(tmp_path):
    slab = gpu_measure.small_slab()
    case = gpu_measure.Case("slab", slab, seconds=1000.0, threads=1)
    row = gpu_measure.measured(str(EXECUTABLE), tmp_path, case, 3.0)
    assert row["interrupted"] == "interrupted after 3 s"
    assert row["updates_per_s"] > 0
    assert row["particles"] == 4096


def test_each_case_is_in_the_record_at_once(tmp_path, monkeypatch):
    """The second case fails, and the record of the first is there."""
    cases = [gpu_measure.Case("slab_at_rest_262144", {}), gpu_measure.Case("other", {})]
    monkeypatch.setattr(gpu_measure, "cases_of", lambda group: cases)
    records = tmp_path / "records"

    def measured(program, folder, case, seconds):
        if case.name == "other":
            (file,) = records.glob("*-gpu-speed.json")
            assert len(json.loads(file.read_text(encoding="utf-8"))["cases"]) == 1
            return {"case": "other", "device": "gpu", "error": "why"}
        return {"case": case.name, "device": "gpu", "updates_per_s": 4e9}

    monkeypatch.setattr(gpu_measure, "measured", measured)
    monkeypatch.setattr(
        sys, "argv", ["gpu_measure", "run", str(tmp_path), "--records", str(records)]
    )
    assert gpu_measure.main() == 0
    (file,) = records.glob("*-gpu-speed.json")
    record = json.loads(file.read_text(encoding="utf-8"))
    assert [bound["holds"] for bound in record["bounds"]] == [True]
