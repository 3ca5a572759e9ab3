"""The commands ``snowshed study ...``."""

import json
import subprocess
import sys

import pytest
import study_helpers
from study_helpers import outcome, tiny_study

from snowshed import Scene
from snowshed.base.progress import Progress
from snowshed.cli.compute_study import announcement
from snowshed.cli.main import main
from snowshed.study.store import Store

scripted_workers = study_helpers.scripted_workers  # a fixture

FILE = """
name = "tiny"
dimension = 2
events = 2
[scene]
preset = "lab-50"
events.max_time = 0.05
[accuracy]
dx = 0.02
[axes]
panel.friction = [0.1, 0.2, 0.3]
"""
HASHES = [run.hash for run in tiny_study().runs()]


@pytest.fixture
def file(tmp_path):
    file = tmp_path / "study.toml"
    file.write_text(FILE)
    return file


def run(*arguments):
    return main(["study", *map(str, arguments)])


def test_a_study_runs_from_its_file_to_a_table(tmp_path, file, capsys):
    folder = tmp_path / "store"
    assert run("run", file, "-o", folder, "--jobs", 1, "--threads", 1) == 0
    output = capsys.readouterr()
    assert "3 runs to compute, 1 at once; expected time: " in output.err
    assert "3 of 3 runs done" in output.out
    assert run("status", folder) == 0
    assert capsys.readouterr().out.split() == ["tiny:", "3", "runs", "3", "done"]
    assert run("export", folder, "-o", tmp_path / "table.csv") == 0
    assert len((tmp_path / "table.csv").read_text().splitlines()) == 7
    assert run("picture", folder) == 0
    assert capsys.readouterr().out == f"{folder / 'study.png'}\n"
    assert (folder / "study.png").read_bytes().startswith(b"\x89PNG")
    assert run("run", file, "-o", folder, "-q") == 0
    assert capsys.readouterr() == ("", "")


def test_the_template_is_a_study(tmp_path, capsys):
    assert run("template") == 0
    text = capsys.readouterr().out
    assert run("template", "-o", tmp_path / "study.toml") == 0
    assert (tmp_path / "study.toml").read_text() == text
    assert run("plan", tmp_path / "study.toml", "--jobs", 1) == 0
    output = capsys.readouterr().out
    assert "cohesion-and-slope: 18 runs, 1 at once, about" in output
    assert "snow.cohesion, snow.critical_state_slope" in output


def test_the_status_of_an_empty_store_is_an_error(tmp_path, capsys):
    (tmp_path / "store.sqlite").touch()
    assert run("status", tmp_path) == 2
    assert capsys.readouterr().err.startswith(f"error: {tmp_path}: holds no study")


def test_the_status_lists_the_runs_of_an_unfinished_study(tmp_path, capsys):
    with Store.create(tmp_path / "store") as store:
        store.register("tiny", [], tiny_study().runs())
        store.record(outcome(HASHES[1], "failed", 1, "broken [/]"))
    assert run("status", tmp_path / "store") == 0
    output = capsys.readouterr().out
    assert output.splitlines() == [
        "tiny: 3 runs",
        "       0 done",
        "       1 failed",
        "       2 to compute",
        f"  {HASHES[1][:12]} failed: broken [/]",
    ]
    assert run("export", tmp_path / "store", "-o", tmp_path / "t.csv") == 0
    assert "2 of 3 runs are not computed yet" in capsys.readouterr().err


def test_failed_runs_are_listed_with_exit_code_3(tmp_path, scripted_workers, file, capsys):
    scripted_workers.answer = lambda task: (
        outcome(task.hash, "failed", 1, "broken") if task.hash == HASHES[1] else outcome(task.hash)
    )
    assert run("run", file, "-o", tmp_path / "store") == 3
    output = capsys.readouterr()
    assert f"{HASHES[1][:12]} failed: broken" in output.out
    assert output.err.endswith(f"error: 1 of 3 runs failed: {HASHES[1][:12]}\n")
    assert run("resume", tmp_path / "store", "-q") == 3
    assert len(scripted_workers.tasks) == 3
    scripted_workers.answer = lambda task: outcome(task.hash)
    assert run("resume", tmp_path / "store", "--study", "tiny", "--retry-failed", "-q") == 0
    assert len(scripted_workers.tasks) == 4


def test_the_scene_of_a_run_is_printed_and_saved(tmp_path, capsys):
    with Store.create(tmp_path / "store") as store:
        store.register("tiny", [], tiny_study().runs())
    assert run("scene", tmp_path / "store", HASHES[2][:10]) == 0
    assert json.loads(capsys.readouterr().out)["panel"]["friction"] == 0.3
    assert run("scene", tmp_path / "store", HASHES[2], "-o", tmp_path / "scene.json") == 0
    assert Scene.load(tmp_path / "scene.json").resolve().data["panel"]["friction"] == 0.3


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run", "none.toml", "-o", "out"], "none.toml: No such file"),
        (["run", "bad.toml", "-o", "out"], "bad.toml: panel.tlt: /panel/tlt: unknown key"),
        (["run", "study.toml"], "--output"),
        (["run", "study.toml", "-o", "full"], "full: not empty, but holds no study"),
        (["run", "study.toml", "-o", "out", "--jobs", "0"], "jobs: 0 is not positive"),
        (["run", "study.toml", "-o", "out", "--jobs", "x"], "--jobs"),
        (["resume", "full"], "full: holds no study"),
        (["resume", "out"], "out: holds no study"),
        (["status", "out"], "out: holds no study"),
        (["export", "out", "-o", "t.csv"], "out: holds no study"),
        (["export", "out", "-o", "t.csv", "--format", "xml"], "'xml' is not one of"),
        (["scene", "out", "12"], "out: holds no study"),
        (["fly"], "fly"),
    ],
)
def test_bad_input_gives_one_line_code_2_and_no_files(
    tmp_path, monkeypatch, capsys, file, arguments, message
):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.toml").write_text(FILE + "panel.tlt = [1]")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "thesis.txt").touch()
    before = sorted(tmp_path.rglob("*"))
    assert run(*arguments) == 2
    output = capsys.readouterr()
    assert output.out == ""
    assert output.err.startswith("error: ") and output.err.count("\n") == 1
    assert message in output.err
    assert sorted(tmp_path.rglob("*")) == before


def test_help_of_other_commands_does_not_load_the_studies():
    code = (
        "import sys; from snowshed.cli.main import main; main(['--help']); "
        "print([name for name in sys.modules if name.startswith(('snowshed.study', 'sqlite3'))])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "study " in done.stdout
    assert done.stdout.endswith("[]\n")


def progress(**values):
    defaults = {"fraction": 0.0, "done": 0, "count": 12, "unit": "runs", "at_once": 2}
    return Progress(**{**defaults, "expected_s": 95.0, **values})


def test_announcements_and_progress_of_a_study():
    def first_line(facts):  # a second line may warn of slow kernels
        return announcement(facts).partition("\nnote: ")[0]

    assert first_line(progress()) == "12 runs to compute, 2 at once; expected time: about 95 s"
    assert first_line(progress(done=10, failed=1)) == (
        "1 run to compute (11 of 12 are done already), 2 at once; expected time: about 95 s"
    )
    assert progress(done=3, running=2).description == "3/12 runs, 2 running"
    assert progress(done=3, failed=1, elsewhere=4).description == (
        "3/12 runs, 1 failed, 4 in other processes"
    )
