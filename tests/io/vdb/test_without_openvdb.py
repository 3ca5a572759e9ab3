"""Messages of a build without OpenVDB, or of any build without its program."""

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import tiny_scene

from snowshed import InputError, _core
from snowshed.cli.main import main
from snowshed.io import write_vdb
from snowshed.io.vdb import program

INSTALL = r"built; install it \(Debian, Ubuntu: libopenvdb-dev libboost-dev\) and build snowshed"


@pytest.fixture
def no_program(monkeypatch, tmp_path):
    monkeypatch.setattr(program, "PROGRAM", tmp_path / "snowshed-vdb")


def test_writing_says_what_to_install(no_program, tmp_path):
    assert not program.vdb_available()
    with pytest.raises(InputError, match=INSTALL):
        write_vdb(
            tmp_path / "a.vdb", np.zeros((1, 3)), np.ones(1), dimension=2, dx=0.1,
            particles_per_voxel=6,
        )  # fmt: skip
    assert list(tmp_path.iterdir()) == []


def test_the_command_says_what_to_install(no_program, finished, capsys):
    assert main(["vdb", str(finished)]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"error: {finished / 'vdb' / 'event_001.vdb'}: writing OpenVDB files")
    assert error.count("\n") == 1
    shutil.rmtree(finished / "vdb")


def test_reading_says_what_to_install(tmp_path):
    """The copy of the package has the core but not the program."""
    package = tmp_path / "snowshed"
    shutil.copytree(Path(program.__file__).parents[1], package)
    for leftover in package.glob("_core*.so"):
        leftover.unlink()
    shutil.copy(_core.__file__, package)
    (tmp_path / "heap.vdb").touch()
    scene = tiny_scene(bodies=[{"shape": {"type": "vdb", "file": str(tmp_path / "heap.vdb")}}])
    code = (
        f"import sys; sys.meta_path[:] = [f for f in sys.meta_path if 'ScikitBuild' not in "
        f"type(f).__name__]; sys.path.insert(0, {str(tmp_path)!r}); import snowshed._core as core\n"
        f"assert core.__file__.startswith({str(tmp_path)!r})\n"
        "try:\n    core.Simulation(sys.argv[1])\n"
        "except core.InputError as error:\n    print(error)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, scene.resolve().json],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert "heap.vdb: reading it needs OpenVDB" in done.stdout, done.stderr
    assert "libopenvdb-dev" in done.stdout


@pytest.mark.parametrize("content", [b"", b"\xff\x00", b"[]", b"{}", b"[" * 100_000])
def test_a_damaged_scene_in_the_results_is_named(finished, tmp_path, capsys, content):
    (tmp_path / "scene.json").write_bytes(content)
    shutil.copytree(finished / "particles", tmp_path / "particles")
    assert main(["vdb", str(tmp_path)]) == 2
    message = capsys.readouterr().err
    assert message.startswith("error: ") and message.count("\n") == 1
    assert str(tmp_path / "scene.json") in message
    assert not (tmp_path / "vdb").exists()
