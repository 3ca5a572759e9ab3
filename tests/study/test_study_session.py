"""Distribution of a study's runs to workers, and handling of their outcomes."""

import signal
import threading
import time
from collections import Counter
from dataclasses import replace

import pytest
import study_helpers
from study_helpers import outcome, tiny_scene, tiny_study

from snowshed import InputError, SnowshedNote, _core
from snowshed.base.notes import record_notes
from snowshed.snow.accuracy.stack_errors import BEGINNING
from snowshed.study import Study, StudyError, StudyInterrupted, cost_estimate, resume, session
from snowshed.study.outcome import RunOutcome
from snowshed.study.owner import ownership
from snowshed.study.store import Store

scripted_workers = study_helpers.scripted_workers  # a fixture

STUDY = tiny_study()
HASHES = [run.hash for run in STUDY.runs()]


def states(folder):
    with Store.open(folder) as store:
        return [(run.status, run.error) for run in store.runs("tiny")]


def test_every_run_is_computed_once(scripted_workers, tmp_path):
    STUDY.run(tmp_path / "store")
    assert sorted(task.hash for task in scripted_workers.tasks) == sorted(HASHES)
    STUDY.run(tmp_path / "store")
    resume(tmp_path / "store")
    assert len(scripted_workers.tasks) == 3
    assert scripted_workers.closed


def test_studies_that_share_a_store_share_runs(scripted_workers, tmp_path):
    STUDY.run(tmp_path / "store")
    tiny_study("wider", frictions=(0.3, 0.1, 0.4)).run(tmp_path / "store")
    assert len(scripted_workers.tasks) == 4


def test_the_longest_runs_come_first(scripted_workers, tmp_path):
    scene = STUDY.scene
    Study.product(scene, {"events.count": [1, 3, 2]}).run(tmp_path / "store")
    works = [cost_estimate.work(task.scene) for task in scripted_workers.tasks]
    assert works == sorted(works, reverse=True) and len(set(works)) == 3


def test_a_failed_run_does_not_stop_the_others_and_can_be_tried_again(scripted_workers, tmp_path):
    def fail_one(task):
        failed = task.hash == HASHES[1]
        return outcome(task.hash, "failed", 1, "too steep") if failed else outcome(task.hash)

    scripted_workers.answer = fail_one
    table = STUDY.run(tmp_path / "store")
    assert [status for status, _ in states(tmp_path / "store")] == ["done", "failed", "done"]
    (row,) = table[table.ended == "failed"].to_dict("records")
    assert (row["hash"], row["event"], row["error"]) == (HASHES[1], 2, "too steep")
    STUDY.run(tmp_path / "store")
    assert len(scripted_workers.tasks) == 3
    scripted_workers.answer = lambda task: outcome(task.hash)
    STUDY.run(tmp_path / "store", retry_failed=True)
    assert len(scripted_workers.tasks) == 4
    assert states(tmp_path / "store") == [("done", None)] * 3


def test_the_run_of_a_dead_worker_is_repeated(scripted_workers, tmp_path):
    died = []

    def die_once(task):
        if task.hash == HASHES[0] and not died:
            died.append(task)
            return RunOutcome(task.hash, "lost", error="the worker was killed")
        return outcome(task.hash)

    scripted_workers.answer = die_once
    STUDY.run(tmp_path / "store")
    assert len(scripted_workers.tasks) == 4
    assert states(tmp_path / "store") == [("done", None)] * 3


def test_a_run_whose_workers_always_die_fails(scripted_workers, tmp_path):
    scripted_workers.answer = lambda task: (
        RunOutcome(task.hash, "lost", error="the worker was killed by signal 9 (Killed)")
        if task.hash == HASHES[2]
        else outcome(task.hash)
    )
    STUDY.run(tmp_path / "store")
    status, error = states(tmp_path / "store")[2]
    assert status == "failed"
    assert error == "gave up after 3 attempts: the worker was killed by signal 9 (Killed)"


def test_a_failing_machine_stops_the_study_but_loses_no_results(scripted_workers, tmp_path):
    scripted_workers.answer = lambda task: (
        outcome(task.hash)
        if len(scripted_workers.tasks) < 3
        else RunOutcome(task.hash, "unable", error="checkpoint.bin: No space left on device")
    )
    with pytest.raises(StudyError, match=r"No space left on device; .* safe.*repeat"):
        STUDY.run(tmp_path / "store")
    assert scripted_workers.stopped and scripted_workers.closed
    assert sorted(status for status, _ in states(tmp_path / "store")) == [
        "done",
        "pending",
        "pending",
    ]
    scripted_workers.answer = lambda task: outcome(task.hash)
    resume(tmp_path / "store")
    assert states(tmp_path / "store") == [("done", None)] * 3


