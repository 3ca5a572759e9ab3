import json
import shlex
import subprocess
import sys

import pytest
from helpers.paths import ROOT
from helpers.processes import modules_after
from made_up import made_up_case, program
from validation.framework import cases as listing
from validation.framework import measure
from validation.framework.case import Quantity

from snowshed.base.progress import Progress
from snowshed.snow.accuracy.recorded import load_recorded

HOLDING = (
    Quantity("height", "height, m", limit=0.2, limit_for={"transfer": "apic"}, order_in="dx"),
)


def made_up_measure_of_height_only(settings):
    outcome = made_up_case().measure(settings)
    return type(outcome)([outcome.measured[0]], outcome.wall_s, outcome.updates)


@pytest.fixture
def cases(monkeypatch):
    """Replace all cases by a made-up case, and return its settings, which tests change."""
    case_settings = {"quantities": HOLDING, "entries": None}

    def cases_of(module):
        case = made_up_case(**case_settings)
        object.__setattr__(case, "measure", made_up_measure_of_height_only)
        return [case]

    monkeypatch.setattr(listing, "case_modules", lambda: {"made_up": "validation.made_up.case"})
    monkeypatch.setattr(listing, "cases_of", cases_of)
    return case_settings


def validate(folder, *options):
    return program(*options, "--no-stress", "-o", folder)


def test_the_command_writes_a_report_and_its_summary(cases, tmp_path, capsys):
    assert validate(tmp_path / "out") == 0
    out, err = capsys.readouterr()
    assert "What holds" in out
    assert "17.6 %" in out
    assert str(tmp_path / "out" / "validation.html") in out
    assert "error" not in err
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        *("figures", "measurements.jsonl", "results.csv", "results.json", "validation.html"),
    ]


def test_full_takes_the_full_matrix(cases, tmp_path):
    assert validate(tmp_path / "out", "--full", "-q") == 0
    data = json.loads((tmp_path / "out" / "results.json").read_text())
    assert len(data["measurements"]) == 6
    assert data["about"]["suite"] == "full"


def test_the_exit_code_is_1_if_a_criterion_does_not_hold(cases, tmp_path, capsys):
    cases["quantities"] = (Quantity("height", "height, m", limit=0.1),)
    assert validate(tmp_path / "out", "-q") == 1
    assert capsys.readouterr() == (
        "",
        "error: A made-up case, height, m: demanded ≤ 10 %, worst 96 %, dx 0.2, pic\n",
    )


def test_the_exit_code_is_1_if_a_measurement_fails(cases, tmp_path, capsys):
    cases["entries"] = [{"dx": 0.1}, {"dx": 0.2, "mode": "raises"}]
    assert validate(tmp_path / "out", "-q") == 1
    assert "A made-up case, dx 0.2, raises: ValueError: no such snow" in capsys.readouterr().err


def test_bad_input_is_refused(cases, tmp_path, capsys):
    assert validate(tmp_path / "out", "--case", "other") == 2
    assert "--case other: no such case; there are made_up" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "precious.txt").touch()
    assert validate(tmp_path / "full") == 2
    assert "not empty" in capsys.readouterr().err
    assert validate(tmp_path / "nowhere", "--resume") == 2
    assert "nothing to resume" in capsys.readouterr().err
    assert program() == 2


def test_an_interrupted_suite_is_resumed(cases, tmp_path, capsys, monkeypatch):
    measured, count = measure.measure_once, iter(range(9))

    def interrupted(*request):
        if next(count) == 2:
            raise KeyboardInterrupt
        return measured(*request)

    monkeypatch.setattr(measure, "measure_once", interrupted)
    assert validate(tmp_path / "my out", "--case", "made_up") == 130
    message = capsys.readouterr().err.strip().splitlines()[-1]
    _, _, resume = message.partition("resume with: python -m validation ")
    assert program(*shlex.split(resume)) == 0
    measurements = (tmp_path / "my out" / "measurements.jsonl").read_text().splitlines()
    assert len(measurements) == len(set(measurements)) == 4


def test_measurements_can_be_recorded(cases, tmp_path):
    path = tmp_path / "recorded.json"
    assert validate(tmp_path / "out", "-q", "--record", path) == 0
    assert [measurement.case for measurement in load_recorded(path)] == ["made_up"] * 4


def test_the_stress_suite_runs_once_and_is_reported(cases, tmp_path, capsys, monkeypatch):
    import pandas as pd
    from validation import stress
    from validation.stress import SummaryTable

    calls = []

    def run(full, seed, progress):
        calls.append((full, seed))
        if progress is not None:
            progress(Progress(0.5, 1, 2, "runs"))
        outcomes = ["rest", "failed" if seed == 7 else "rest"]
        return pd.DataFrame({"outcome": outcomes, "message": [None, "x"], "n": [1.5, None]})

    def summarise(runs):
        return [SummaryTable("all", "All of them", "", runs)]

    monkeypatch.setattr(stress, "run", run)
    monkeypatch.setattr(stress, "summarise", summarise)
    out = tmp_path / "out"
    assert program("-o", out) == 0
    assert "All of them" in (out / "validation.html").read_text(encoding="utf-8")
    first = (out / "stress.csv").read_text()
    assert program("--resume", "-q", "-o", out) == 0
    assert (out / "stress.csv").read_text() == first
    assert calls == [(False, 1)]
    capsys.readouterr()
    assert program("--resume", "-q", "--full", "--seed", "7", "-o", out) == 1
    assert capsys.readouterr().err == "error: stress suite: 1 runs failed\n"
    assert calls[1:] == [(True, 7)]
    assert validate(tmp_path / "other", "--case", "made_up", "-q") == 0
    assert len(calls) == 2


def test_the_help_imports_no_heavy_module():
    heavy = {"jinja2", "matplotlib", "pandas", "rich", "scipy", "validation.framework.report"}
    assert heavy & modules_after("import validation.framework.command") == set()


@pytest.mark.parametrize("module", [["validation"], ["reproductions", "saito2012"]])
def test_the_package_runs_as_a_module(module):
    def run(*arguments):
        command = [sys.executable, "-m", *module, *arguments]
        return subprocess.run(command, cwd=ROOT, capture_output=True, text=True)

    printed = run("-h")
    assert (printed.returncode, printed.stderr) == (0, "")
    assert printed.stdout.startswith(f"Usage: python -m {' '.join(module)} [OPTIONS]")
    refused = run()
    assert (refused.returncode, refused.stdout) == (2, "")
    assert refused.stderr == "error: Missing option '-o' / '--output'.\n"
