"""The command: its exit codes, resuming, and the docs of its options."""

import re
import signal
import subprocess
import sys
import sysconfig
import time
from dataclasses import replace
from pathlib import Path

from helpers.paths import ROOT
from helpers.processes import modules_after
from reproduce_helpers import geometry_table
from reproductions.common.command import command_of
from reproductions.frischholz2023 import studies

from snowshed import Scene
from snowshed.cli.commands import reproduce as source
from snowshed.cli.main import main
from snowshed.study import Study

DOCS = ROOT / "docs" / "trust" / "reproduce.md"


def run(*arguments):
    return main(["reproduce", "thesis", *map(str, arguments)])


def test_every_option_is_in_the_docs():
    text = DOCS.read_text(encoding="utf-8")
    for option in command_of("frischholz2023", "thesis").params:
        for name in option.opts[-1:] + option.secondary_opts:
            assert re.search(rf"`{name}[ `]", text), name


def test_the_command_line_does_not_import_reproductions():
    assert "reproductions" not in modules_after("import snowshed.cli.main")


def test_without_the_source_the_command_says_how_to_get_it(tmp_path, capsys, monkeypatch):
    for name in [name for name in sys.modules if name.partition(".")[0] == "reproductions"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setattr(source, "SOURCE", tmp_path)
    monkeypatch.setattr(
        sys, "path", [folder for folder in sys.path if Path(folder or ".").resolve() != ROOT]
    )
    assert run("-o", tmp_path / "out") == 2
    assert capsys.readouterr().err == (
        "error: reproduce thesis comes with the source of snowshed, not with the installed "
        "package: run `make build` there\n"
    )
    assert not (tmp_path / "out").exists()


def test_a_folder_of_the_same_name_is_not_taken_for_the_source(tmp_path):
    (tmp_path / "reproductions").mkdir()
    program = Path(sysconfig.get_path("scripts")) / "snowshed"
    command = [program, "reproduce", "thesis", "--help"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("Usage: snowshed reproduce thesis [OPTIONS]")


def test_bad_input_is_refused(tmp_path, capsys):
    geometry_table(tmp_path / "rows.csv")
    content = (tmp_path / "rows.csv").read_bytes()
    (tmp_path / "half.csv").write_bytes(content[: len(content) // 2])
    (tmp_path / "bytes.csv").write_bytes(bytes(range(128, 256)))
    for arguments, message in (
        (
            ("-o", tmp_path / "c", "--table", tmp_path / "half.csv"),
            "half.csv, line 37: not a",
        ),
        (
            ("-o", tmp_path / "c", "--table", tmp_path / "bytes.csv"),
            "bytes.csv, line 1: not a",
        ),
        ((), "--output"),
        (("-o", tmp_path / "a", "--stage", "x"), "stage: 'x' is unknown"),
        (("-o", tmp_path / "a", "--full"), "take a new folder for --full"),
        (("-o", tmp_path / "b", "--table", tmp_path / "none.csv"), "none.csv: No such file"),
    ):
        assert run(*arguments) == 2
        assert message in capsys.readouterr().err
    assert not (tmp_path / "c").exists()


def small_studies(size):
    scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.03})
    scene.update({"events": {"count": 1, "max_time": 0.05}})
    return [Study.product(scene, {"snow.cohesion": [0.15, 0.3]}, name=studies.INDEX, seeds=[1, 2])]


def test_a_stage_of_real_snow(tmp_path, capsys, monkeypatch):
    """The tiny runs end while snow is in the air; the second call computes nothing."""
    from reproductions.frischholz2023 import stages

    monkeypatch.setitem(stages.MAKERS, "s-index", small_studies)
    table = geometry_table(tmp_path / "rows.csv")
    out = tmp_path / "out"
    options = ("-o", out, "--stage", "s-index", "--jobs", "1", "--table", table)
    for _ in range(2):
        assert run(*options) == 0
        output = capsys.readouterr()
        assert "The effect of β on the height is positive." in output.out
    assert "expected time" not in output.err
    assert (out / "thesis.html").is_file() and (out / "s-index" / "s.csv").is_file()


def test_failed_simulations_have_an_exit_code(tmp_path, capsys, monkeypatch):
    from reproductions.common.stage import StudyStage

    table = geometry_table(tmp_path / "rows.csv")
    state = StudyStage.state
    monkeypatch.setattr(StudyStage, "state", lambda self: replace(state(self), failed=2))
    assert run("-o", tmp_path / "out", "--report-only", "--table", table, "-q") == 3
    assert "simulations failed: 2 of lab" in capsys.readouterr().err


def test_an_interrupt_exits_with_130_and_says_how_to_resume(tmp_path):
    table = geometry_table(tmp_path / "rows.csv")
    out = tmp_path / "out"
    command = [sys.executable, "-m", "snowshed", "reproduce", "thesis", "-o", str(out)]
    command += ["--stage", "lab", "--jobs", "1", "--table", str(table)]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 120
    while not list(out.glob("runs/running/*")) and time.monotonic() < deadline:
        assert process.poll() is None
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    _, message = process.communicate(timeout=120)
    assert process.returncode == 130
    assert "interrupted; the same command resumes" in message
