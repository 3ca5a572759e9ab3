"""Measure the solver and whole problems, and write the numbers to a file.

Usage: python -m benchmarks.record path/to/snowshed_bench

Writes benchmarks/results/DATE.json (machine, date, every case) and prints the tables that
docs/trust/performance.md shows. Nothing else should run on the machine meanwhile.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from benchmarks.keeping import keep_cases
from benchmarks.tables import print_tables

from snowshed.base.machine import cpu_name
from snowshed.running.run import run_events
from snowshed.scene.scene import Scene

Case = dict[str, Any]


def solver_cases(program: str, repetitions: int = 5) -> list[Case]:
    """Return medians for the slabs of Google Benchmark, with interleaved repetitions."""
    report = json.loads(
        subprocess.run(
            [
                program,
                "--benchmark_format=json",
                f"--benchmark_repetitions={repetitions}",
                "--benchmark_enable_random_interleaving=true",
                "--benchmark_filter=slab_|bare_kernel|price/|scaling_3d/10{4,6}/",
            ],
            check=True,
            capture_output=True,
        ).stdout
    )
    return [
        {
            "case": row["run_name"].removesuffix("/real_time"),
            "updates_per_s": row["items_per_second"],
            "bytes_per_particle": row["bytes/particle"],
        }
        for row in report["benchmarks"]
        if row.get("aggregate_name") == "median"
    ]


def largest_case(program: str) -> Case:
    """Return the result of the slab of ten million particles, with the memory of its process."""
    case = "scaling_3d/10000000"
    command = [program, "--benchmark_format=json", f"--benchmark_filter={case}"]
    report = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    [row] = report["benchmarks"]
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024.0
    return {
        "case": f"{case}/2",
        "updates_per_s": row["items_per_second"],
        "bytes_per_particle": row["bytes/particle"],
        "peak_memory_mb": peak / 1e6,
    }


def whole_run(name: str, scene: Scene) -> Case:
    """Run a scene with all its events, as `snowshed run` does, and return its cost."""
    with tempfile.TemporaryDirectory() as folder:
        table = run_events(scene, folder, pictures=False)
        run = json.loads((Path(folder) / "run.json").read_text(encoding="utf-8"))
    stored = (
        "updates_per_s",
        "particle_updates",
        "slept_updates",
        "wall_s",
        "peak_memory_mb",
        "steps",
    )
    return {
        "case": name,
        **{key: run[key] for key in stored},
        "height_m": table.height_m.round(3).tolist(),
        "length_m": table.length_m.round(3).tolist(),
    }


def lab(dimension: int, **more: float) -> Scene:
    """Return a scene of five laboratory events (Table 2.3.1, tilt 50 degrees)."""
    return Scene.preset("lab-50").update(
        {
            "dimension": dimension,
            "panel.friction": 0.3,
            **{k.replace("__", "."): v for k, v in more.items()},
        }
    )


def geometry(**more: float) -> Scene:
    """Return a scene of chapter 5: a panel 2 m high and 2 m long, with five events in 2D."""
    panel = {"panel.height": 2.0, "panel.length": 2.0, "numerics.dx": 0.01}
    return lab(2, **more).update(panel)


def sleeping(name: str, make: Callable[..., Scene], seeds: int, **more: float) -> list[Case]:
    """Return the costs of a scene with and without sleep, for several seedings."""
    cases = []
    for seed in range(1, seeds + 1):
        for state, speed in (("asleep", {}), ("awake", {"numerics__sleep_speed": 0.0})):
            scene = make(seeding__seed=seed, **speed, **more)
            cases.append(whole_run(f"{name}/{state}/seed_{seed}", scene))
    return cases


def main() -> None:
    """Measure everything, write the file and print the tables."""
    program = sys.argv[1]
    seeds = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    cases = [
        *solver_cases(program),
        largest_case(program),
        whole_run("lab_2d_five_events", lab(2)),
        whole_run("lab_3d_five_events", lab(3)),
        *sleeping("geometry_2d", geometry, seeds),
    ]
    print(f"{keep_cases(cases)}, {cpu_name()}\n")
    print_tables(cases)


if __name__ == "__main__":
    main()