def test_runs_that_end_beside_an_unable_run_are_stored(scripted_workers, tmp_path, monkeypatch):
    """Two runs end at once, the first as unable; the third ends while the workers are stopped."""

    def unable_first(task):
        unable = task.hash == scripted_workers.tasks[0].hash
        return (
            RunOutcome(task.hash, "unable", error="no such file") if unable else outcome(task.hash)
        )

    def all_at_once(timeout):
        return [
            scripted_workers.answer(scripted_workers.open.pop(0))
            for _ in range(len(scripted_workers.open))
        ]

    scripted_workers.answer = unable_first
    monkeypatch.setattr(scripted_workers, "collect", all_at_once)
    with pytest.raises(StudyError, match="no such file"):
        STUDY.run(tmp_path / "store")
    assert scripted_workers.stopped and scripted_workers.closed
    assert [status for status, _ in states(tmp_path / "store")] == ["pending", "done", "done"]


def test_a_full_disk_while_storing_leaves_runs_pending(scripted_workers, tmp_path, monkeypatch):
    monkeypatch.setattr(session.Store, "record", _fill_disk_then_record(session.Store.record))
    with pytest.raises(StudyError, match="disk is full"):
        STUDY.run(tmp_path / "store")
    monkeypatch.undo()
    assert {status for status, _ in states(tmp_path / "store")} == {"pending"}
    with Store.open(tmp_path / "store") as store:
        assert not any(store.owners())


def _fill_disk_then_record(record):
    def full(store, result):
        (pages,) = store.read("PRAGMA page_count")[0]
        store.read(f"PRAGMA max_page_count = {pages}")
        record(store, outcome(result.hash, events=5000))

    return full


def test_an_interrupt_stores_ended_runs_and_says_how_to_resume(scripted_workers, tmp_path):
    study = tiny_study(frictions=(0.1, 0.2, 0.3, 0.4, 0.5))

    def interrupt(progress):
        if progress.done == 1:  # two are running, one of which ends before the signal is seen
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(StudyInterrupted, match="interrupted; resume with: snowshed study resume"):
        study.run(tmp_path / "store", progress=interrupt)
    assert scripted_workers.stopped
    assert sum(status == "done" for status, _ in states(tmp_path / "store")) == 3
    resume(tmp_path / "store")
    assert states(tmp_path / "store") == [("done", None)] * 5
    assert len(scripted_workers.tasks) == 5


def test_runs_of_another_process_are_waited_for(scripted_workers, tmp_path):
    with Store.create(tmp_path / "store") as store:
        store.register("tiny", STUDY.axes, STUDY.runs())
    claimed, may_finish = threading.Event(), threading.Event()

    def compute_slowly():
        with Store.open(tmp_path / "store") as own_store, ownership(own_store) as me:
            own_store.claim(HASHES[0], me)
            claimed.set()
            may_finish.wait(10)
            own_store.record(outcome(HASHES[0]))

    thread = threading.Thread(target=compute_slowly)
    thread.start()
    claimed.wait(10)
    reports = []

    def watch(progress):
        reports.append(progress)
        if progress.elsewhere == 1 and progress.done == 2:
            may_finish.set()

    STUDY.run(tmp_path / "store", progress=watch)
    thread.join()
    assert HASHES[0] not in {task.hash for task in scripted_workers.tasks}
    assert (reports[-1].done, reports[-1].elsewhere, reports[-1].fraction) == (3, 0, 1.0)


def test_runs_of_a_process_that_died_are_taken_over(scripted_workers, tmp_path):
    with Store.create(tmp_path / "store") as store:
        store.register("tiny", STUDY.axes, STUDY.runs())
        for hash_ in HASHES:
            store.claim(hash_, "somebody-dead")
    STUDY.run(tmp_path / "store")
    assert len(scripted_workers.tasks) == 3


def test_progress_reports_all_runs(scripted_workers, tmp_path):
    reports = []
    STUDY.run(tmp_path / "store", progress=reports.append)
    assert (reports[0].count, reports[0].done, reports[0].fraction) == (3, 0, 0.0)
    assert reports[0].expected_s > 0
    assert [progress.done for progress in reports] == sorted(progress.done for progress in reports)
    assert (reports[-1].done, reports[-1].running, reports[-1].fraction) == (3, 0, 1.0)


def test_leftovers_of_killed_processes_are_removed(scripted_workers, tmp_path):
    with Store.create(tmp_path / "store") as store:
        store.register("tiny", STUDY.axes, STUDY.runs())
        store.record(outcome(HASHES[0]))
        for name in (*HASHES[:2], "0" * 32):
            (store.running / name / "results").mkdir(parents=True)
        (store.running / "node-1-0123abcd.lock").touch()
        session._remove_leftovers(store)
        assert [path.name for path in store.running.iterdir()] == [HASHES[1]]
        with ownership(store):
            session._remove_leftovers(store)
            assert len(list(store.running.iterdir())) == 2
    STUDY.run(tmp_path / "store")
    assert not any((tmp_path / "store" / "running").iterdir())


