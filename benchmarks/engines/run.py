"""Runs of Yade and LAMMPS in separate processes, if they are installed."""

from __future__ import annotations

import os
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Optional

import numpy as np
from benchmarks.engines.press import Press
from benchmarks.engines.voxel_sample import VoxelSample

HERE = Path(__file__).parent
LAMMPS_PYTHON = "SNOWSHED_LAMMPS_PYTHON"  # variable with the interpreter that has LAMMPS


@dataclass(frozen=True)
class Record:
    """Measurements of an engine over time."""

    time: np.ndarray  # s
    force: np.ndarray  # N, on the top plate
    bonds: np.ndarray  # number of intact bonds
    wall_s: float  # run time of the steps


def yade_program() -> Optional[str]:
    """Return the path of Yade, or None if it is not installed."""
    return shutil.which("yade")


def lammps_python() -> Optional[str]:
    """Return the interpreter that has LAMMPS, or None if there is none."""
    return os.environ.get(LAMMPS_PYTHON) or None


def press_with_yade(
    sample: VoxelSample, press: Press, folder: Path, *, steps: int = 0, threads: int = 1
) -> Record:
    """Return the test's record with Yade; with `steps` above 0, time that many steps instead."""
    program = [str(yade_program()), "-n", f"-j{threads}", "-x", str(HERE / "yade_press.py")]
    return _run(program, sample, press, folder, [str(steps)] if steps else [])


def press_with_lammps(sample: VoxelSample, press: Press, folder: Path) -> Record:
    """Return the test's record with LAMMPS."""
    python = str(lammps_python())
    libraries = Path(python).parent.parent / "lib"  # pip puts the libraries of MPI here
    return _run([python, str(HERE / "lammps_press.py")], sample, press, folder, [], libraries)


def _run(
    program: list[str],
    sample: VoxelSample,
    press: Press,
    folder: Path,
    more: list[str],
    libraries: Optional[Path] = None,
) -> Record:
    files = [folder / name for name in ("sample.npz", "press.json", "record.npz")]
    sample.save(files[0])
    press.save(files[1])
    environment = {**os.environ, "PYTHONPATH": str(HERE)}
    if libraries is not None:
        environment["LD_LIBRARY_PATH"] = str(libraries)
    done = subprocess.run(
        [*program, *map(str, files), *more],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode or not files[2].exists():
        raise RuntimeError(f"{program[0]} failed:\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}")
    with np.load(files[2]) as data:
        return Record(data["time_s"], data["top_n"], data["bonds"], float(data["wall_s"]))
