"""Compare the speed of snow slides with AvaFrame's com5SnowSlide, side by side in one run.

Usage: python -m benchmarks.beside_avaframe AVAFRAME_PYTHON [--particles 360 1100 100000]
[--projects FOLDER ...]

AVAFRAME_PYTHON is the interpreter of an environment with AvaFrame 2.1 (``pip install
avaframe==2.1``). Both programs run the same project folders in turn, in steps of 0.01 s; the best
of three runs counts. The projects are slabs with about the given numbers of particles on an incline
with run-out, and copies of the given FOLDERs without their ini files. For AvaFrame two times are
given: that of its loop over time steps, which also updates the peaks and reports progress, and that
of its function for a time step alone. Our time is that of the loop over time steps, including the
peaks. Nothing else should run on the machine meanwhile.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

from snowshed.io.raster.raster import Raster, write_ascii_grid
from snowshed.running.simulation import Simulation
from snowshed.scene.builders.avaframe.project import avaframe_scene

CELL = 2.0  # m
THICKNESS = 0.5  # m; two particles per cell
REPETITIONS = 3

# Program for AvaFrame's environment: makes the shapefile that both programs read, or times steps.
AVAFRAME = """
import json, logging, sys, time
from pathlib import Path
project, steps = Path(sys.argv[1]), int(sys.argv[2])
if steps == 0:
    import shapefile
    low, high = float(sys.argv[3]), float(sys.argv[4])
    with shapefile.Writer(str(project / "Inputs/REL/slab")) as out:
        out.field("name", "C"); out.field("thickness", "N", decimal=3)
        out.poly([[[low, low], [low, high], [high, high], [high, low], [low, low]]])
        out.record("slab", float(sys.argv[5]))
    sys.exit()
import matplotlib; matplotlib.use("Agg")
logging.disable(logging.WARNING)
from avaframe.in3Utils import cfgUtils, initializeProject
from avaframe.com1DFA import com1DFA
from avaframe.com5SnowSlide import com5SnowSlide
spent = {"s": 0.0, "loop_s": 0.0, "particle_steps": 0}
original = com1DFA.computeEulerTimeStep
def timed(*args, **options):
    begin = time.perf_counter()
    result = original(*args, **options)
    spent["s"] += time.perf_counter() - begin
    spent["particle_steps"] += int(result[0]["nPart"])
    return result
com1DFA.computeEulerTimeStep = timed
iterate = com1DFA.DFAIterate
def counted(*args, **options):
    begin = time.perf_counter()
    result = iterate(*args, **options)
    spent["loop_s"] += time.perf_counter() - begin
    (project / "spent.json").write_text(json.dumps(spent))  # it runs in a process of its own
    return result
com1DFA.DFAIterate = counted
com1DFA.oP.plotAllPeakFields = lambda *a, **k: {}
main = cfgUtils.getGeneralConfig()
main["MAIN"]["avalancheDir"] = str(project)
main["FLAGS"]["createReport"] = "False"
initializeProject.cleanSingleAvaDir(str(project), deleteOutput=True)
cfg = cfgUtils.getModuleConfig(com5SnowSlide, str(project), toPrint=False)
cfg["com1DFA_com1DFA_override"]["tEnd"] = str(0.01 * steps)
com5SnowSlide.com5SnowSlideMain(main, cfg)
"""


def make_project(folder: Path, particles: int, python: str) -> None:
    """Write a project folder whose slab has about this number of particles."""
    side = math.sqrt(particles / 2) * CELL
    columns, rows = int((side + 240) / CELL), int((side + 40) / CELL)
    x = np.arange(columns) * CELL
    fall = np.minimum(x, side + 160) * math.tan(math.radians(35))
    heights = np.broadcast_to(500 + fall.max() - fall, (rows, columns))
    (folder / "Inputs" / "REL").mkdir(parents=True)
    raster = Raster(heights, east=0.0, north=0.0, cell=CELL)
    write_ascii_grid(folder / "Inputs" / "dem.asc", raster)
    place = [str(20.0), str(20.0 + side), str(THICKNESS)]
    subprocess.run([python, "-I", "-c", AVAFRAME, str(folder), "0", *place], check=True)


def avaframe_seconds(folder: Path, steps: int, python: str) -> tuple[float, float]:
    """Return AvaFrame's time for a particle step (s), from its loop and from its steps alone."""
    subprocess.run(
        [python, "-I", "-c", AVAFRAME, str(folder), str(steps)],
        check=True,
        capture_output=True,
        cwd=folder,
    )
    spent = json.loads((folder / "spent.json").read_text())
    return tuple(spent[key] / spent["particle_steps"] for key in ("loop_s", "s"))


def our_seconds(folder: Path, steps: int) -> tuple[float, int]:
    """Return our time for a particle step (s), and the number of particles."""
    simulation = Simulation(avaframe_scene(folder))
    simulation.begin_event()
    particles = simulation.particle_count
    begin = time.perf_counter()
    simulation.step(steps)
    return (time.perf_counter() - begin) / steps / particles, particles


def copied_project(project: Path, folder: Path) -> None:
    """Copy the files of a project folder that both programs read."""
    for part in ("dem.*", "REL/*"):
        for file in (project / "Inputs").glob(part):
            copy = folder / file.relative_to(project)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, copy)


def compare(folder: Path, name: str, steps: int, python: str) -> None:
    """Run a project with both programs in turn, and print a line."""
    ours, theirs, particles = [], [], 0
    for _ in range(REPETITIONS):
        seconds, particles = our_seconds(folder, steps)
        ours.append(seconds)
        theirs.append(avaframe_seconds(folder, steps, python))
    (loop, step), best = np.min(theirs, axis=0), min(ours)
    print(
        f"{name:>12} {particles:>10} {1e6 * loop:>10.2f} {1e6 * step:>10.2f} {1e6 * best:>10.4f} "
        f"{loop / best:>8.1f} {step / best:>6.1f}",
        flush=True,
    )


def main() -> None:
    """Print a table of times and their ratios."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("python", help="interpreter that has AvaFrame")
    parser.add_argument("--particles", type=int, nargs="*", default=[360, 1100, 100_000])
    parser.add_argument("--projects", type=Path, nargs="*", default=[])
    options = parser.parse_args()
    print(f"{os.cpu_count()} cores; microseconds for a particle step")
    print(f"{'':>23} {'AvaFrame':>21} {'':>10} {'ratio':>15}")
    units = [f"{unit:>10}" for unit in ("particles", "loop", "step", "snowshed")]
    print(f"{'':>12}", *units, f"{'loop':>8} {'step':>6}")
    for wanted in options.particles:
        with tempfile.TemporaryDirectory() as name:
            make_project(Path(name), wanted, options.python)
            compare(Path(name), "incline", 500 if wanted < 10_000 else 20, options.python)
    for project in options.projects:
        with tempfile.TemporaryDirectory() as name:
            copied_project(project, Path(name))
            compare(Path(name), project.name, 500, options.python)


if __name__ == "__main__":
    main()
