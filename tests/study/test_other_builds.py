"""Results of another build are not taken for those of this one, and are not lost."""

import pytest
import study_helpers
from study_helpers import outcome, tiny_study

from snowshed import InputError, SnowshedNote
from snowshed.study import compute as worker
from snowshed.study import resume
from snowshed.study import store as stores
from snowshed.study.outcome import RunTask
from snowshed.study.store import Store

scripted_workers = study_helpers.scripted_workers  # a fixture

STUDY = tiny_study()
OTHER = "000000000000-000000000000"


@pytest.fixture
def folder(tmp_path, scripted_workers, monkeypatch):
    """A store whose runs another build has computed."""
    with monkeypatch.context() as other:
        other.setattr(stores, "build_id", lambda: OTHER)
        STUDY.run(tmp_path / "store")
    scripted_workers.tasks.clear()
    return tmp_path / "store"


def test_runs_of_another_build_are_computed_again_with_a_note(folder, scripted_workers):
    with pytest.warns(SnowshedNote, match="^3 runs of tiny: computed by another build"):
        table = STUDY.run(folder)
    assert len(scripted_workers.tasks) == 3
    assert OTHER not in set(table.build)


def test_on_request_the_same_version_is_enough(folder, scripted_workers):
    table = STUDY.run(folder, same_version=True)
    assert scripted_workers.tasks == [] and set(table.build) == {OTHER}


def test_earlier_results_stay_in_the_store(folder, scripted_workers):
    scripted_workers.answer = lambda task: outcome(task.hash, "failed", 0, "worse")
    with pytest.warns(SnowshedNote):
        STUDY.run(folder)
    with Store.open(folder) as store:
        aside = store.read("SELECT hash, status FROM run WHERE build = ?", (OTHER,))
        events = store.read("SELECT DISTINCT hash FROM event WHERE hash LIKE ?", (f"% {OTHER}",))
        assert store.find(STUDY.runs()[0].hash[:8]).status == "failed"
    assert [status for _, status in aside] == ["done"] * 3
    assert {name for name, _ in aside} == {name for (name,) in events}


def test_pending_runs_of_another_build_are_resumed_on_request_only(
    tmp_path, scripted_workers, monkeypatch
):
    with monkeypatch.context() as other:
        other.setattr(stores, "build_id", lambda: OTHER)
        with Store.create(tmp_path / "store") as store:
            store.register("tiny", STUDY.axes, STUDY.runs())
    with pytest.raises(InputError, match=r"for another build .* `same_version=True`"):
        resume(tmp_path / "store")
    resume(tmp_path / "store", same_version=True)
    with Store.open(tmp_path / "store") as store:
        assert {run.status for run in store.runs("tiny")} == {"done"}
        assert OTHER not in {run.build for run in store.runs("tiny")}


def test_a_worker_of_another_build_computes_nothing(tmp_path):
    run = STUDY.runs()[0]
    done = worker.compute(RunTask(run.hash, run.scene, str(tmp_path / "run"), 1, build=OTHER))
    assert done.status == "unable" and "another build of snowshed" in str(done.error)


def test_failed_runs_are_told_in_python(tmp_path, scripted_workers):
    scripted_workers.answer = lambda task: outcome(task.hash, "failed", 0, "too steep")
    with pytest.warns(SnowshedNote, match="^3 of 3 runs failed: .* too steep"):
        STUDY.run(tmp_path / "store")
