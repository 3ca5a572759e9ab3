"""Studies computed by real processes have the numbers of single runs, also after failures."""

import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import study_helpers
from helpers.processes import children_of, snowshed_command, wait_for
from study_helpers import SEQUENTIAL, contents, tiny_scene, tiny_study

from snowshed import Obstacle, ResolvedScene, Shape, _core, read_events, run_events
from snowshed.study import RunKey, Study, StudyError, read_table, resume
from snowshed.study.compute import compute
from snowshed.study.database import MEASURED_TYPES
from snowshed.study.local import LocalWorkers
from snowshed.study.outcome import RunTask
from snowshed.study.store import Store

computed_folder = study_helpers.computed_folder  # a fixture

#: Runs that take long enough to be killed in the middle, with checkpoints within events.
KILLABLE = """
dimension = 2
events = 2
seeds = 2
[scene]
preset = "lab-50"
output.checkpoint_interval = 0.05
[accuracy]
dx = 0.02
[axes]
panel.friction = [0.1, 0.3]
"""
#: The study of `tiny_study` as a file, without its accuracy.
TINY = """
name = "tiny"
dimension = 2
events = 2
[scene]
preset = "lab-50"
events.max_time = 0.05
[axes]
panel.friction = [0.1, 0.2, 0.3]
"""
COMPUTE = ("--jobs", 1, "--threads", 1, "-q")


