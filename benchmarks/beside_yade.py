"""Compare the speed of grains with Yade, side by side in one run.

Usage: python -m benchmarks.beside_yade [--size 40] [--threads 2]

Both programs take steps of the same length in a confined compression of the same clumps, bonds and
plates (see benchmarks/engines); the best of two runs counts. The unit is a step of one sphere on
the surface of a grain. The command writes benchmarks/results/DATE-grains.json. Nothing else should
run on the machine meanwhile.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

import numpy as np
from benchmarks.engines.press import Press
from benchmarks.engines.random_snow import random_snow
from benchmarks.engines.run import press_with_yade, yade_program
from benchmarks.engines.voxel_sample import VoxelSample
from benchmarks.keeping import keep_cases

from snowshed import GrainsSettings, LoadingStage
from snowshed.running.simulation import Simulation
from snowshed.scene import grains_scene

VOXEL = 5e-5  # m
GRAIN = 8  # voxels
REPETITIONS = 2
PRESS = Press(time_step=1e-8, strain=0.3, damping=0.2)


def our_speed(labels: np.ndarray, threads: int, steps: int, folder: Path) -> float:
    """Return snowshed's sphere steps per second."""
    file = folder / "labels.npy"
    np.save(file, labels)
    settings = GrainsSettings(damping=PRESS.damping, threads=threads)
    stage = LoadingStage(kind="compress", speed=PRESS.speed, strain=PRESS.strain)
    scene = grains_scene(file, VOXEL, [stage], settings=settings).update({"gravity": 0})
    simulation = Simulation(scene)
    simulation.begin_event()
    simulation.step(10)
    begin = time.perf_counter()
    simulation.step(steps)
    wall = time.perf_counter() - begin
    spheres = np.count_nonzero(VoxelSample.of_labels(labels, VOXEL).surface)
    return spheres * steps / wall


def main() -> None:
    """Measure both programs, print the numbers, and write them to a file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--size", type=int, default=40, help="voxels along an edge")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--steps", type=int, default=1000)
    options = parser.parse_args()
    if yade_program() is None:
        raise SystemExit("error: this benchmark needs Yade (apt-get install yade)")
    labels = random_snow(options.size, GRAIN, ice=0.36)
    sample = VoxelSample.of_labels(labels, VOXEL)
    spheres = int(np.count_nonzero(sample.surface))
    cases = []
    with tempfile.TemporaryDirectory() as name:
        for threads in sorted({1, options.threads}):
            ours, theirs = [], []
            for _ in range(REPETITIONS):
                ours.append(our_speed(labels, threads, options.steps, Path(name)))
                steps = max(50, options.steps // 10)
                record = press_with_yade(sample, PRESS, Path(name), steps=steps, threads=threads)
                theirs.append(spheres * steps / record.wall_s)
            case = {
                "threads": threads,
                "grains": len(sample.mass),
                "spheres": spheres,
                "bonds": len(sample.bonds),
                "snowshed_sphere_steps_per_s": max(ours),
                "yade_sphere_steps_per_s": max(theirs),
                "ratio": max(ours) / max(theirs),
            }
            cases.append(case)
            print(
                f"{threads} threads, {spheres} spheres: snowshed {max(ours) / 1e6:.1f} M, "
                f"Yade {max(theirs) / 1e6:.2f} M sphere steps a second, ratio {case['ratio']:.1f}"
            )
    keep_cases(cases, "grains")


if __name__ == "__main__":
    main()
