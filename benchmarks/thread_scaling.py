"""Measure how much faster threads make a run, beside what the machine allows.

Usage: python -m benchmarks.thread_scaling SNOWSHED-RUN [--repetitions N]

One event of the laboratory in 3D runs with one thread, with n threads, and n times at once with one
thread each. Independent runs share no work, so they show what n cores of the machine give: shared
caches, memory, clocks and neighbours of a virtual machine slow them, too. The repetitions of all
cases alternate; the quickest of each counts.

Writes benchmarks/results/DATE-threads.json, and prints speeds over that of one thread. Nothing else
should run on the machine meanwhile.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import tempfile
from pathlib import Path

from benchmarks.keeping import keep_cases

from snowshed._core import available_cores
from snowshed.scene.scene import Scene

SCENE = Scene.preset("lab-50").update(
    {"dimension": 3, "events.count": 1, "output.film": False, "output.checkpoint_interval": 0}
)


def wall_times(program: str, folder: Path, threads: int, runs: int) -> list[float]:
    """Return the wall time in s of each of some runs that begin together."""
    scene = folder / f"threads-{threads}.json"
    scene.write_text(SCENE.set("numerics.threads", threads).resolve().json, encoding="utf-8")
    with tempfile.TemporaryDirectory(dir=folder) as results:
        outputs = [Path(results) / str(run) for run in range(runs)]
        started = [
            subprocess.Popen([program, str(scene), "-o", str(output), "-q"]) for output in outputs
        ]
        if sum(process.wait() != 0 for process in started):
            raise SystemExit(f"{program} failed")
        records = [json.loads((o / "run.json").read_text(encoding="utf-8")) for o in outputs]
    return [record["wall_s"] for record in records]


def main() -> None:
    """Measure, write the record, and print speeds over that of one thread."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", help="snowshed-run")
    parser.add_argument("--repetitions", type=int, default=7)
    given = parser.parse_args()
    counts = [n for n in (2, 4, 8, 16) if n <= available_cores()]
    cases = [(1, 1)] + [case for n in counts for case in ((1, n), (n, 1))]
    times: dict[tuple[int, int], list[float]] = {case: [] for case in cases}
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(given.repetitions):
            for case in cases:
                times[case].append(max(wall_times(given.program, Path(folder), *case)))
    quickest = {case: min(seconds) for case, seconds in times.items()}
    rows = [
        {
            "threads": n,
            "one_thread_s": times[1, 1],
            "threads_s": times[n, 1],
            "independent_runs_s": times[1, n],
            "speed": quickest[1, 1] / quickest[n, 1],
            "speed_of_independent_runs": n * quickest[1, 1] / quickest[1, n],
        }
        for n in counts
    ]
    keep_cases(rows, "threads")
    for row in rows:
        print(
            f"{row['threads']} threads: {row['speed']:.2f} times one thread; as many independent "
            f"runs: {row['speed_of_independent_runs']:.2f} times one run"
        )


if __name__ == "__main__":
    main()
