"""A run that is killed, or whose disk is full, at any file operation goes on to the same bits."""

import os
import shutil
import subprocess
import sysconfig
from pathlib import Path

import pandas as pd
import pytest
from conftest import tiny_scene

SCRIPTS = Path(sysconfig.get_path("scripts"))
PROGRAMS = {
    "snowshed-run": [SCRIPTS / "snowshed-run", "{scene}", "-o", "{folder}", "--quiet"],
    "snowshed run": [SCRIPTS / "snowshed", "run", "{scene}", "-o", "{folder}", "--quiet"],
}
KINDS = ("kill", "full")
SAMPLE = 16  # operations tried in the tests that run always
WALL_TIMES = ["wall_s", "updates_per_s"]  # columns that no two runs have in common


@pytest.fixture(scope="session")
def faults(tmp_path_factory):
    """The library that makes file operations fail."""
    library = tmp_path_factory.mktemp("faults") / "file_faults.so"
    compiler = shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    assert compiler, "a C compiler is needed"
    source = Path(__file__).with_name("file_faults.c")
    subprocess.run([compiler, "-shared", "-fPIC", "-o", library, source, "-ldl"], check=True)
    return library


@pytest.fixture(scope="session")
def scene(tmp_path_factory):
    file = tmp_path_factory.mktemp("scene") / "scene.json"
    short = {"output.snapshot_interval": 0.2, "numerics.threads": 1}
    tiny_scene(**short).resolve().save(file)
    return file


class Program:
    """One of `PROGRAMS` with faults in its files."""

    def __init__(self, name, scene, library, base):
        self.name = name
        self.scene = scene
        self.library = library
        self.base = base

    def run(self, folder, *options, **faults):
        words = [str(word).format(scene=self.scene, folder=folder) for word in PROGRAMS[self.name]]
        environment = {"LD_PRELOAD": str(self.library), "FAULT_FOLDER": str(folder), **faults}
        return subprocess.run(
            [*words, *options],
            env={**os.environ, **environment},
            capture_output=True,
            text=True,
            timeout=300,
        )

    def undisturbed(self):
        """Return the results folder of a run without faults, and its number of operations."""
        count = self.base / "count"
        done = self.run(self.base / "undisturbed", FAULT_COUNT=str(count))
        assert done.returncode == 0, done.stderr
        return self.base / "undisturbed", int(count.read_text())

    def disturbed(self, kind, at):
        """Return the folder of a run that met a fault and then went on; check how it ended."""
        folder = self.base / f"{kind}-{at}"
        done = self.run(folder, FAULT_KIND=kind, FAULT_AT=str(at))
        if kind == "full":
            told = done.returncode == 0 or done.stderr.startswith("error: ")
            assert told and "Traceback" not in done.stderr, (at, done.stderr)
        resumed = self.run(folder, "--resume")
        if "nothing to resume" in resumed.stderr or "no such folder" in resumed.stderr.lower():
            resumed = self.run(folder)
        assert resumed.returncode == 0, (kind, at, resumed.stderr)
        return folder


def contents(folder):
    """Return what must be the same: names and bytes, tables without wall times."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        if name in ("run.json", "events.csv") or path.suffix == ".png":
            found[name] = "there"
        elif path.is_file():
            found[name] = path.read_bytes()
    if "events.csv" in found:
        table = pd.read_csv(folder / "events.csv")
        assert set(WALL_TIMES) & set(table)
        found["events.csv"] = table.drop(columns=WALL_TIMES, errors="ignore").to_csv()
    return found


def check(name, scene, faults, base, sample=None):
    program = Program(name, scene, faults, base)
    folder, count = program.undisturbed()
    wanted = contents(folder)
    assert count > 100
    stride = 1 if sample is None else max(1, count * len(KINDS) // sample)
    cases = [(kind, at) for kind in KINDS for at in range(1, count + 1)][::stride]
    for kind, at in cases:
        left = program.disturbed(kind, at)
        found = contents(left)
        assert found.keys() == wanted.keys(), (kind, at)
        assert [key for key in wanted if found[key] != wanted[key]] == [], (kind, at)
        shutil.rmtree(left)


def test_the_executable_goes_on_after_some_operations(scene, faults, tmp_path):
    check("snowshed-run", scene, faults, tmp_path, SAMPLE)


@pytest.mark.slow
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_run_goes_on_after_every_operation(name, scene, faults, tmp_path):
    check(name, scene, faults, tmp_path)
