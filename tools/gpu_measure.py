"""Measure runs on a graphics card beside runs on two threads of the processor.

`gpu_check.sh` calls this with the Python of a bare machine, so that it needs no package. Each run
is one of ``snowshed-run``, and its numbers come from its ``run.json``. The record is written after
each run. A run that takes too long is interrupted, and its numbers are those up to then.
"""

from __future__ import annotations

import argparse
import datetime
import json
import os
import platform
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional

from tools.snow_measures import measures

RESULTS = Path(__file__).parents[1] / "benchmarks" / "results"
SCENES = Path(__file__).parents[1] / "examples" / "scenes"
CELL = 1.0 / 32.0  # m, of the slabs
TIME_LIMIT = 200.0  # s, of a run
TIME_TO_STOP = 20.0  # s; a run that takes longer to stop is killed


@dataclass(frozen=True)
class Case:
    """A run: its scene, and the threads of the processor if it does not use a card.

    `seconds` of snow time are computed; None: all events to their end.
    """

    name: str
    scene: dict[str, Any]
    seconds: Optional[float] = None
    threads: int = 0


def slab(scale: int, velocity: tuple[float, float, float]) -> dict[str, Any]:
    """Return a slab of 262 144 particles on sticky ground, or one `scale` times as large."""
    size = [2.0 * scale, 1.0 * scale, 0.5 * scale]
    body = {
        "shape": {"type": "box", "size": size, "center": [0.0, 0.0, size[2] / 2.0]},
        "velocity": list(velocity),
    }
    return {
        "snowshed": 2,
        "snow": {"density": 210},
        "ground": {"condition": "sticky"},
        "bodies": [body],
        "seeding": {"pattern": "jittered", "particles_per_voxel": 8},
        "numerics": {"dx": CELL, "sleep_speed": 0},
        "output": {"film": False, "checkpoint_interval": 0},
    }


def laboratory() -> dict[str, Any]:
    """Return the laboratory's panel with one event."""
    scene: dict[str, Any] = json.loads((SCENES / "lab_3d.json").read_text(encoding="utf-8"))
    scene.setdefault("events", {})["count"] = 1
    scene.setdefault("output", {})["film"] = False
    return scene


def large_panel() -> dict[str, Any]:
    """Return a panel of 4 x 2 m with 20 cm of snow on cells of 1 cm, and five events."""
    return {
        "snowshed": 2,
        "snow": {"density": 210},
        "panel": {"height": 1.0, "length": 4.0, "width": 2.0, "tilt": 45, "friction": 0.3},
        "slab": {"thickness": 0.2},
        "ground": {"condition": "sticky"},
        "numerics": {"dx": 0.01},
        "seeding": {"pattern": "jittered"},
        "events": {"count": 5},
        "output": {"film": False},
    }


REST, FLOW = (0.0, 0.0, 0.0), (5.0, 0.0, -5.0)  # m/s


def small_slab() -> dict[str, Any]:
    """Return a slab of 4096 particles in plastic flow."""
    scene = slab(1, FLOW)
    scene["bodies"][0]["shape"].update(size=[0.25, 0.25, 0.25], center=[0.0, 0.0, 0.125])
    return scene


def cases_of(group: str) -> list[Case]:
    """Return the runs of a group; to rehearse, small ones."""
    if group == "rehearsal":
        return [
            Case("small_slab_in_flow", small_slab(), 0.005),
            Case("small_slab_in_flow", small_slab(), 0.005, threads=2),
            Case("slab_at_rest_262144", slab(1, REST), 0.002, threads=2),
        ]
    if group == "panel":
        return [
            Case("panel_4x2_m", large_panel(), 0.005, threads=2),
            Case("panel_4x2_m", large_panel()),
        ]
    return [
        Case("slab_at_rest_262144", slab(1, REST), 0.5),
        Case("slab_in_flow_262144", slab(1, FLOW), 0.5),
        Case("slab_at_rest_16777216", slab(4, REST), 0.3),
        Case("slab_in_flow_16777216", slab(4, FLOW), 0.3),
        Case("laboratory_one_event", laboratory()),
        Case("laboratory_one_event", laboratory(), threads=2),
    ]


