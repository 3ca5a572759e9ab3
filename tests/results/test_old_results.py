"""A results folder of the version before, interrupted in its second event, is resumed.

``old_results`` was written by ``snowshed run``; its run.json tells nothing of single events.
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


def test_python_goes_on_with_it(folder):
    first = read_events(folder)
    table = resume(folder)
    assert list(table.event) == [1, 2]
    assert (table.iloc[:1][list(first)] == first).all(axis=None)
    # Each row names the trimming rule of A.4.2 by which it was measured; the old one's has no name.
    assert table["trimming"].fillna("").tolist() == ["", "outermost_first"]
    assert table.damping_rate_per_s.isna().tolist() == [True, False]  # nobody wrote it then
    facts = json.loads((folder / "run.json").read_text())
    assert facts["status"] == "finished"
    assert table.steps.sum() == facts["steps"] and table.wall_s.sum() <= facts["wall_s"]


def test_the_executable_goes_on_with_it(folder):
    done = snowshed_run(folder / "scene.json", "-o", folder, "--resume", "-q")
    assert (done.returncode, done.stderr) == (0, "")
    assert list(resume(folder).event) == [1, 2]


def test_python_says_what_to_do_where_nothing_tells_of_an_event(folder):
    (folder / "events.csv").unlink()
    with pytest.raises(InputError, match=r"no record of event 1.*resume it with snowshed-run"):
        resume(folder)
    assert json.loads((folder / "run.json").read_text())["status"] == "interrupted"