def test_unfinished_runs_of_another_version_are_not_resumed(
    scripted_workers, tmp_path, monkeypatch
):
    with Store.create(tmp_path / "store") as store:
        store.register("tiny", STUDY.axes, STUDY.runs())
    monkeypatch.setattr(_core, "version", "99.0")
    with pytest.raises(InputError, match=r"this is 99\.0; start the study again with"):
        resume(tmp_path / "store")
    STUDY.run(tmp_path / "store")
    with Store.open(tmp_path / "store") as store:
        assert {run.version for run in store.runs("tiny")} == {"99.0"}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"jobs": 0}, "jobs: 0 is not positive"),
        ({"threads": -1}, "threads: -1 is not positive"),
        ({"scheduler": 3}, "scheduler: 3; needed: the address of a Dask scheduler, the path of"),
        ({"scheduler": ""}, "scheduler: ''; needed: the address"),
        ({"scheduler": True}, "scheduler: True; needed: the address"),
        ({"jobs": 2, "scheduler": "tcp://127.0.0.1:1"}, "jobs: not allowed with a scheduler"),
    ],
)
def test_wrong_resources_are_refused_without_files(tmp_path, options, message):
    with pytest.raises(InputError, match=message):
        STUDY.run(tmp_path / "store", **options)
    assert not (tmp_path / "store").exists()


def test_the_expected_duration_of_several_processes():
    assert cost_estimate.makespan([4.0], 2) == 4.0
    assert cost_estimate.makespan([1.0] * 6, 3) == 2.0
    assert cost_estimate.makespan([3.0, 3.0, 2.0, 2.0, 2.0], 2) == 7.0


def test_speeds_are_weighted_by_work(monkeypatch):
    """Nine runs of one unit, and one of 21 with half the speed, which gives two of three speeds."""
    monkeypatch.setattr(
        cost_estimate, "speed", lambda scene, threads: 1.0 if scene == "big" else 2.0
    )
    scenes, works = ["small"] * 9 + ["big"], [1.0] * 9 + [21.0]
    assert cost_estimate.expected_time(scenes, works, 1, 1) == pytest.approx(30 * (0.5 + 1 + 1) / 3)
    assert cost_estimate.expected_time(["small"], [0.0], 1, 1) == 0.0


def test_a_short_disturbance_does_not_change_the_estimate(monkeypatch):
    speeds = iter([2.0, 1.0, 2.0] + [2.0] * 24)
    monkeypatch.setattr(cost_estimate, "speed", lambda scene, threads: next(speeds))
    scenes, works = ["a", "b", "c"], [3600.0] * 3
    assert cost_estimate.expected_time(scenes, works, 1, 1) == 3 * 1800.0


def test_speed_is_measured_once_before_a_short_study(monkeypatch):
    measured = []
    monkeypatch.setattr(cost_estimate, "speed", lambda scene, _: measured.append(scene) or 1e9)
    cost_estimate.expected_time(["a", "b", "c"], [1.0] * 3, 1, 1)
    assert sorted(measured) == ["a", "b", "c"]


def test_the_estimate_of_work_agrees_with_plan():
    scene = STUDY.runs()[0].scene
    plan = _core.plan(scene)
    assert cost_estimate.work(scene) == pytest.approx(
        plan["expected_wall_s"] * plan["updates_per_s"]
    )
    assert cost_estimate.work(scene.replace('"dx": 0.02', '"dx": 1e-8')) == 0.0


def test_estimating_many_runs_is_fast():
    scenes = [run.scene for run in STUDY.runs()] * 10
    start = time.process_time()
    for scene in scenes:
        cost_estimate.work(scene)
    assert time.process_time() - start < 0.05 * len(scenes)


def test_notes_on_runs_are_reported_at_the_end_by_frequency(scripted_workers, tmp_path):
    numbers = iter(range(100))

    def noted(task):
        notes = ["the slab is thin", *(["one stays"] if next(numbers) == 0 else [])]
        return replace(outcome(task.hash), notes=notes)

    scripted_workers.answer = noted
    with pytest.warns(SnowshedNote), record_notes() as reported:
        STUDY.run(tmp_path / "store")
    runs = len(states(tmp_path / "store"))
    assert reported == [f"{runs} runs: the slab is thin", "1 run: one stays"]


def test_notes_of_earlier_results_are_told_again_in_one_summary(scripted_workers, tmp_path):
    scripted_workers.answer = lambda task: replace(outcome(task.hash), notes=["the slab is thin"])
    folder = tmp_path / "store"
    Study.product(tiny_scene(), {"panel.friction": [0.1]}, name="tiny").run(folder)
    wider = Study.product(tiny_scene(), {"panel.friction": [0.1, 0.2]}, name="tiny")
    for _ in range(2):  # with a run of each kind, then with earlier results only
        with pytest.warns(SnowshedNote), record_notes() as reported:
            wider.run(folder)
        assert reported == ["2 runs: the slab is thin"]
    assert len(scripted_workers.tasks) == 2


def test_the_errors_of_many_stacks_are_one_note_and_hide_no_other():
    errors = {f"{BEGINNING} in recorded runs ({cells} cells)": cells for cells in range(1, 20)}
    with record_notes() as notes:
        session._issue_run_notes(Counter({**errors, "nothing slid": 1}))
    assert notes == [
        "1 run: nothing slid",
        f"19 runs: {BEGINNING} in recorded runs (19 cells); 171 more have other errors",
    ]
