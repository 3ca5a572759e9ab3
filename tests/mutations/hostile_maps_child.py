"""A process that reads hostile maps.

``hostile_maps_child.py FOLDER TRIES FIRST MEMORY_MB ADDRESS OUTSIDE`` makes and reads them, from
the FIRST on, and prints a line of JSON before and after each. They refer to ADDRESS and to files
in OUTSIDE in many forms. A map that takes too long or too much memory kills the process, and its
caller continues after that map.
"""

from __future__ import annotations

import resource
import shutil
import signal
import sys
import warnings
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1])]
from child import HANG_S, MAX_LENGTH, address_space, limit_memory, report  # noqa: E402
from helpers.slide_files import write_project  # noqa: E402
from hostile_maps import MAKERS, SECRET, Attack, Chance  # noqa: E402

from snowshed import InputError, SimulationError, _core  # noqa: E402
from snowshed.io.raster.areas import read_areas  # noqa: E402
from snowshed.io.raster.raster import read_raster  # noqa: E402
from snowshed.scene.builders.avaframe.files import copy_inputs  # noqa: E402
from snowshed.scene.builders.avaframe.project import avaframe_simulations  # noqa: E402

HANG_WALL_S = 120  # for readers that wait without computing, such as for a pipe


def read(file: Path, results: Path) -> None:
    """Read a map, polygons or a project as the command line does before it runs."""
    if file.is_dir():
        for simulation in avaframe_simulations(file, ascii_copy=results / "copy.asc"):
            resolved = simulation.scene.resolve()
            _core.Simulation(resolved.json, resolved.base_dir)
            copy_inputs(simulation.inputs, results)
    elif file.suffix in (".asc", ".tif"):
        read_raster(file)
    else:
        read_areas(file)


def outcome(t: Attack, name: str) -> str:
    """Return the outcome of reading an input."""
    file = MAKERS[name](t)
    results = t.folder / "results"
    results.mkdir()
    signal.setitimer(signal.ITIMER_PROF, HANG_S)  # ends the process, also in the core
    signal.setitimer(signal.ITIMER_REAL, HANG_WALL_S)
    try:
        read(file, results)
        result = "accepted"
    except (InputError, SimulationError, OSError) as error:
        result = "refused" if len(str(error)) <= MAX_LENGTH else "LONG MESSAGE"
    except MemoryError:
        result = "MEMORY"
    except BaseException as error:
        result = f"TRACEBACK {type(error).__name__}: {error}"[:500]
    signal.setitimer(signal.ITIMER_PROF, 0)
    signal.setitimer(signal.ITIMER_REAL, 0)
    copies = (copy for copy in results.rglob("*") if copy.is_file())
    return "COPIED A SECRET" if any(SECRET in copy.read_bytes() for copy in copies) else result


def main() -> None:
    """Read the inputs."""
    folder, tries, first, memory = Path(sys.argv[1]), *map(int, sys.argv[2:5])
    address, outside = sys.argv[5], Path(sys.argv[6])
    warnings.simplefilter("ignore")
    cases = [(name, seed) for name in MAKERS for seed in range(tries)]
    warm = folder / "warm"
    warm.mkdir(parents=True, exist_ok=True)
    read(write_project(warm / "project", "tEnd = 0.1\n"), warm)
    limit_memory(address_space() + (memory << 20))  # modules for reading are imported by now
    for name, seed in cases[first:]:
        input_folder = folder / "input"
        shutil.rmtree(input_folder, ignore_errors=True)
        input_folder.mkdir()
        report(reader=name, seed=seed)
        result = outcome(Attack(input_folder, address, outside, Chance(f"{name} {seed}")), name)
        report(reader=name, seed=seed, outcome=result)


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    main()
