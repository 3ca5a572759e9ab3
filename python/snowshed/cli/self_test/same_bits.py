"""Reproducibility checks: threads, a checkpoint, the executable."""

from __future__ import annotations

import shutil
import subprocess
import sysconfig
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import snowshed._core as _core
from snowshed.base.arrays import Floats
from snowshed.io.vtk.vtp import read_particles
from snowshed.running.event_driver import EventDriver
from snowshed.scene.scene import Scene

FINE = 0.0025  # m, cells that give enough particles for two threads
COARSE = 0.02  # m, cells that give few particles
STEPS = 200
#: Limit on the run time of the executable, far beyond the usual time, s.
TIME_LIMIT_S = 120.0


def panel_scene(dx: float, threads: int) -> Scene:
    """Return the first tenth of a second of a slide-off from the laboratory's panel, in 2D."""
    scene = Scene.preset("lab-50").update({"dimension": 2, "events.count": 1})
    scene.update({"numerics.dx": dx, "numerics.threads": threads})
    return scene.set("events.max_time", 0.1)


def threads_error() -> float:
    """Return the share of particles that differ between one and two threads."""
    single, two = (EventDriver(panel_scene(FINE, threads)) for threads in (1, 2))
    for drive in (single, two):
        drive.step(STEPS)
    return different(single.core, two.core)


def checkpoint_error() -> float:
    """Return the share of particles that differ between a run and its continuation."""
    uninterrupted, interrupted = (
        EventDriver(panel_scene(COARSE, threads=1)).core for _ in range(2)
    )
    uninterrupted.run(_continue)
    interrupted.run(lambda report: bool(report["steps"] < STEPS), 0.0)
    with TemporaryDirectory() as folder:
        checkpoint = str(Path(folder) / "checkpoint.bin")
        interrupted.save(checkpoint)
        resumed = _core.Simulation.load(checkpoint)
    resumed.run(_continue)
    return different(uninterrupted, resumed)


def executable_error() -> float:
    """Return the share of particles that differ between ``snowshed-run`` and Python.

    Raises
    ------
    InputError
        If it is not found.
    SimulationError
        If it fails.
    """
    scene = panel_scene(COARSE, threads=1).resolve()
    with TemporaryDirectory() as folder:
        file, out = Path(folder) / "scene.json", Path(folder) / "out"
        scene.save(file)
        command = [executable(), str(file), "-o", str(out), "--quiet"]
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=TIME_LIMIT_S, check=False
        )
        if done.returncode != 0:
            raise _core.SimulationError(f"exit code {done.returncode}: {done.stderr.strip()}")
        particles = read_particles(out / "particles" / "event_001.vtp")
    here = EventDriver(panel_scene(COARSE, threads=1)).core
    here.run(_continue)
    return _different_rows(particles["position"], here.positions().astype(np.float32))


def executable() -> str:
    """Return the path of ``snowshed-run``.

    Raises
    ------
    InputError
        If it is neither beside Python nor on the search path.
    """
    beside = sysconfig.get_path("scripts")
    program = shutil.which("snowshed-run", path=beside) or shutil.which("snowshed-run")
    if program is None:
        raise _core.InputError(f"snowshed-run is neither in {beside} nor on the search path")
    return program


def _continue(report: object) -> bool:
    return True


def different(first: _core.Simulation, other: _core.Simulation) -> float:
    """Return the share of particles whose positions or velocities differ in any bit."""
    states = (np.hstack([core.positions(), core.velocities()]) for core in (first, other))
    return _different_rows(*states)


def _different_rows(first: Floats, other: Floats) -> float:
    if first.shape != other.shape:
        return 1.0
    return float((first != other).any(axis=1).mean())
