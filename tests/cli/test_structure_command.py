"""``snowshed structure``: the builders on the command line."""

import os
import subprocess
import sys

import numpy as np
import pytest

from snowshed import ResolvedScene
from snowshed.cli.commands.structure import STRUCTURES
from snowshed.cli.main import main
from snowshed.io.raster.output import write_raster
from snowshed.io.raster.raster import Raster
from snowshed.scene import gable_roof, on_terrain, single_panel, tracker

TETRAHEDRON = "v 0 0 1\nv 2 0 1\nv 0 2 1\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


@pytest.mark.parametrize("name", STRUCTURES)
def test_the_example_of_each_structure_writes_a_scene(name, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "carport.stl").write_text("")
    (tmp_path / "carport.obj").write_text(TETRAHEDRON)
    example = STRUCTURES[name].example.replace(".stl", ".obj").split()
    assert main(["structure", name, *example, "-o", "scene.json"]) == 0
    assert capsys.readouterr().out == "scene.json\n"
    assert ResolvedScene.load(tmp_path / "scene.json").data["numerics"]["dx"] > 0


def test_options_are_the_arguments_of_the_builder(tmp_path):
    file = tmp_path / "roof.json"
    words = "--eaves 2.5 --length 3 --tilt 40 --snow 0.25 --guards 0.4,1.5 --width 4 --dx 0.05"
    assert main(["structure", "gable-roof", *words.split(), "-o", str(file)]) == 0
    expected = gable_roof(
        eaves=2.5, length=3, tilt=40, snow=0.25, guards=[0.4, 1.5], width=4, dx=0.05
    )
    assert ResolvedScene.load(file).data == expected.resolve().data
    words = "--axis-height 1.5 --length 2 --snow 0.1 --tilt-from -10 --tilt-to 45"
    assert main(["structure", "tracker", *words.split(), "-o", str(file)]) == 0
    expected = tracker(axis_height=1.5, length=2, snow=0.1, tilt_from=-10, tilt_to=45)
    assert ResolvedScene.load(file).data == expected.resolve().data


def test_a_scene_is_placed_on_terrain(tmp_path):
    panel = single_panel(height=1.0, length=1.0, tilt=40.0, snow=0.1, dx=0.1)
    panel.resolve().save(tmp_path / "panel.json")
    hill = Raster(np.arange(12.0)[:, None] * np.ones(12), 0.0, 0.0, 1.0)
    write_raster(tmp_path / "hill.asc", hill)
    words = ["terrain", tmp_path / "panel.json", tmp_path / "hill.asc", "--origin", 5, 8]
    words += ["--azimuth", 180, "--x", -1, 3, "-o", tmp_path / "on.json"]
    assert main(["structure", *map(str, words)]) == 0
    position = {"origin": (5, 8), "azimuth": 180, "x": (-1, 3)}
    expected = on_terrain(panel, tmp_path / "hill.asc", tmp_path / "expected.npy", **position)
    by_command, by_function = np.load(tmp_path / "on.npy"), np.load(tmp_path / "expected.npy")
    assert np.array_equal(by_command, by_function)
    scene = ResolvedScene.load(tmp_path / "on.json").data
    assert scene["obstacles"][0]["shape"]["file"].endswith("on.npy")
    assert len(scene["obstacles"]) == len(expected.obstacles)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("tracker --axis-height 0.1 --length 2 --snow 0.1", "--axis-height: 0.1 m is not allowed"),
        ("tracker --length 2 --snow 0.1", "'--axis-height'"),
        ("rows --count 1 --pitch 4 --height 1 --length 1 --tilt 9 --snow 1", "--count: 1 is not"),
        (
            "gable-roof --eaves 2 --length 3 --tilt 40 --snow 0.2 --guards 0.4,x",
            "'--guards': '0.4,x'; needed: numbers with commas",
        ),
        (
            "tracker --axis-height 1.5 --length 2 --snow 0.1 --picture p.xyz",
            "--picture: p.xyz; allowed: .png, .svg, .pdf",
        ),
    ],
)
def test_wrong_structures_are_refused(words, message, tmp_path, capsys):
    assert main(["structure", *words.split(), "-o", str(tmp_path / "scene.json")]) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "scene.json").exists()


@pytest.mark.parametrize("group", ["structure", "study", "grains"])
def test_a_group_without_a_command_prints_its_help(group, capsys):
    assert main([group]) == 0
    shown = capsys.readouterr()
    assert shown.err == "" and shown.out.count("\n") > 8


@pytest.mark.parametrize(
    ("typed", "offers"),
    [
        ("snowshed pan", ["plain,panel"]),
        ("snowshed panel --preset lab", ["plain,lab-40", "plain,lab-50"]),
        ("snowshed scene --snow cal", ["plain,calibrated"]),
        ("snowshed scene --snow mine.j", ["file,mine.j"]),
        ("snowshed structure gab", ["plain,gable-roof"]),
    ],
)
def test_the_shell_completes_names(typed, offers):
    words = typed.split()
    completion = {"_SNOWSHED_COMPLETE": "bash_complete", "COMP_WORDS": typed}
    command = [sys.executable, "-c", "from snowshed.cli.start import main; main()"]
    done = subprocess.run(
        command,
        env={**os.environ, **completion, "COMP_CWORD": str(len(words) - 1)},
        capture_output=True,
        text=True,
    )
    assert done.stdout.split() == offers
