"""The announcement of long runs: at the first measured speed, once, without further simulations."""

import pytest

import snowshed._core as _core
from snowshed import Scene
from snowshed.base.formatting import about
from snowshed.base.progress import Progress
from snowshed.cli.main import main
from snowshed.cli.run_scene import ANNOUNCED_FROM_S, announcing_long_run
from snowshed.scene.builders.slides import example_slide

LAB = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02}).resolve()
WORK = _core.expected_work(LAB.core)  # particle updates


def announced(capsys, scene, *speeds):
    """Return the lines on stderr after reports with these speeds, in updates per second."""
    reported = []
    report = announcing_long_run(scene, reported.append)
    for speed in speeds:
        report(Progress(0.1, 0, 5, "events", updates_per_s=speed))
    assert [progress.updates_per_s for progress in reported] == list(speeds)
    return capsys.readouterr().err.splitlines()


def test_a_long_run_is_announced_once_at_its_first_measured_speed(capsys):
    [line] = announced(capsys, LAB, 0.0, WORK / 7200, WORK / 9000)
    assert line.startswith(f"note: this takes {about(7200)}; Ctrl-C stops it") and "--dx" in line


@pytest.mark.parametrize(
    ("seconds", "lines"), [(0.99 * ANNOUNCED_FROM_S, 0), (1.01 * ANNOUNCED_FROM_S, 1)]
)
def test_only_runs_over_the_limit_are_announced(capsys, seconds, lines):
    assert len(announced(capsys, LAB, WORK / seconds)) == lines


def test_a_slide_is_not_announced(capsys, tmp_path):
    scene = example_slide(tmp_path).resolve()
    assert announced(capsys, scene, 1e-9) == []


def test_a_run_simulates_only_its_scene(tmp_path, monkeypatch):
    def refuse(*_):
        raise AssertionError("the run measures its speed on another simulation")

    monkeypatch.setattr(_core, "plan", refuse)
    options = ["--dim", "2", "--dx", "0.02", "--events", "1"]
    assert main(["panel", "--preset", "lab-50", *options, "-o", str(tmp_path / "out")]) == 0
