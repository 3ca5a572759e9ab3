"""A run that is killed or meets a full disk at any file operation resumes to the same bits."""

import itertools
import os
import shutil
import subprocess
import sys
import sysconfig
from datetime import date, timedelta
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from conftest import tiny_mps, tiny_scene
from faults.forks import Forks
from helpers.records import RECORDS, undated

from snowshed.analysis.tomography.example import example_grains
from snowshed.io.atomic import LEFTOVER
from snowshed.scene import example_slide
from snowshed.study.table import read_table

SCRIPTS = Path(sysconfig.get_path("scripts"))
SNOWSHED = SCRIPTS / "snowshed"
TINY = (
    *("--preset", "lab-50", "--dim", "2", "--dx", "0.02", "--particles-per-voxel", "8"),
    *("--events", "2", "--max-time", "0.2", "--threads", "1"),
)
REGRESS = (
    *("--kind", "linear", "--target", "ratio", "--rounds", "1", "--folds", "2"),
    *("--inner-folds", "2", "--jobs", "1", "-q"),
)
VALIDATION = (sys.executable, "-m", "validation", "--case", "spin", "-q")
CLEARANCE = (
    *("--slope-length", "0.4", "--tilt", "60", "--heights", "0.3", "--draws", "1"),
    *("--jobs", "1", "-q"),
)
#: Commands with their files in {inputs}, and the options with which they resume.
PROGRAMS = {
    "snowshed-run": ([SCRIPTS / "snowshed-run", "{inputs}/scene.json", "--quiet"], ["--resume"]),
    "run": ([SNOWSHED, "run", "{inputs}/scene.json", "-q"], ["--resume"]),
    "panel": ([SNOWSHED, "panel", *TINY, "-q"], ["--resume"]),
    "season": ([SNOWSHED, "season", "{inputs}/season.csv", *TINY[:6], "-q"], ["--resume"]),
    "study": ([SNOWSHED, "study", "run", "{inputs}/study.toml", "--jobs", "1", "-q"], []),
    "slide": ([SNOWSHED, "run", "{inputs}/slide.json", "-q"], ["--resume"]),
    "grains": ([SNOWSHED, "run", "{inputs}/grains.json", "-q"], ["--resume"]),
    "mps": ([SNOWSHED, "run", "{inputs}/mps.json", "-q"], ["--resume"]),
    "regress": ([SNOWSHED, "regress", "{inputs}/rows.csv", *REGRESS], []),
    "validation": ([*VALIDATION], ["--resume"]),
    "clearance": ([SNOWSHED, "clearance", "{inputs}/winter.csv", *CLEARANCE], []),
}
KINDS = ("kill", "full")
#: Number of operations in the quick tests of a program; the default is two.
SAMPLE_COUNTS = {"snowshed-run": 16}
#: Programs in the quick tests; the others share their writers.
SAMPLED_PROGRAMS = ("snowshed-run", "run", "season", "study", "slide", "clearance")
#: Files that hold wall times.
VARYING_FILES = (
    *("run.json", "events.csv", "store.sqlite", "store.sqlite-shm", "store.sqlite-wal"),
    *("measurements.jsonl", "results.csv", "results.json", "scores.csv", "errors.csv"),
)
SEASON = "date,snowfall_m,temperature_c,density_kg_m3\n2024-12-01,0.05,-4,120\n2024-12-02,0,2,\n"
WINTER = "".join(f"{date(2024, 12, 3) + timedelta(day)},0,2,\n" for day in range(90))
STUDY = """name = "tiny"
dimension = 2
events = 1
seeds = 2
[scene]
preset = "lab-50"
numerics.dx = 0.02
events.max_time = 0.05
"""
WALL_TIME_COLUMNS = ["wall_s", "updates_per_s"]  # of tables


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
def inputs(tmp_path_factory):
    """Input files of the commands."""
    folder = tmp_path_factory.mktemp("inputs")
    (folder / "slide").mkdir()
    short = {"output.snapshot_interval": 0.2, "numerics.threads": 1}
    tiny_scene(**short).resolve().save(folder / "scene.json")
    example_slide(folder / "slide").set("events.max_time", 0.4).resolve().save(
        folder / "slide.json"
    )
    grains = example_grains(folder / "grains").set("loading.0.strain", 0.0005)
    grains.resolve().save(folder / "grains.json")
    mps = tiny_mps(**{"events.max_time": 0.2, "output.snapshot_interval": 0.1})
    mps.resolve().save(folder / "mps.json")
    (folder / "season.csv").write_text(SEASON)
    (folder / "winter.csv").write_text(SEASON + WINTER)
    (folder / "study.toml").write_text(STUDY)
    panels = itertools.product((1, 2), (2.0, 3.0, 4.0), (0.5, 2.0, 4.0), (40.0, 60.0))
    columns = ["event", "panel.height", "panel.length", "panel.tilt"]
    table = pd.DataFrame(panels, columns=columns).assign(hash="0123", seed=1)
    table["height_m"] = 0.05 * table["event"] * np.log1p(table["panel.length"])
    table["length_m"] = 0.5 + 0.2 * table["panel.height"]
    table.to_csv(folder / "rows.csv", index=False)
    return folder


