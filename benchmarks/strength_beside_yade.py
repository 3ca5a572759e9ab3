"""Compress samples with Yade and with snowshed, and compare their stresses.

Usage: python -m benchmarks.strength_beside_yade FOLDER/samples/field-318-*-coarser2.npy
[--strain 0.15]

The files are those of `snowshed reproduce hagenmuller2015 --quick -o FOLDER`: labels on voxels of
100 um. Both engines press the same clumps, bonds and plates with the same law. Ice has its own
density, and the speed of the plate is chosen so that density times speed squared is that of the
reproduction. The command prints the peak below 5 % of strain and the means from 5 to 10 and from 10
to 15 % (kPa), and writes benchmarks/results/DATE-yade-strength.json. Yade takes about five minutes
per sample.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import numpy as np
from benchmarks.engines.press import Press
from benchmarks.engines.run import press_with_yade, yade_program
from benchmarks.engines.voxel_sample import VoxelSample
from benchmarks.keeping import keep_cases

from snowshed import GrainsSettings, LoadingStage
from snowshed.running.run import run
from snowshed.scene import grains_scene

VOXEL = 1e-4  # m
SPEED = 0.02 * 10**0.5  # m/s, with ice of its own density
YADE_STEP = 2.3e-8  # s
RANGES = ((0.05, 0.10), (0.10, 0.15))


def snowshed_stresses(file: Path, strain: float) -> list[float]:
    """Return the peak and the means by snowshed, kPa."""
    stage = LoadingStage(kind="compress", speed=SPEED, strain=strain)
    scene = grains_scene(file, VOXEL, [stage], settings=GrainsSettings(damping=0.2, threads=1))
    with tempfile.TemporaryDirectory() as name:
        summary = run(scene.update({"gravity": 0}), Path(name) / "out", pictures=False).summary
    stresses = (summary.strength_pa, summary.mean_stress_5_10_pa, summary.mean_stress_10_15_pa)
    return [float("nan") if value is None else value / 1e3 for value in stresses]


def yade_stresses(file: Path, strain: float) -> list[float]:
    """Return the peak and the means by Yade, kPa."""
    sample = VoxelSample.of_labels(np.load(file), VOXEL)
    press = Press(YADE_STEP, SPEED, strain, friction=0.2, damping=0.2, every=200)
    with tempfile.TemporaryDirectory() as name:
        record = press_with_yade(sample, press, Path(name))
    strains = record.time * SPEED / sample.height
    stress = np.abs(record.force) / (sample.box[0] * sample.box[1]) / 1e3
    within = [stress[(strains > low) & (strains <= high)] for low, high in RANGES]
    means = [float(part.mean()) if len(part) else float("nan") for part in within]
    return [float(stress[strains <= RANGES[0][0]].max()), *means]


def main() -> None:
    """Compare the stresses, print them, and write them to a file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("samples", type=Path, nargs="+")
    parser.add_argument("--strain", type=float, default=0.15)
    options = parser.parse_args()
    if yade_program() is None:
        raise SystemExit("error: this benchmark needs Yade (apt-get install yade)")
    cases = []
    print(f"{'kPa':>30} {'peak':>8} {'5-10 %':>8} {'10-15 %':>8}")
    for file in options.samples:
        for engine, press in (("snowshed", snowshed_stresses), ("Yade", yade_stresses)):
            stresses = press(file, options.strain)
            print(f"{file.stem[-20:]:>20} {engine:>9}", *(f"{value:>8.3g}" for value in stresses))
            cases.append({"sample": file.stem, "engine": engine, "kpa": stresses})
    keep_cases(cases, "yade-strength")


if __name__ == "__main__":
    main()