#: Least numbers of updates per second on an H100 or H200, by case.
MIN_SPEED = {
    "slab_at_rest_262144": 3.5e9,
    "slab_in_flow_262144": 0.6 * 3.5e9,
    "slab_at_rest_16777216": 6.0e9,
    "slab_in_flow_16777216": 0.6 * 6.0e9,
}
#: Least ratios of a card to two threads: of wall times, or of updates per second.
MIN_RATIO = {"laboratory_one_event": ("wall_s", 5.0), "panel_4x2_m": ("updates_per_s", 60.0)}


def measured(program: str, folder: Path, case: Case, seconds: float) -> dict[str, Any]:
    """Run a case for at most so many seconds, and return its numbers or its error."""
    device = "cpu" if case.threads else "gpu"
    scene = json.loads(json.dumps(case.scene))
    scene["numerics"].update(device=device, threads=case.threads)
    if case.seconds is not None:
        rest = {"rest_speed": 1e-9, "rest_time": case.seconds}  # the snow never rests
        scene["events"] = {"count": 1, "max_time": case.seconds, **rest}
    name = f"{case.name}-{device}"
    file, results = folder / f"{name}.json", folder / name
    file.write_text(json.dumps(scene, indent=1) + "\n", encoding="utf-8")
    shutil.rmtree(results, ignore_errors=True)
    row = {"case": case.name, "device": device, "threads": case.threads}
    begin = time.perf_counter()
    error = run_for([program, str(file), "-o", str(results), "--quiet"], seconds)
    process_s = round(time.perf_counter() - begin, 3)
    if error and not (results / "run.json").exists():
        return {**row, "error": error}
    record = json.loads((results / "run.json").read_text(encoding="utf-8"))
    events = record.get("finished_events", [])
    if error and not record.get("particle_updates"):
        return {**row, "error": error}
    # After an interruption, also the time in which particles were seeded.
    steps_s = record["wall_s"] if error else sum(event["wall_s"] for event in events)
    return {
        **row,
        **({"interrupted": error} if error else {}),
        "device_name": record["device"],
        "particles": record["particles"],
        "events": len(events),
        "steps": record["steps"],
        "particle_updates": record["particle_updates"],
        "process_s": process_s,
        "wall_s": record["wall_s"],
        "updates_per_s": record["particle_updates"] / steps_s if steps_s > 0 else 0.0,
        "peak_memory_mb": record["peak_memory_mb"],
        **({"measures": measures(results)} if events and case.seconds is None else {}),
    }


def run_for(command: list[str], seconds: float) -> str:
    """Run a command, interrupt it after so many seconds, and return its error, if any."""
    if seconds < 1.0:
        return "not begun: the time was over"
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    try:
        _, error = process.communicate(timeout=seconds)
        return error.strip() or f"exit code {process.returncode}" if process.returncode else ""
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGINT)
    try:
        process.communicate(timeout=TIME_TO_STOP)
        return f"interrupted after {seconds:.0f} s"
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        return f"killed after {seconds + TIME_TO_STOP:.0f} s"


def verdicts(rows: list[dict[str, Any]]) -> list[tuple[str, Optional[bool]]]:
    """Return each bound with its number, and whether it holds; None if it was not measured."""
    on = {(row["case"], row["device"]): row for row in rows if "error" not in row}
    bounds: list[tuple[str, Optional[bool]]] = []
    for case, speed in MIN_SPEED.items():
        row = on.get((case, "gpu"))
        value = row["updates_per_s"] if row else None
        text = "not measured" if value is None else f"{value / 1e9:.2f}"
        bounds.append(
            (
                f"{case}: {text} G updates/s, at least {speed / 1e9:.2f}",
                None if value is None else value >= speed,
            )
        )
    for case, (quantity, least) in MIN_RATIO.items():
        card, threads = on.get((case, "gpu")), on.get((case, "cpu"))
        ratio = None
        if card and threads:
            ratio = card[quantity] / threads[quantity]
            ratio = 1.0 / ratio if quantity == "wall_s" else ratio
        text = "not measured" if ratio is None else f"{ratio:.1f}"
        bounds.append(
            (
                f"{case}: {text} times two threads, at least {least:g}",
                None if ratio is None else ratio >= least,
            )
        )
    return bounds


