"""A process that reads hostile maps.

``hostile_maps_child.py FOLDER TRIES FIRST MEMORY_MB ADDRESS OUTSIDE`` makes and reads them, from
the FIRST on, and prints a line of JSON before and after each. They name ADDRESS and files in
OUTSIDE in every way. A map that takes too long or too much memory kills the process, and its caller
continues after that map.
"""

from __future__ import annotations

import resource
import shutil
import signal
import sys
import warnings
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1])]
from child import HANG_S, MAX_LENGTH, limit_memory, tell, used  # noqa: E402
from helpers.slide_files import write_project  # noqa: E402
from hostile_maps import MAKERS, SECRET, Chance, Try  # noqa: E402

from snowshed import InputError, SimulationError, _core  # noqa: E402
from snowshed.io.raster.areas import read_areas  # noqa: E402
from snowshed.io.raster.raster import read_raster  # noqa: E402
from snowshed.scene.builders.avaframe import avaframe_simulations  # noqa: E402
from snowshed.scene.builders.avaframe_files import copy_inputs  # noqa: E402

HANG_WALL_S = 120  # for readers that wait without computing, such as for a pipe


def read(file: Path, results: Path) -> None:
    """Read a map, polygons or a project as the command line does before it runs."""
    if file.is_dir():
        for simulation in avaframe_simulations(file, ascii_copy=results / "copy.asc"):
            ready = simulation.scene.resolve()
            _core.Simulation(ready.json, ready.base_dir)
            copy_inputs(simulation.inputs, results)
    elif file.suffix in (".asc", ".tif"):
        read_raster(file)
    else:
        read_areas(file)


def outcome(t: Try, name: str) -> str:
    """Return the outcome of reading an input."""
    file = MAKERS[name](t)
    results = t.folder / "results"
    results.mkdir()
    signal.setitimer(signal.ITIMER_PROF, HANG_S)  # ends the process, also in the core
    signal.setitimer(signal.ITIMER_REAL, HANG_WALL_S)
    try:
        read(file, results)
        found = "accepted"
    except (InputError, SimulationError, OSError) as error:
        found = "refused" if len(str(error)) <= MAX_LENGTH else "LONG MESSAGE"
    except MemoryError:
        found = "MEMORY"
    except BaseException as error:
        found = f"TRACEBACK {type(error).__name__}: {error}"[:500]
    signal.setitimer(signal.ITIMER_PROF, 0)
    signal.setitimer(signal.ITIMER_REAL, 0)
    copied = (each for each in results.rglob("*") if each.is_file())
    return "COPIED A SECRET" if any(SECRET in each.read_bytes() for each in copied) else found


def main() -> None:
    """Read the inputs."""
    folder, tries, first, memory = Path(sys.argv[1]), *map(int, sys.argv[2:5])
    address, outside = sys.argv[5], Path(sys.argv[6])
    warnings.simplefilter("ignore")
    every = [(name, seed) for name in MAKERS for seed in range(tries)]
    warm = folder / "warm"
    warm.mkdir(parents=True, exist_ok=True)
    read(write_project(warm / "project", "tEnd = 0.1\n"), warm)
    limit_memory(used() + (memory << 20))  # modules for reading are imported by now
    for name, seed in every[first:]:
        place = folder / "input"
        shutil.rmtree(place, ignore_errors=True)
        place.mkdir()
        tell(reader=name, seed=seed)
        found = outcome(Try(place, address, outside, Chance(f"{name} {seed}")), name)
        tell(reader=name, seed=seed, outcome=found)


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    main()
