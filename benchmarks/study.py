"""Measure the overhead of the study engine, and the gain from two workers with equal runs.

Usage: python -m benchmarks.study

The command prints the overhead (wall time beyond that of the runs) and the gain from two workers,
and writes both to benchmarks/results/DATE-study.json. Nothing else should run on the machine
meanwhile.
"""

from __future__ import annotations

import datetime
import json
import tempfile
import time
from pathlib import Path

from snowshed.base.machine import cpu_name
from snowshed.scene.scene import Scene
from snowshed.study import Study
from snowshed.study.table import read_table

RESULTS = Path(__file__).parent / "results"
RUNS = 12


def equal_runs() -> Study:
    """Return a study of five laboratory events in 2D; its runs of a few seconds differ in seeds."""
    scene = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.005})
    return Study.product(scene, {"panel.friction": [0.3]}, name="equal", seeds=range(1, RUNS + 1))


def measure(jobs: int) -> dict[str, float]:
    """Return the wall time of the study and the sum of those of its runs, s."""
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        equal_runs().run(folder, jobs=jobs, threads=1)
        wall = time.perf_counter() - start
        table = read_table(folder, timing=True)
    return {"jobs": jobs, "wall_s": wall, "runs_s": table.groupby("hash")["run_wall_s"].max().sum()}


def main() -> None:
    """Measure with one worker and with two, and write the numbers to a file."""
    single, double = measure(1), measure(2)
    result = {
        "machine": cpu_name(),
        "date": datetime.date.today().isoformat(),
        "runs": RUNS,
        "measured": [single, double],
        "overhead": single["wall_s"] / single["runs_s"] - 1,
        "gain_of_two": single["wall_s"] / double["wall_s"],
    }
    file = RESULTS / f"{result['date']}-study.json"
    file.write_text(json.dumps(result, indent=1) + "\n")
    print(
        f"{RUNS} runs of {single['runs_s'] / RUNS:.1f} s: overhead {result['overhead']:.1%}, ",
        end="",
    )
    print(f"two workers {result['gain_of_two']:.2f} times as fast as one")


if __name__ == "__main__":
    main()
