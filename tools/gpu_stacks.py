"""Compare the mean stacks of a graphics card with those of the processor.

Usage: python -m tools.gpu_stacks SNOWSHED-RUN FOLDER [--seeds N] [--only SCENE]

Four small scenes run on both devices with several seeds: an event on the laboratory's panel, two
events on it with the scheme `objective`, a slab that slides against a board, and a ball of two
snows that a moving wall hits. They are coarse, so that an emulated card (SNOWSHED_CUDA) can run
them, too. The same seed begins with the same particles on both devices; rounding then makes them
differ.

The difference of two means is given in standard errors, as if the seeds of the devices were
independent: below 3 it is within the noise of seeds. Beside the measures of the stack, two scenes
compare the terms of the last event's balance of energy. No package is needed. The record
benchmarks/results/DATE-gpu-stacks.json is written after each run.
"""

from __future__ import annotations

import argparse
import datetime
import json
import math
import os
import shutil
import statistics
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import Any

from tools.gpu_measure import RESULTS, cpu_name, write_result
from tools.snow_measures import measures

#: Snow of the scenes. It is soft, so that steps are long. (On these cells, the scheme `thesis`
#: needs stiffer snow to slide off the panel.)
SNOW = {"density": 210, "youngs_modulus": 1e5}
CELL = 0.025  # m
SEEDS = 4
MAX_STANDARD_ERRORS = 3.0


# --- scenes ----------------------------------------------------------------------------------


def laboratory(scheme: str, youngs_modulus: float, events: int) -> dict[str, Any]:
    """Return the laboratory's panel at 50 degrees, with thick slabs on coarse cells."""
    return {
        "snow": {**SNOW, "youngs_modulus": youngs_modulus},
        "panel": {"height": 0.33, "length": 0.245, "width": 0.213, "tilt": 50, "friction": 0.3},
        "slab": {"thickness": 0.05, "width": 0.142},
        "ground": {"condition": "sticky"},
        "numerics": {"dx": CELL, "scheme": scheme},
        "events": {"count": events, "max_time": 0.8},
        "output": {"energy": scheme == "objective"},
    }


def board() -> dict[str, Any]:
    """Return a slab that slides down a plane against a board, whose forces are recorded."""
    tilt = math.radians(35)
    slab = {"type": "box", "size": [0.3, 0.16, 0.08], "center": [0.0, 0.0, 0.041]}
    return {
        "snow": {**SNOW, "preconsolidation_pressure": 1500, "cohesion": 0.05},
        "bodies": [
            {
                "shape": {"type": "transform", "shapes": [slab], "axis": [0, 1, 0], "angle": 35},
                "velocity": [math.cos(tilt), 0.0, -math.sin(tilt)],
            }
        ],
        "obstacles": [
            {
                "name": "slope",
                "shape": {
                    "type": "plane",
                    "center": [0, 0, 0],
                    "normal": [math.sin(tilt), 0.0, math.cos(tilt)],
                },
                "condition": "slip",
                "friction": 0.3,
            },
            {
                "name": "board",
                "shape": {"type": "box", "center": [0.35, 0, -0.2], "size": [0.04, 0.4, 0.3]},
                "condition": "separate",
                "friction": 0.4,
            },
        ],
        "numerics": {"dx": CELL},
        "events": {"max_time": 0.4},
        "output": {"forces": True, "energy": True},
    }


def ball() -> dict[str, Any]:
    """Return a ball of light snow with a dense core, which falls and is hit by a moving wall."""
    core = {"density": 350, "youngs_modulus": 2e5, "preconsolidation_pressure": 20000}
    shell = {
        "type": "difference",
        "shapes": [
            {"type": "sphere", "center": [0, 0, 0.14], "radius": 0.1},
            {"type": "sphere", "center": [0, 0, 0.14], "radius": 0.05},
        ],
    }
    return {
        "snow": {**SNOW, "preconsolidation_pressure": 3000},
        "bodies": [
            {"shape": shell, "velocity": [1, 0, -3]},
            {
                "shape": {"type": "sphere", "center": [0, 0, 0.14], "radius": 0.05},
                "velocity": [1, 0, -3],
                "snow": core,
            },
        ],
        "ground": {"condition": "separate", "friction": 0.5},
        "obstacles": [
            {
                "name": "wall",
                "shape": {"type": "box", "center": [0.4, 0, 0.2], "size": [0.1, 0.6, 0.5]},
                "condition": "separate",
                "friction": 0.3,
                "motion": {"velocity": [-0.8, 0, 0], "end": 0.25},
            }
        ],
        "numerics": {"dx": CELL, "transfer": "apic"},
        "events": {"max_time": 0.4},
    }


SCENES = {
    "laboratory": lambda: laboratory("thesis", 1e6, 1),
    "laboratory_objective": lambda: laboratory("objective", 1e5, 2),
    "slab_against_board": board,
    "ball_and_wall": ball,
}


def scene_of(name: str, seed: int, device: str) -> dict[str, Any]:
    """Return a scene with its seed and device, on one thread of the processor."""
    scene = {"snowshed": 2, "dimension": 3, **SCENES[name]()}
    scene["seeding"] = {"pattern": "jittered", "seed": seed}
    scene["numerics"] = {**scene["numerics"], "device": device, "threads": 1}
    scene["output"] = {"film": False, "checkpoint_interval": 0, **scene.get("output", {})}
    return scene


# --- runs -----------------------------------------------------------------------------------