def run_separately(words, environment):
    """Run a command line as a user does."""
    environment = {**os.environ, **environment}
    return subprocess.run(words, env=environment, capture_output=True, text=True, timeout=300)


class Program:
    """One of `PROGRAMS` with faults in its files, started by a function like `run_separately`."""

    def __init__(self, name, inputs, library, base, start):
        self.command, self.resume_options = PROGRAMS[name]
        self.inputs = inputs
        self.library = library
        self.base = base
        self.start = start

    def run(self, folder, *options, **faults):
        words = [str(word).format(inputs=self.inputs) for word in self.command]
        environment = {"LD_PRELOAD": str(self.library), "FAULT_FOLDER": str(folder), **faults}
        return self.start([*words, "-o", str(folder), *options], environment)

    def undisturbed(self):
        """Return the results folder of a run without faults, and its number of operations."""
        count = self.base / "count"
        done = self.run(self.base / "undisturbed", FAULT_COUNT=str(count))
        assert done.returncode == 0, done.stderr
        return self.base / "undisturbed", int(count.read_text())

    def disturbed(self, kind, at):
        """Return the folder of a run that met a fault and was resumed; check its end."""
        folder = self.base / f"{kind}-{at}"
        done = self.run(folder, FAULT_KIND=kind, FAULT_AT=str(at))
        if kind == "full":
            self.check_full(done, folder, at)
        resumed = self.run(folder, *self.resume_options)
        if "nothing to resume" in resumed.stderr or "no such folder" in resumed.stderr.lower():
            resumed = self.run(folder)
        assert resumed.returncode == 0, (kind, at, resumed.stderr)
        return folder

    def check_full(self, done, folder, at):
        """The error names the file, and the exit code is 3; 2 would mean that no files exist."""
        message = done.stderr.strip().rpartition("\n")[2]
        reported = message.startswith("error: ") and str(folder) in message and done.returncode == 3
        assert done.returncode == 0 or reported, (at, done.returncode, done.stderr)
        assert "Traceback" not in done.stderr, (at, done.stderr)


def contents(folder):
    """Return the content that runs must share: names and bytes, tables without wall times."""
    content_by_name = {}
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        assert not LEFTOVER.match(path.name), name
        is_fold = "folds" in path.parts  # holds processor times, which vary
        if path.name in VARYING_FILES or is_fold or path.suffix in (".png", ".html"):
            content_by_name[name] = "present"
        elif path.name in RECORDS:
            content_by_name[name] = undated(path.read_bytes())
        elif path.is_file():
            content_by_name[name] = path.read_bytes()
    for name in content_by_name:
        if name.endswith("events.csv") and "/" not in name.removeprefix("run/"):
            table = pd.read_csv(folder / name)
            assert set(WALL_TIME_COLUMNS) & set(table)
            content_by_name[name] = table.drop(columns=WALL_TIME_COLUMNS, errors="ignore").to_csv()
    if (folder / "store.sqlite").is_file():
        content_by_name["store.sqlite"] = read_table(folder).to_csv()
    return content_by_name


def check(program, sample=None):
    folder, count = program.undisturbed()
    expected = contents(folder)
    assert count > 10
    stride = 1 if sample is None else max(1, count * len(KINDS) // sample)
    cases = [(kind, at) for kind in KINDS for at in range(1, count + 1)][stride // 2 :: stride]
    for kind, at in cases:
        folder_after = program.disturbed(kind, at)
        result = contents(folder_after)
        assert result.keys() == expected.keys(), (kind, at)
        assert [key for key in expected if result[key] != expected[key]] == [], (kind, at)
        shutil.rmtree(folder_after)


@pytest.fixture(scope="module")
def forks(faults, tmp_path_factory):
    """A process whose forks run the commands of all tests with its imported modules."""
    with Forks(tmp_path_factory.mktemp("forks"), faults) as process:
        yield process


def start_function(name, forks):
    """Return the function that starts a program; a compiled one has a separate process."""
    return run_separately if name == "snowshed-run" else forks.run


@pytest.mark.parametrize("name", SAMPLED_PROGRAMS)
def test_a_command_resumes_after_some_operations(name, inputs, faults, forks, tmp_path):
    program = Program(name, inputs, faults, tmp_path, start_function(name, forks))
    check(program, SAMPLE_COUNTS.get(name, 2))


@pytest.mark.slow
@pytest.mark.parametrize("name", PROGRAMS)
def test_a_command_resumes_after_every_operation(name, inputs, faults, forks, tmp_path):
    check(Program(name, inputs, faults, tmp_path, start_function(name, forks)))
