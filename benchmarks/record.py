"""Measure the solver and the five laboratory events, and keep the numbers.

Usage: python benchmarks/record.py path/to/snowshed_bench

Writes benchmarks/results/DATE.json (machine, date, every case) and prints the table that
docs/performance.md shows. Nothing else should run on the machine meanwhile.
"""

from __future__ import annotations

import datetime
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from snowshed.events import run_events
from snowshed.machine import cpu_name
from snowshed.scene import Scene

RESULTS = Path(__file__).parent / "results"


def solver_cases(program: str) -> list[dict[str, object]]:
    """Run the Google Benchmark program: median of three repetitions of each case."""
    command = [program, "--benchmark_format=json", "--benchmark_repetitions=3"]
    report = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    return [
        {
            "case": row["run_name"].removesuffix("/real_time"),
            "updates_per_s": row["items_per_second"],
            "bytes_per_particle": row["bytes/particle"],
        }
        for row in report["benchmarks"]
        if row.get("aggregate_name") == "median"
    ]


def lab_events(dimension: int) -> dict[str, object]:
    """Run five events of the laboratory experiment (Table 2.3.1, tilt 50 degrees)."""
    scene = Scene.preset("lab-50").update({"dimension": dimension, "panel.friction": 0.3})
    with tempfile.TemporaryDirectory() as folder:
        table = run_events(scene, folder, pictures=False)
        run = json.loads((Path(folder) / "run.json").read_text(encoding="utf-8"))
    return {
        "case": f"lab_{dimension}d_five_events",
        "updates_per_s": run["updates_per_s"],
        "wall_s": run["wall_s"],
        "peak_memory_mb": run["peak_memory_mb"],
        "steps": run["steps"],
        "height_m": table.height_m.round(3).tolist(),
        "length_m": table.length_m.round(3).tolist(),
    }


def main() -> None:
    """Measure everything, write the file and print the table."""
    date = datetime.date.today().isoformat()
    cases = [*solver_cases(sys.argv[1]), lab_events(2), lab_events(3)]
    RESULTS.mkdir(exist_ok=True)
    record = {"date": date, "cpu": cpu_name(), "cases": cases}
    (RESULTS / f"{date}.json").write_text(json.dumps(record, indent=2) + "\n", encoding="utf-8")
    print(f"{date}, {cpu_name()}\n")
    print("| case | M updates/s | bytes per particle | wall, s |\n| --- | --- | --- | --- |")
    for case in cases:
        memory = f"{case['bytes_per_particle']:.0f}" if "bytes_per_particle" in case else ""
        wall = f"{case['wall_s']:.1f}" if "wall_s" in case else ""
        print(f"| {case['case']} | {case['updates_per_s'] / 1e6:.2f} | {memory} | {wall} |")


if __name__ == "__main__":
    main()
