"""Measure runs beside other busy programs, and with a quota of processor time.

Usage: python -m benchmarks.shared_machine [--label NAME] [--repetitions N] [--only METHOD]

Each method runs a short scene on two threads, by ``snowshed-run`` and from Python: alone, beside
one and four programs that keep a core busy, and in a container with one and a half cores. The
repetitions of all cases alternate; medians count.

The *fair share* of n threads beside k busy programs on c cores is n c / (n + k) cores. n is one for
scenes so small that their runs alone keep a single core busy. The ideal time is the processor time
of the run alone over its share, and at least the time of the run alone.
Writes benchmarks/results/DATE-shared-NAME.json and prints times over the ideal, and processor times
over that of the run alone. Nothing else should run on the machine meanwhile.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pandas as pd
from benchmarks.keeping import keep_cases
from validation.mps.bodies import WATER, block, floor_and_sides

from snowshed._core import available_cores
from snowshed.analysis.tomography.example import example_grains
from snowshed.scene.builders.grains import grains_scene
from snowshed.scene.builders.slides import example_slide
from snowshed.scene.components import Events
from snowshed.scene.loading import LoadingStage
from snowshed.scene.scene import Scene

THREADS = 2
BUSY = (0, 1, 4)  # programs beside
QUOTA = 1.5  # cores
#: A control group for the quota; only root can make it.
GROUP_V1 = Path("/sys/fs/cgroup/cpu/snowshed-bench")
GROUP_V2 = Path("/sys/fs/cgroup/snowshed-bench")
PERIOD_US = 100_000
#: A run alone that keeps no more cores busy uses a single thread.
MAX_CORES_OF_ONE_THREAD = 1.25
RUN_IN_PYTHON = """
import resource, sys, time
from snowshed import Scene, Simulation
def costs():
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return time.perf_counter(), usage.ru_utime + usage.ru_stime
simulation = Simulation(Scene.load(sys.argv[1]))
begin = costs()
simulation.begin_event()
simulation.run()
print(*(after - before for before, after in zip(begin, costs())))
"""


def laboratory(folder: Path) -> Scene:
    """Return one event of the laboratory in 3D."""
    return Scene.preset("lab-50").update({"dimension": 3, "events.count": 1})


def water(folder: Path) -> Scene:
    """Return a column of water that collapses in a basin, in 2D."""
    return Scene(
        dimension=2,
        method="mps",
        numerics=WATER,
        obstacles=floor_and_sides(4.0),
        bodies=[block(1.0, 2.0)],
        events=Events(count=1, between="carry"),
    ).update({"numerics.spacing": 1 / 27})


def grains(folder: Path) -> Scene:
    """Return the compression of a small sample of snow."""
    stages = [LoadingStage(kind="compress", strain=0.004)]
    scene = grains_scene(example_grains(folder).sample.file, 1e-4, stages)
    return scene.update({"events.rest_time": 1e-4})


#: The scene of each method, and the simulated time in s, which takes a few seconds.
SCENES: dict[str, tuple[Callable[[Path], Scene], float]] = {
    "mpm": (laboratory, 0.25),
    "mps": (water, 2.0),
    "slide": (example_slide, 60.0),
    "grains": (grains, 0.0012),
}


def run_by_program(scene: Path) -> tuple[float, float]:
    """Return the wall and processor time (s) of ``snowshed-run``."""
    program = str(Path(sys.executable).with_name("snowshed-run"))
    with tempfile.TemporaryDirectory() as folder:
        begin, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(
            [program, scene, "--output", Path(folder) / "results"], check=True, capture_output=True
        )
        wall, after = time.perf_counter() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def run_by_python(scene: Path) -> tuple[float, float]:
    """Return the wall and processor time (s) of a run from Python, without imports."""
    command = [sys.executable, "-W", "ignore", "-c", RUN_IN_PYTHON, scene]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    wall, processor = map(float, text.split())
    return wall, processor


RUNS = {"snowshed-run": run_by_program, "Python": run_by_python}


@contextlib.contextmanager
def beside(count: int) -> Iterator[None]:
    """Keep `count` other programs busy."""
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
    try:
        yield
    finally:
        for program in busy:
            program.kill()
            program.wait()


@contextlib.contextmanager
def with_quota() -> Iterator[None]:
    """Limit this process and its children to `QUOTA` cores; needs root."""
    version_1 = GROUP_V1.parent.is_dir()
    group = GROUP_V1 if version_1 else GROUP_V2
    group.mkdir(exist_ok=True)
    quota = int(QUOTA * PERIOD_US)
    if version_1:
        (group / "cpu.cfs_period_us").write_text(f"{PERIOD_US}")
        (group / "cpu.cfs_quota_us").write_text(f"{quota}")
    else:
        (group / "cpu.max").write_text(f"{quota} {PERIOD_US}")
    try:
        (group / "cgroup.procs").write_text(f"{os.getpid()}")
        yield
    finally:
        (group.parent / "cgroup.procs").write_text(f"{os.getpid()}")
        group.rmdir()


def conditions() -> dict[str, Callable[[], contextlib.AbstractContextManager[None]]]:
    """Return the conditions of a run by name; the quota only where it can be set."""
    every = {f"{count} busy": (lambda count=count: beside(count)) for count in BUSY}
    try:
        with with_quota():
            pass
    except OSError as error:
        print(f"no quota: {error}", file=sys.stderr)
        return every
    return {**every, "quota": with_quota}


def fair_share(condition: str, threads: int) -> float:
    """Return the cores that some threads get in a condition."""
    if condition == "quota":
        return min(QUOTA, threads)
    busy = int(condition.split(maxsplit=1)[0])
    return min(threads, available_cores() * threads / (threads + busy))


def measure(scenes: dict[str, Path], repetitions: int) -> pd.DataFrame:
    """Return the wall and processor time of every run, repetition by repetition."""
    rows, held = [], conditions()
    for repetition in range(repetitions):
        for method, scene in scenes.items():
            for run_name, run in RUNS.items():
                for condition, hold in held.items():
                    with hold():
                        wall, processor = run(scene)
                    rows.append((method, run_name, condition, repetition, wall, processor))
                    print(*rows[-1], file=sys.stderr, flush=True)
    names = ["method", "run", "condition", "repetition", "wall_s", "processor_s"]
    return pd.DataFrame(rows, columns=names)


def summary(times: pd.DataFrame) -> pd.DataFrame:
    """Return the medians, and their ratios to the ideal time and to the run alone."""
    keys = ["method", "run", "condition"]
    table = times.groupby(keys, sort=False)[["wall_s", "processor_s"]].median().reset_index()
    alone = table[table.condition == "0 busy"].set_index(["method", "run"])
    quiet = alone.loc[pd.MultiIndex.from_frame(table[["method", "run"]])]
    cores = (alone.processor_s / alone.wall_s).groupby("method").max()
    threads = table.method.map(cores).gt(MAX_CORES_OF_ONE_THREAD).map({True: THREADS, False: 1})
    share = [fair_share(condition, n) for condition, n in zip(table.condition, threads)]
    ideal = (quiet.processor_s.to_numpy() / share).clip(min=quiet.wall_s.to_numpy())
    return table.assign(
        threads=threads,
        wall_over_ideal=table.wall_s / ideal,
        processor_over_alone=table.processor_s / quiet.processor_s.to_numpy(),
    )


def main() -> None:
    """Measure everything, write the file and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--label", default="team", help="end of the file's name")
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--only", choices=sorted(SCENES), action="append")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder, files = Path(name), {}
        for method in options.only or SCENES:
            make, duration = SCENES[method]
            files[method] = folder / f"{method}.json"
            scene = make(folder).update({"numerics.threads": THREADS, "events.max_time": duration})
            scene.resolve().save(files[method])
        table = summary(measure(files, options.repetitions))
    keep_cases(table.round(4).to_dict("records"), f"shared-{options.label}")
    print(table.round(2).to_string(index=False))


if __name__ == "__main__":
    main()
