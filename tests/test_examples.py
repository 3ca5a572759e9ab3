"""Every example runs, on coarse grids within a second or two."""

import re
import subprocess
import sys

import pytest
from helpers.paths import ROOT

from snowshed import Scene, read_events, run_events
from snowshed.cli.main import main

EXAMPLES = ROOT / "examples"
ARGUMENTS = {
    "custom_obstacles.py": ["out", "0.05"],
    "dimension_ratio.py": ["out", "0.03", "1"],
    "image_to_stack.py": ["out", "18", "2", "0.05"],
    "in_memory.py": ["out", "0.02"],
    "own_laws.py": ["out", "0.02"],
    "panel_2d.py": ["out", "0.02"],
    "resume.py": ["out", "0.02"],
    "slab_and_bonds.py": ["out", "1.0"],
    "slide_dam.py": ["out", "1.0"],
}
#: Scripts that take most of a minute.
LONG = {"image_to_stack.py"}
#: The notes on thin slabs, which coarse grids cause, on the error of stacks, on laws, and on slides
#: of a second, and the lines that caused them.
NOTE = re.compile(
    r".*: (?:Resolution|Result|Snowshed)Note: (the slab is .* thick, less than|laws of the user|"
    r"error of the stack|Secondary release .* never started|Dam .*: no snow|"
    r"The slide was still moving).*\n.*\n"
)


def test_all_scripts_are_run():
    assert set(ARGUMENTS) == {path.name for path in EXAMPLES.glob("*.py")}


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=[pytest.mark.slow] if n in LONG else []) for n in ARGUMENTS]
)
def test_a_script_runs(name, tmp_path):
    command = [sys.executable, EXAMPLES / name, *ARGUMENTS[name]]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert NOTE.sub("", done.stderr) == ""
    assert "event" in done.stdout
    assert (tmp_path / "out").is_dir() and len(list(tmp_path.iterdir())) == 1
    for folder in {path.parent for path in tmp_path.rglob("events.csv")}:
        assert (folder / "stack.png").exists() and len(read_events(folder)) >= 1
    if name == "dimension_ratio.py":
        assert main(["compare", str(tmp_path / "out/2d"), str(tmp_path / "out/3d")]) == 0


@pytest.mark.parametrize("scene", sorted(EXAMPLES.glob("scenes/*.json")), ids=lambda p: p.stem)
def test_a_scene_runs(scene, tmp_path, capsys):
    assert main(["plan", str(scene)]) == 0
    assert "particles" in capsys.readouterr().out
    loaded = Scene.load(scene)
    size = type(loaded.numerics).RESOLUTION
    coarse = loaded.update({f"numerics.{size}": 0.025, "events.max_time": 0.1})
    table = run_events(coarse, tmp_path / "out", pictures=False)
    assert table.event.iloc[-1] == coarse.resolve().data["events"]["count"]
