"""Measure every kernel with every instruction set, and name cells with unexpected times.

Usage: python -m benchmarks.matrix path/to/snowshed_bench

Prints nanoseconds of processor time for each particle update, on one thread, and writes
benchmarks/results/DATE-matrix-COMPILER.json. The time of a cell is unexpected if it is more than
twice, or less than half, the time that the other cells predict. In the prediction each choice, such
as the transfer, multiplies the time by its own factor.
"""

from __future__ import annotations

import datetime
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from snowshed.base.machine import cpu_name

RESULTS = Path(__file__).parent / "results"
VARIANTS = ("baseline", "avx2", "avx512")
CHOICES = ("dimension", "precision", "transfer", "basis", "snow")
#: Largest factor by which the time of a cell may differ from its prediction.
MAX_FACTOR = 2.0
#: Largest expected time in double precision, relative to that in single precision.
MAX_DOUBLE_OVER_FLOAT = 2.3

Cell = tuple[str, ...]
Times = dict[Cell, float]


def measure(program: str, variant: str, repetitions: int = 3) -> tuple[Times, str]:
    """Return the least processor time per update (ns) for each cell, and the compiler."""
    command = [
        program,
        "--benchmark_format=json",
        "--benchmark_filter=matrix/",
        "--benchmark_min_time=0.05",
        f"--benchmark_repetitions={repetitions}",
        "--benchmark_enable_random_interleaving=true",
    ]
    environment = {**os.environ, "SNOWSHED_KERNELS": variant}
    done = subprocess.run(command, check=True, capture_output=True, env=environment)
    report = json.loads(done.stdout)
    times: Times = {}
    for row in report["benchmarks"]:
        if row["run_type"] != "iteration":
            continue
        cell = tuple(row["name"].split("/")[1 : 1 + len(CHOICES)])
        updates = row["items_per_second"] * row["real_time"] * 1e-3  # particle updates in a step
        times[cell] = min(times.get(cell, np.inf), row["cpu_time"] * 1e6 / updates)
    return times, report["context"]["compiler"].strip()


def predicted(times: Times, cell: Cell) -> float:
    """Return the time of a cell (ns) by a least-squares model of the other cells' logarithms."""
    others = [other for other in times if other != cell]
    values = [sorted({other[i] for other in times}) for i in range(len(CHOICES))]

    def features(kernel: Cell) -> list[float]:
        chosen = [float(kernel[i] == v) for i in range(len(CHOICES)) for v in values[i][1:]]
        return [1.0, *chosen]

    matrix = np.array([features(other) for other in others])
    logarithms = np.log([times[other] for other in others])
    weights, *_ = np.linalg.lstsq(matrix, logarithms, rcond=None)
    return float(np.exp(np.array(features(cell)) @ weights))


def findings(times: Times) -> Iterator[str]:
    """Yield a sentence for each cell with an unexpected time or too slow double precision."""
    for cell, time in times.items():
        expected = predicted(times, cell)
        if not 1 / MAX_FACTOR < time / expected < MAX_FACTOR:
            yield f"{'/'.join(cell)}: {time:.1f} ns, where the other cells predict {expected:.1f}"
        if cell[1] == "double":
            ratio = time / times[(cell[0], "float", *cell[2:])]
            if ratio > MAX_DOUBLE_OVER_FLOAT:
                yield f"{'/'.join(cell)}: {ratio:.2f} times as long as in single precision"


def table(matrix: dict[str, Times]) -> str:
    """Return a Markdown table of times in float and double for each set of instructions."""
    head = [f"{v}, {p}" for v in matrix for p in ("float", "double")]
    lines = ["| kernel | " + " | ".join(head) + " |", "| --- |" + " ---: |" * len(head)]
    cells = sorted(cell for cell in next(iter(matrix.values())) if cell[1] == "float")
    for cell in cells:
        numbers = [
            f"{times[(cell[0], precision, *cell[2:])]:.0f}"
            for times in matrix.values()
            for precision in ("float", "double")
        ]
        name = " ".join([cell[0], *cell[2:]])
        lines.append(f"| {name} | " + " | ".join(numbers) + " |")
    return "\n".join(lines)


def double_over_float(times: Times) -> tuple[float, float]:
    """Return the smallest and the largest ratio of times in double and single precision."""
    ratios = [
        time / times[(cell[0], "float", *cell[2:])]
        for cell, time in times.items()
        if cell[1] == "double"
    ]
    return min(ratios), max(ratios)


def main() -> None:
    """Measure and print the matrix, and write it to a file."""
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    measured = {variant: measure(sys.argv[1], variant) for variant in VARIANTS}
    matrix = {variant: times for variant, (times, _) in measured.items()}
    [compiler] = {name for _, name in measured.values()}
    print(table(matrix))
    for variant, times in matrix.items():
        least, most = double_over_float(times)
        print(f"{variant}: double takes {least:.2f} to {most:.2f} times as long as float")
        for finding in findings(times):
            print(f"{variant}: {finding}")
    today = datetime.date.today().isoformat()
    rounded = {
        variant: {"/".join(cell): round(time, 2) for cell, time in sorted(times.items())}
        for variant, times in matrix.items()
    }
    facts = {
        **{"date": today, "machine": cpu_name(), "compiler": compiler},
        **{"unit": "ns of processor time", "kernels": rounded},
    }
    file = RESULTS / f"{today}-matrix-{compiler.split()[0].lower()}.json"
    file.write_text(json.dumps(facts, indent=1) + "\n")


if __name__ == "__main__":
    main()
