"""The commands of grains that compute many tests, and snow from a file."""

import json

import numpy as np
import pytest
from helpers.grain_files import VOXEL, column_of_grains

from snowshed.cli.main import main


@pytest.fixture
def samples(tmp_path):
    """Two samples of equal density, with holes at different positions."""
    files = [tmp_path / f"{name}.npy" for name in "ab"]
    for number, file in enumerate(files):
        labels = column_of_grains(4, 4).repeat(4, 1).repeat(4, 2)
        labels[:, 5 + number, 6] = 0
        np.save(file, labels)
    return [str(file) for file in files]


def run(*arguments):
    return main(["grains", *map(str, arguments)])


@pytest.mark.parametrize(("command", "tests"), [("sensitivity", 26), ("material", 8)])
def test_a_dry_run_counts_the_tests(samples, tmp_path, capsys, command, tests):
    assert run(command, *samples, "--voxel", VOXEL, "-o", tmp_path / "out", "--dry-run") == 0
    shown = capsys.readouterr().out
    assert f"{tests} runs" in shown
    assert not (tmp_path / "out/runs").exists()


def test_turning_makes_three_samples_of_each(samples, tmp_path, capsys):
    options = ("--voxel", VOXEL, "-o", tmp_path / "out", "--dry-run", "--turned")
    assert run("material", *samples, *options) == 0
    assert "20 runs" in capsys.readouterr().out
    assert len(list((tmp_path / "out/samples").glob("*.npy"))) == 6


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("sensitivity", "{a}"), "the edge of a voxel is not known"),
        (("sensitivity", "{a}", "{a}", "--voxel", "1e-4"), "two samples are called a"),
        (("sensitivity", "{a}", "--voxel", "1e-4", "--coarser", "3"), "3 times coarser"),
        (("sensitivity", "{a}", "--voxel", "1e-4", "--finer"), "needs coarser above 1"),
        (("sensitivity", "none.npy", "--voxel", "1e-4"), "none.npy"),
        (("material", "{a}", "--voxel", "1e-4", "--modulus", "-1"), "--modulus"),
        (("material", "{a}", "--voxel", "-1"), "voxel"),
    ],
)
def test_bad_input_ends_with_2_and_is_named(samples, tmp_path, capsys, arguments, message):
    completed = [argument.format(a=samples[0]) for argument in arguments]
    assert run(*completed, "-o", tmp_path / "out", "--dry-run") == 2
    assert message in capsys.readouterr().err


def test_a_scene_can_use_the_snow_of_a_file(tmp_path, capsys):
    snow = {"density": 180.0, "preconsolidation_pressure": 3e3, "provenance": {"made": "by hand"}}
    file = tmp_path / "mine.json"
    file.write_text(json.dumps(snow))
    assert main(["scene", "--preset", "lab-50", "--snow", str(file), "--cohesion", "0.3"]) == 0
    data = json.loads(capsys.readouterr().out)["snow"]
    assert (data["density"], data["preconsolidation_pressure"], data["cohesion"]) == (180, 3e3, 0.3)
    assert "provenance" not in data
    file.write_text('{"density": -1}')
    assert main(["scene", "--preset", "lab-50", "--snow", str(file)]) == 2
    assert "density" in capsys.readouterr().err
    file.write_text("[1]")
    assert main(["scene", "--preset", "lab-50", "--snow", str(file)]) == 2
    assert "mine.json" in capsys.readouterr().err