@pytest.fixture(scope="module")
def uninterrupted_study(tmp_path_factory):
    """The study file of `KILLABLE`, and the folder where it was computed without interruption."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / "study.toml").write_text(KILLABLE)
    Study.load(folder / "study.toml").run(folder / "store", **SEQUENTIAL)
    return folder / "study.toml", folder / "store"


def task_of(scene, folder: Path) -> RunTask:
    run = RunKey.of(scene.resolve())
    return RunTask(run.hash, run.scene, str(folder), 1)


def long_scene():
    """A scene of some seconds with frequent checkpoints."""
    return tiny_scene(max_time=1.0, events=8).set("output.checkpoint_interval", 0.01)


def outcome_of(workers):
    ended = []
    while not ended:
        ended = workers.collect(10)
    return ended[0]


def test_the_table_agrees_with_single_runs(computed_folder, tmp_path):
    table = read_table(computed_folder)
    for i, run in enumerate(tiny_study().runs()):
        run_events(ResolvedScene.parse(run.scene), tmp_path / str(i), pictures=False)
        single = read_events(tmp_path / str(i))[["event", *MEASURED_TYPES]]
        rows = table[table["hash"] == run.hash][["event", *MEASURED_TYPES]].reset_index(drop=True)
        pd.testing.assert_frame_equal(rows, single, check_dtype=False)
    assert len(table) == 6


def test_neither_order_nor_threads_nor_parallel_work_change_the_table(computed_folder, tmp_path):
    tiny_study().run(tmp_path / "store", jobs=2, threads=2)
    assert contents(tmp_path / "store") == contents(computed_folder)


def test_a_failed_run_is_a_row_with_its_error(tmp_path):
    # The content of an obstacle's file is checked only when the run begins.
    np.save(tmp_path / "good.npy", np.hypot(*np.mgrid[-1:2, -1:2]) * 0.1 - 0.05)
    (tmp_path / "bad.npy").write_text("no array")
    shape = Shape.grid("", origin=(3, 0), spacing=0.1)
    scene = tiny_scene().append("obstacles", Obstacle(shape=shape))
    files = [str(tmp_path / "bad.npy"), str(tmp_path / "good.npy")]
    study = Study.product(scene, {"obstacles.0.shape.file": files})
    table = study.run(tmp_path / "store", **SEQUENTIAL)
    assert table["obstacles.0.shape.file"].tolist() == [files[0], files[1], files[1]]
    assert table.ended.tolist() == ["failed", "time_limit", "time_limit"]
    assert "bad.npy" in table.error[0] and table.error[1:].tolist() == ["", ""]
    assert table.height_m.isna().tolist() == [True, False, False]


def test_a_worker_computes_one_task_after_another(tmp_path):
    workers = LocalWorkers(1, 1, 1)
    try:
        for tilt in (40, 50):
            task = task_of(tiny_scene().set("panel.tilt", tilt), tmp_path / str(tilt))
            workers.submit(task)
            outcome = outcome_of(workers)
            assert (outcome.hash, outcome.status) == (task.hash, "done")
            assert [row["event"] for row in outcome.events] == [1, 2]
            assert outcome.timing["run_wall_s"] > 0
        assert len(workers.pool.process_ids) == 1
    finally:
        workers.close()


def test_a_killed_worker_is_replaced_and_the_others_continue(tmp_path):
    workers = LocalWorkers(2, 1, 2)
    try:
        doomed = task_of(long_scene(), tmp_path / "doomed")
        other_task = task_of(tiny_scene(), tmp_path / "other")
        workers.submit(doomed)
        workers.submit(other_task)
        victim = workers.pool.process_ids[0]
        wait_for(lambda: (tmp_path / "doomed" / "results" / "scene.json").exists())
        os.kill(victim, signal.SIGKILL)
        outcomes = {}
        while len(outcomes) < 2:
            outcomes.update((outcome.hash, outcome) for outcome in workers.collect(10))
        assert outcomes[other_task.hash].status == "done"
        assert outcomes[doomed.hash].status == "lost"
        assert outcomes[doomed.hash].error == "the worker was killed by signal 9 (Killed)"
        workers.submit(doomed)
        assert outcome_of(workers).status == "done"
    finally:
        workers.close()


def test_a_stopped_run_is_resumed_by_another_worker_to_the_same_bits(tmp_path):
    task = task_of(long_scene(), tmp_path / "stopped")
    expected = compute(task_of(long_scene(), tmp_path / "whole"))
    workers = LocalWorkers(1, 1, 1)
    workers.submit(task)
    wait_for(lambda: workers.collect(0.05) or workers.fractions.get(task.hash, 0) > 0)
    (outcome,) = workers.stop()
    assert outcome.status == "interrupted"
    results = tmp_path / "stopped" / "results"
    assert json.loads((results / "run.json").read_text())["status"] == "interrupted"
    resumed = compute(task)
    assert resumed.status == "done"
    assert untimed(resumed) == untimed(expected)


def untimed(outcome):
    return [{k: v for k, v in row.items() if k != "wall_s"} for row in outcome.events]


def test_incomplete_files_of_an_attempt_do_not_hinder_the_next(tmp_path):
    expected = compute(task_of(tiny_scene(), tmp_path / "whole"))
    results = tmp_path / "torn" / "results"
    results.mkdir(parents=True)
    (results / ".scene.123.json").touch()
    assert untimed(compute(task_of(tiny_scene(), tmp_path / "torn"))) == untimed(expected)
    (results / "checkpoint.bin").write_bytes(b"torn")
    assert untimed(compute(task_of(tiny_scene(), tmp_path / "torn"))) == untimed(expected)


def test_a_failure_is_reported_again_after_its_process_was_killed(tmp_path, monkeypatch):
    def fail(*_):
        raise _core.SimulationError("time step underflow")

    task = task_of(tiny_scene(), tmp_path / "failing")
    monkeypatch.setattr(_core.EventSequence, "run", fail)
    first = compute(task)
    monkeypatch.undo()
    second = compute(task)
    assert (first.status, first.error) == (second.status, second.error)
    assert second.error == "time step underflow"


def test_a_run_that_lacked_memory_can_be_repeated(tmp_path, monkeypatch):
    def run_out_of_memory(*_):
        raise MemoryError

    task = task_of(tiny_scene(), tmp_path / "hungry")
    monkeypatch.setattr(_core.EventSequence, "run", run_out_of_memory)
    assert compute(task).status == "lost"
    monkeypatch.undo()
    assert compute(task).status == "done"


def test_a_file_that_changed_after_registration_stops_the_study(tmp_path):
    task = task_of(tiny_scene(), tmp_path / "work")
    changed = RunTask("0" * 32, task.scene, task.folder, 1)
    outcome = compute(changed)
    assert outcome.status == "unable"
    assert "differs from the registered one" in outcome.error


def test_without_shared_files_a_run_works_in_a_temporary_folder(tmp_path):
    outcome = compute(task_of(tiny_scene(), tmp_path / "elsewhere" / "running" / "x"))
    assert outcome.status == "done" and len(outcome.events) == 2
    assert not (tmp_path / "elsewhere").exists()


def test_workers_that_cannot_start_stop_the_study(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "executable", "/bin/false")
    with pytest.raises(StudyError, match="no worker can start: it ended with code 1"):
        tiny_study().run(tmp_path / "store", **SEQUENTIAL)


def test_no_worker_outlives_a_killed_study(tmp_path, uninterrupted_study):
    command = snowshed_command(
        "study", "run", uninterrupted_study[0], "-o", tmp_path / "s", *COMPUTE
    )
    wait_for(lambda: list((tmp_path / "s").glob("running/*/results/scene.json")))
    children = children_of(command.pid)
    assert children
    command.kill()
    command.communicate()
    wait_for(lambda: not any(Path(f"/proc/{child}").exists() for child in children))


def test_ctrl_c_says_how_to_resume_and_the_rest_is_computed(tmp_path):
    study, folder = tmp_path / "study.toml", tmp_path / "store"
    longer = KILLABLE.replace("events = 2", "events = 4").replace("dx = 0.02", "dx = 0.01")
    # The runs are long, so that none ends before the signal.
    study.write_text(longer.replace("seeds = 2", "seeds = 1"))
    command = snowshed_command("study", "run", study, "-o", folder, *COMPUTE)
    wait_for(lambda: list(folder.glob("running/*/results/scene.json")))
    command.send_signal(signal.SIGINT)
    out, err = command.communicate(timeout=120)
    assert (command.returncode, out) == (130, "")
    assert err == f"error: interrupted; resume with: snowshed study resume {folder}\n"
    statuses = [
        json.loads(path.read_text())["status"] for path in folder.glob("running/*/results/run.json")
    ]
    assert statuses in ([], ["interrupted"])  # empty if it was stopped before its run began
    resume(folder, **SEQUENTIAL)
    with Store.open(folder) as store:
        assert {run.status for run in store.runs("study")} == {"done"}


def kill_at_random_moments(study: Path, folder: Path, kills: int, rng: random.Random) -> int:
    """Run a study and kill it at random moments; return the number of kills until it was done."""
    for kill in range(kills):
        command = snowshed_command("study", "run", study, "-o", folder, *COMPUTE)
        victim = command.pid
        try:
            command.wait(rng.uniform(0.1, 3.0))
            assert command.communicate() == ("", "") and command.returncode == 0
            return kill
        except subprocess.TimeoutExpired:
            workers = children_of(command.pid)
            if workers and rng.random() < 0.3:
                os.kill(rng.choice(workers), signal.SIGKILL)
                time.sleep(rng.uniform(0, 0.5))
            os.kill(victim, signal.SIGKILL)
            command.communicate()
    return kills


def kill_and_compare(tmp_path, uninterrupted_study, kills):
    study, uninterrupted = uninterrupted_study
    expected = contents(uninterrupted)
    table = read_table(uninterrupted).to_csv()
    rng = random.Random(kills)
    done = attempt = 0
    while done < kills:
        attempt += 1
        folder = tmp_path / f"killed-{attempt}"
        done += kill_at_random_moments(study, folder, kills - done, rng)
        Study.load(study).run(folder, **SEQUENTIAL)
        assert contents(folder) == expected
        assert read_table(folder).to_csv() == table
        assert not any((folder / "running").iterdir())


def test_kills_at_random_moments_do_not_change_the_table(tmp_path, uninterrupted_study):
    kill_and_compare(tmp_path, uninterrupted_study, kills=4)


@pytest.mark.slow
def test_a_hundred_kills_do_not_change_the_table(tmp_path, uninterrupted_study):
    kill_and_compare(tmp_path, uninterrupted_study, kills=100)


def test_two_processes_share_one_store(tmp_path, computed_folder):
    (tmp_path / "study.toml").write_text(TINY + "[accuracy]\ndx = 0.02")
    arguments = ("study", "run", tmp_path / "study.toml", "-o", tmp_path / "store", *COMPUTE)
    commands = [snowshed_command(*arguments) for _ in range(2)]
    for command in commands:
        assert command.communicate(timeout=120) == ("", "")
        assert command.returncode == 0
    assert contents(tmp_path / "store") == contents(computed_folder)


@pytest.mark.parametrize(
    ("limit_kb", "seeding", "file"),
    [
        (8, "", "store.sqlite: "),
        (50, "", "store.sqlite: "),
        (150, 'particles_per_voxel = 400\npattern = "jittered"', ": cannot write: File too large"),
    ],
    ids=["making the store", "storing results", "writing results"],
)
def test_a_full_disk_is_an_error_without_loss(tmp_path, limit_kb, seeding, file, computed_folder):
    """A limit on the size of files imitates a full disk, at different stages."""
    (tmp_path / "study.toml").write_text(f"{TINY}[accuracy]\ndx = 0.02\n{seeding}")
    command = ["study", "run", str(tmp_path / "study.toml"), "-o", str(tmp_path / "full"), "-q"]
    limited = (
        "import resource, sys; from snowshed.cli.main import main; "
        f"resource.setrlimit(resource.RLIMIT_FSIZE, ({limit_kb} * 1024, resource.RLIM_INFINITY)); "
        "sys.exit(main(sys.argv[1:]))"
    )
    full = subprocess.run(
        [sys.executable, "-c", limited, *command, "--jobs", "1"], capture_output=True, text=True
    )
    assert full.returncode == 3, full.stderr
    assert full.stderr.startswith("error: ") and full.stderr.count("\n") == 1
    assert file in full.stderr and "stored results are safe" in full.stderr
    study = Study.load(tmp_path / "study.toml")
    study.run(tmp_path / "full", **SEQUENTIAL)
    if seeding:
        study.run(tmp_path / "whole", **SEQUENTIAL)
    assert contents(tmp_path / "full") == contents(
        tmp_path / "whole" if seeding else computed_folder
    )
