"""Texts of files and names reach the terminal without control codes; errors are one sentence."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest
from conftest import tiny_scene

from snowshed.base.messages import HARMFUL, printable
from snowshed.cli.main import main
from snowshed.cli.output.terminal import PlainConsole, plain_table
from snowshed.cli.start import main as start
from snowshed.io.csv_table import csv_text

HOSTILE = "\x1b[31mred\x9b\u202e[/a]"
COMMAND = [sys.executable, "-m", "snowshed"]
TINY = ["--preset", "lab-50", "--dim", "2", "--dx", "0.02", "--max-time", "0.05", "--events", "1"]


def test_a_console_prints_markup_and_control_codes_as_text(capsys):
    console = PlainConsole()
    table = plain_table(HOSTILE, [HOSTILE])
    table.add_row(HOSTILE)
    console.print(HOSTILE, table)
    console.note(HOSTILE)
    shown = capsys.readouterr().out
    assert not HARMFUL.search(shown) and shown.count("?[31mred??[/a]") == 5


@pytest.mark.parametrize("position", ["file", "key", "number"])
def test_errors_of_a_hostile_scene_are_one_line_of_text(tmp_path, capsys, position):
    data = json.loads(tiny_scene().resolve().json)
    if position == "file":
        shape = {"type": "mesh", "file": HOSTILE}
        data["obstacles"] = [{"name": "m", "shape": shape}]
    if position == "key":
        data[HOSTILE] = 1
    text = json.dumps(data, ensure_ascii=False)
    if position == "number":
        text = text.replace('"gravity": 9.81', f'"gravity": {"9" * 1_000_000}')
    (tmp_path / "scene.json").write_text(text)
    assert main(["run", str(tmp_path / "scene.json"), "-o", str(tmp_path / "out"), "-q"]) == 2
    message = capsys.readouterr().err
    assert message.startswith("error: ") and message.count("\n") == 1 and len(message) < 5000
    assert not HARMFUL.search(message)


def test_folder_names_may_contain_markup(tmp_path, capsys):
    assert main(["panel", *TINY, "-o", str(tmp_path / "out[/a]")]) == 0
    assert "out[/a]" in "".join(capsys.readouterr().out.split())


def test_impossible_file_names_are_refused_before_the_computation(tmp_path, capsys):
    (tmp_path / "loop").symlink_to("loop")
    scene = tmp_path / "scene.json"
    tiny_scene().resolve().save(scene)
    for name in (os.fsdecode(b"bad\xff"), "x" * 300, "loop"):
        assert main(["run", str(scene), "-o", str(tmp_path / name)]) == 2
        assert main(["scene", *TINY, "-o", str(tmp_path / name)]) == 2
        assert main(["run", str(tmp_path / name), "-o", str(tmp_path / "out")]) == 2
    assert capsys.readouterr().err.count("error: ") == 9
    assert sorted(path.name for path in tmp_path.iterdir()) == ["loop", "scene.json"]


def test_csv_files_contain_no_formulas():
    table = pd.DataFrame({"=A1": ["=HYPERLINK(1)", "@x", "-1.5", None], "b": [-1.0, 2, 3, 4]})
    lines = csv_text(table).splitlines()
    assert lines == ["'=A1,b", "'=HYPERLINK(1),-1.0", "'@x,2.0", "-1.5,3.0", ",4.0"]
    assert printable("a\tb\nc") == "a\tb\nc"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_every_signal_that_ends_a_run_leaves_a_checkpoint(tmp_path, number):
    scene = tiny_scene(**{"events.count": 30, "events.max_time": 1.0})
    scene.resolve().save(tmp_path / "scene.json")
    out = tmp_path / "out"
    run = subprocess.Popen([*COMMAND, "run", tmp_path / "scene.json", "-o", out, "-q"],
                           stderr=subprocess.PIPE, text=True)  # fmt: skip
    while not (out / "checkpoint.bin").exists() and run.poll() is None:
        time.sleep(0.01)
    run.send_signal(number)
    assert "interrupted; resume with: " in run.communicate()[1] and run.returncode == 130
    assert json.loads((out / "run.json").read_text())["status"] == "interrupted"


@pytest.mark.parametrize("program", ["snowshed", "snowshed-run"])
def test_an_interrupt_stops_the_seeding(tmp_path, program):
    """The seeding takes minutes; the interrupt acts long before its end."""
    scene = tiny_scene(dimension=3, **{"numerics.dx": 0.002, "seeding.particles_per_voxel": 64})
    scene.resolve().save(tmp_path / "scene.json")
    words = ["snowshed-run"] if program == "snowshed-run" else [*COMMAND, "run"]
    words[0] = words[0].replace("snowshed-run", f"{sys.prefix}/bin/snowshed-run")
    run = subprocess.Popen([*words, tmp_path / "scene.json", "-o", tmp_path / "out", "-q"],
                           stderr=subprocess.PIPE, text=True)  # fmt: skip
    ticks = os.sysconf("SC_CLK_TCK")
    while run.poll() is None and used_s(run.pid, ticks) < 3.0:
        time.sleep(0.05)
    used_before = used_s(run.pid, ticks)
    run.send_signal(signal.SIGINT)
    while run.poll() is None:
        taken = used_s(run.pid, ticks) - used_before
        assert taken < 10.0, "the interrupt was not heard"
        time.sleep(0.05)
    assert run.returncode == 130 and "interrupted" in run.communicate()[1]
    assert not (tmp_path / "out").exists()


def used_s(process, ticks):
    """Return the processor time of a process, s; other load of the machine does not change it."""
    try:
        words = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(words[11]) + int(words[12])) / ticks


def test_a_wrapped_interrupt_is_recognised(monkeypatch, capsys):
    """Python wraps errors that occur while a class is created (``Error calling __set_name__``)."""

    class Field:
        def __set_name__(self, owner, name):
            raise KeyboardInterrupt

    monkeypatch.setattr("snowshed.cli.main.main", lambda: type("Made", (), {"field": Field()}))
    assert start() == 130
    assert capsys.readouterr().err == "error: interrupted\n"
    monkeypatch.setattr("snowshed.cli.main.main", lambda: [][0])
    with pytest.raises(IndexError):
        start()
