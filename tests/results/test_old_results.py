"""A results folder of an earlier version, interrupted in its second event, is resumed.

``old_results`` was written by ``snowshed run``; its run.json does not record single events.
"""

import json
import shutil
from pathlib import Path

import pytest
from helpers.processes import snowshed_run

from snowshed import InputError, ResolvedScene, read_events, run_events

OLD = Path(__file__).with_name("old_results")


@pytest.fixture
def folder(tmp_path) -> Path:
    shutil.copytree(OLD, tmp_path / "results")
    return tmp_path / "results"


def resume(folder):
    scene = ResolvedScene.load(folder / "scene.json")
    return run_events(scene, folder, resume=True, pictures=False)


def test_python_resumes_an_old_folder(folder):
    first = read_events(folder)
    table = resume(folder)
    assert list(table.event) == [1, 2]
    assert (table.iloc[:1][list(first)] == first).all(axis=None)
    # New rows name the trimming rule (A.4.2) by which they were measured; old rows do not.
    assert table["trimming"].fillna("").tolist() == ["", "outermost_first"]
    assert table.damping_rate_per_s.isna().tolist() == [True, False]  # old rows lack it
    facts = json.loads((folder / "run.json").read_text())
    assert facts["status"] == "finished"
    assert table.steps.sum() == facts["steps"] and table.wall_s.sum() <= facts["wall_s"]


def test_the_executable_resumes_an_old_folder(folder):
    done = snowshed_run(folder / "scene.json", "-o", folder, "--resume", "-q")
    assert (done.returncode, done.stderr) == (0, "")
    assert list(resume(folder).event) == [1, 2]


def test_python_refuses_a_folder_without_a_record_of_an_event(folder):
    (folder / "events.csv").unlink()
    with pytest.raises(InputError, match=r"no record of event 1.*resume it with snowshed-run"):
        resume(folder)
    assert json.loads((folder / "run.json").read_text())["status"] == "interrupted"