def run(program: str, folder: Path, name: str, seed: int, device: str) -> dict[str, Any]:
    """Run a scene, and return its measures or its error."""
    stem = folder / f"{name}-{seed}-{device}"
    stem.with_suffix(".json").write_text(
        json.dumps(scene_of(name, seed, device), indent=1) + "\n", encoding="utf-8"
    )
    shutil.rmtree(stem, ignore_errors=True)
    row: dict[str, Any] = {"scene": name, "seed": seed, "device": device}
    begin = time.perf_counter()
    done = subprocess.run(
        [program, str(stem.with_suffix(".json")), "-o", str(stem), "--quiet"],
        capture_output=True,
        text=True,
    )
    if done.returncode != 0:
        return {**row, "error": done.stderr.strip()}
    record = json.loads((stem / "run.json").read_text(encoding="utf-8"))
    return {
        **row,
        "device_name": record["device"],
        "particles": record["particles"],
        "steps": record["steps"],
        "particle_updates": record["particle_updates"],
        "process_s": round(time.perf_counter() - begin, 1),
        "measures": measures(stem),
    }


# --- comparison ------------------------------------------------------------------------------


def standard_errors(first: list[float], second: list[float]) -> float:
    """Return the difference of two means over its standard error, of independent samples.

    Equal samples differ by 0, whatever their scatter.
    """
    difference = statistics.fmean(first) - statistics.fmean(second)
    if difference == 0.0:
        return 0.0
    square = statistics.variance(first) / len(first) + statistics.variance(second) / len(second)
    return difference / math.sqrt(square) if square > 0.0 else math.copysign(math.inf, difference)


def compared(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return a row for each scene and measure that at least two seeds have on both devices."""
    by_run = {(r["scene"], r["seed"], r["device"]): r["measures"] for r in rows if "error" not in r}
    table = []
    for scene in SCENES:
        seeds = sorted(
            seed
            for name, seed, device in by_run
            if name == scene and device == "gpu" and (scene, seed, "cpu") in by_run
        )
        if len(seeds) < 2:
            continue
        for measure in by_run[scene, seeds[0], "cpu"]:
            card = [by_run[scene, seed, "gpu"][measure] for seed in seeds]
            processor = [by_run[scene, seed, "cpu"][measure] for seed in seeds]
            z = standard_errors(card, processor)
            table.append(
                {
                    "scene": scene,
                    "measure": measure,
                    "seeds": len(seeds),
                    "card": statistics.fmean(card),
                    "processor": statistics.fmean(processor),
                    "scatter": statistics.stdev(processor),
                    "largest_pair_difference": max(abs(a - b) for a, b in zip(card, processor)),
                    "standard_errors": z,
                    "holds": abs(z) < MAX_STANDARD_ERRORS,
                }
            )
    return table


def name_of_card(rows: list[dict[str, Any]]) -> str:
    """Return the name of the card that the runs had, or an empty text."""
    names = {row["device_name"] for row in rows if row["device"] == "gpu" and "error" not in row}
    return ", ".join(sorted(names))


def main() -> int:
    """Run the scenes, write the record after each run, and print the comparison."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", help="snowshed-run")
    parser.add_argument("folder", type=Path, help="folder for scenes and results")
    parser.add_argument("--seeds", type=int, default=SEEDS)
    parser.add_argument("--seconds", type=float, default=math.inf, help="begin no run after these")
    parser.add_argument("--cores", type=int, default=os.cpu_count(), help="runs side by side")
    parser.add_argument("--only", choices=SCENES, action="append", help="this scene alone")
    parser.add_argument("--records", type=Path, default=RESULTS, help="folder of the record")
    given = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    end = time.perf_counter() + given.seconds
    # All scenes have two seeds before any has three.
    jobs = [
        (name, seed, device)
        for seed in range(1, given.seeds + 1)
        for name in given.only or SCENES
        for device in ("gpu", "cpu")
    ]

    def begun_in_time(job: tuple[str, int, str]) -> dict[str, Any]:
        if time.perf_counter() > end:
            name, seed, device = job
            return {"scene": name, "seed": seed, "device": device, "error": "not begun in time"}
        return run(given.program, given.folder, *job)

    rows: list[dict[str, Any]] = []
    with ThreadPoolExecutor(max_workers=given.cores) as pool:
        for done in as_completed([pool.submit(begun_in_time, job) for job in jobs]):
            rows.append(done.result())
            print("gpu_stacks:", json.dumps(rows[-1]), flush=True)
            record = {
                "date": datetime.date.today().isoformat(),
                "card": name_of_card(rows),
                "cpu": cpu_name(),
                "runs": sorted(rows, key=lambda r: (r["scene"], r["seed"], r["device"])),
                "comparison": compared(rows),
            }
            target = write_result(record, given.records, "gpu-stacks")
    table = compared(rows)
    for row in table:
        verdict = "holds" if row["holds"] else "MISSED"
        print(
            f"gpu_stacks: {verdict} {row['scene']}, {row['measure']}: card {row['card']:.5g}, "
            f"processor {row['processor']:.5g}, {row['standard_errors']:+.2f} standard errors"
        )
    print("gpu_stacks: written:", target)
    failed = any("error" in row for row in rows) or len({row["scene"] for row in table}) < len(
        given.only or SCENES
    )
    return int(failed or not all(row["holds"] for row in table))


if __name__ == "__main__":
    sys.exit(main())