def write_result(record: dict[str, Any], folder: Path, kind: str) -> Path:
    """Write the record under the date, complete or not at all; return its file."""
    folder.mkdir(parents=True, exist_ok=True)
    file = folder / f"{record['date']}-{kind}.json"
    descriptor, temporary = tempfile.mkstemp(dir=folder, suffix=".tmp")
    with os.fdopen(descriptor, "w", encoding="utf-8") as stream:
        stream.write(json.dumps(record, indent=1) + "\n")
    Path(temporary).chmod(0o644)
    Path(temporary).replace(file)
    return file


def cpu_name() -> str:
    """Return the name of the processor."""
    cpuinfo = Path("/proc/cpuinfo")
    lines = cpuinfo.read_text(encoding="utf-8").splitlines() if cpuinfo.exists() else []
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def write_small_scenes(folder: Path) -> None:
    """Write a scene for a card with each scheme, and with the balance of energy."""
    for scheme in ("thesis", "objective"):
        scene = small_slab()
        scene["numerics"].update(device="gpu", scheme=scheme)
        scene["events"] = {"max_time": 0.005, "rest_time": 0.005}
        scene["output"]["energy"] = True
        file = folder / f"small-{scheme}.json"
        file.write_text(json.dumps(scene) + "\n", encoding="utf-8")


def record_of(given: argparse.Namespace, rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Return the record of the runs so far."""
    names = {row["case"] for row in rows}
    return {
        "date": datetime.date.today().isoformat(),
        "card": given.card,
        "cpu": cpu_name(),
        "cores": given.cores,
        "cases": rows,
        "bounds": [
            {"bound": text, "holds": holds}
            for text, holds in verdicts(rows)
            if text.partition(":")[0] in names
        ],
    }


def main() -> int:
    """Run the cases of a group, write the record after each, and print the verdicts."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", nargs="?", help="snowshed-run")
    parser.add_argument("folder", nargs="?", type=Path, help="folder for scenes and results")
    parser.add_argument("--group", choices=("speed", "panel", "rehearsal"), default="speed")
    parser.add_argument("--write-small", type=Path, help="only write small scenes into this folder")
    parser.add_argument("--card", default="", help="name and driver of the card")
    parser.add_argument("--cores", type=int, default=os.cpu_count())
    parser.add_argument("--seconds", type=float, default=480.0, help="time for all runs")
    parser.add_argument("--records", type=Path, default=RESULTS, help="folder of the record")
    given = parser.parse_args()
    if given.write_small:
        write_small_scenes(given.write_small)
        return 0
    given.folder.mkdir(parents=True, exist_ok=True)
    rows: list[dict[str, Any]] = []
    end = time.perf_counter() + given.seconds
    for case in cases_of(given.group):
        left = end - time.perf_counter()
        rows.append(measured(given.program, given.folder, case, min(TIME_LIMIT, left)))
        print("gpu_check:", json.dumps(rows[-1]), flush=True)
        target = write_result(record_of(given, rows), given.records, f"gpu-{given.group}")
    print("gpu_check: written:", target)
    bounds = record_of(given, rows)["bounds"]
    for bound in bounds:
        verdict = {True: "holds", False: "MISSED", None: "-"}[bound["holds"]]
        print("gpu_check:", verdict, bound["bound"])
    if given.group == "rehearsal":
        return int(any("error" in row for row in rows))
    return int(not all(bound["holds"] for bound in bounds))


if __name__ == "__main__":
    sys.exit(main())
