"""Pipes and sockets instead of files, for which a reader would wait forever."""

import os
import socket

import pytest
from conftest import tiny_scene
from helpers.processes import EXECUTABLE, snowshed_command

from snowshed import InputError, ResolvedScene, Scene, _core
from snowshed.io.csv_table import read_csv
from snowshed.io.film import Film
from snowshed.io.json_file import read_object
from snowshed.io.vtk.vtp import read_particles

READERS = {
    "scene": Scene.load,
    "scene of the core": ResolvedScene.load,
    "film": Film,
    "table": read_csv,
    "JSON": read_object,
    "particles": read_particles,
    "checkpoint": lambda path: _core.Simulation.load(str(path)),
    "mesh": lambda path: _core.read_mesh(path),
}


@pytest.fixture
def pipe(tmp_path):
    os.mkfifo(tmp_path / "a.stl")
    return tmp_path / "a.stl"


@pytest.mark.parametrize("read", READERS.values(), ids=READERS)
def test_a_pipe_is_refused_by_name(pipe, read):
    with pytest.raises((InputError, OSError), match=r"a\.stl"):
        read(pipe)


@pytest.mark.parametrize("shape", ["mesh", "grid"])
def test_a_pipe_in_a_scene_is_refused(pipe, shape):
    spec = {"type": shape, "file": str(pipe)}
    if shape == "grid":
        spec |= {"origin": [0, 0], "spacing": 0.1}
    scene = tiny_scene().append("obstacles", {"name": "a", "shape": spec})
    with pytest.raises(InputError, match=r"a\.stl"):
        _core.Simulation(scene.resolve().json)


def test_a_socket_is_refused(tmp_path):
    with socket.socket(socket.AF_UNIX) as server:
        server.bind(str(tmp_path / "a"))
        for read in (Scene.load, ResolvedScene.load):
            with pytest.raises((InputError, OSError)):
                read(tmp_path / "a")


@pytest.mark.parametrize("command", ["run", "plan"])
def test_commands_do_not_wait_for_a_pipe(pipe, tmp_path, command):
    out = ["-o", tmp_path / "out"] if command == "run" else []
    done = snowshed_command(command, pipe, *out)
    _, messages = done.communicate(timeout=60)
    assert done.returncode == 2 and "a.stl: not a regular file" in messages


def test_the_executable_does_not_wait_for_a_pipe(pipe, tmp_path):
    import subprocess

    command = [str(EXECUTABLE), str(pipe), "-o", str(tmp_path / "out")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.returncode == 2 and "a.stl: not a regular file" in done.stderr
