"""Compare the speed of fluids of particles with MPS-Basic, side by side in one run.

Usage: python -m benchmarks.beside_mps_basic PROGRAM [--radius 2.1 3.1]
[--particles2d 1458 9800] [--particles3d 19652] [--threads 1 2]

PROGRAM is the program of MPS-Basic (Koshizuka and Shibata laboratory, MIT licence), compiled with
optimisation and OpenMP. In both programs a column of water, twice as high as wide, collapses in a
basin twice as long as the column, with the same distance between particles and the same radius of
the pressure's weights. The unit is a step of one water particle, and the best of three runs counts.
MPS-Basic has walls of particles and snowshed has mirrors. The speed of MPS-Basic per particle,
including its walls, is therefore printed, too. The command writes benchmarks/results/DATE-mps.json.
Nothing else should run on the machine meanwhile.
"""

from __future__ import annotations

import argparse
import itertools
import os
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

from benchmarks.keeping import keep_cases

from snowshed.methods.mps.settings import MpsSettings
from snowshed.running.simulation import Simulation
from snowshed.scene.components import Body, Events, Obstacle
from snowshed.scene.scene import Scene
from snowshed.scene.shape import Shape

SPACING = 0.01  # m
GRADIENT_RADIUS = 2.1  # default of MPS-Basic, in spacings
BASIN = 2  # length of the basin, in widths of the column
LAYERS = 4  # layers of MPS-Basic's wall: two with a pressure, and two behind them
STEP = 4e-4  # s, time step of MPS-Basic, with its usual ratio to the spacing
FIRST_STEPS = 5  # untimed steps of MPS-Basic
STEPS = 30  # timed steps of MPS-Basic
OUR_STEPS = 400
REPETITIONS = 3
FLUID, WALL, DUMMY = 1, 2, 3
SETTINGS = """
dim: {dimension}
particleDistance: {spacing}
dt: {step}
endTime: {end}
outputPeriod: 1000.0
cflCondition: 0.3
numPhysicalCores: 1
domainMin: [{low}, {low}, {low}]
domainMax: [{right}, {top}, {back}]
defaultDensity: 1000.0
kinematicViscosity: 1.0e-06
xyz-input: true
gravity: [0.0, -9.81, 0.0]
gravity-norm: 9.81
gravity-angle: 0
surfaceDetection-numberDensity-threshold: 0.97
surfaceDetection-particleDistribution: true
surfaceDetection-particleDistribution-threshold: 1.0
pressureCalculationMethod: Implicit
compressibility: 0.45e-09
relaxationCoefficientForPressure: 0.2
soundSpeed: 17.1
collisionDistanceRatio: 0.5
coefficientOfRestitution: 0.2
radiusRatioForNumberDensity: {radius}
radiusRatioForGradient: {gradient_radius}
radiusRatioForLaplacian: {radius}
particlesPath: ./input.prof
outputVtkInBinary: true
"""


@dataclass(frozen=True)
class Column:
    """Column of water in a basin.

    Attributes
    ----------
    dimension
        2 or 3.
    across
        Number of particles along its width. The column is twice as high as wide, and as deep as
        wide.
    radius
        Radius of the weights, in spacings.
    """

    dimension: int
    across: int
    radius: float

    @classmethod
    def of(cls, dimension: int, particles: int, radius: float) -> Column:
        """Return the column with about this number of particles."""
        return cls(dimension, round((particles / 2) ** (1 / dimension)), radius)

    @property
    def particles(self) -> int:
        """Number of water particles."""
        return 2 * self.across**self.dimension

    @property
    def width(self) -> float:
        """Width of the column, m."""
        return self.across * SPACING


def our_scene(column: Column, threads: int) -> Scene:
    """Return the collapse of a column as a scene."""
    width, plane = column.width, column.dimension == 2
    faces = [((0, 0, 0), (0, 0, 1)), ((0, 0, 0), (1, 0, 0)), ((BASIN * width, 0, 0), (-1, 0, 0))]
    if not plane:
        faces += [((0, 0, 0), (0, 1, 0)), ((0, width, 0), (0, -1, 0))]
    axes = [0, 2] if plane else [0, 1, 2]
    walls = [Shape.plane(*([vector[d] for d in axes] for vector in face)) for face in faces]
    size = (width, 2 * width) if plane else (width, width, 2 * width)
    return Scene(
        dimension=column.dimension,
        method="mps",
        numerics=MpsSettings(
            spacing=SPACING,
            radius=column.radius,
            density=1000.0,
            viscosity=1e-3,
            rheology="newtonian",
            threads=threads,
        ),
        obstacles=[
            Obstacle(name=f"wall {k}", shape=wall, condition="sticky")
            for k, wall in enumerate(walls, start=1)
        ],
        bodies=[Body(shape=Shape.box(tuple(0.5 * length for length in size), size))],
        events=Events(count=1, max_time=1000.0, between="carry"),
    )


def our_speed(column: Column, threads: int) -> tuple[float, float]:
    """Return snowshed's particle steps per second, and the mean time step (s)."""
    simulation = Simulation(our_scene(column, threads))
    simulation.begin_event()
    simulation.step(10)
    start, begin = simulation.time, time.perf_counter()
    simulation.step(OUR_STEPS)
    seconds = time.perf_counter() - begin
    return column.particles * OUR_STEPS / seconds, (simulation.time - start) / OUR_STEPS


def write_basin(column: Column, folder: Path) -> int:
    """Write MPS-Basic's particles, and return their number, including walls."""
    across, inside = column.across, [BASIN * column.across, 2 * column.across + 10]
    if column.dimension == 3:
        inside.append(across)
    ranges = [range(-LAYERS, inside[0] + LAYERS), range(-LAYERS, inside[1])]
    if column.dimension == 3:
        ranges.append(range(-LAYERS, inside[2] + LAYERS))
    lines = []
    for place in itertools.product(*ranges):
        behind = [max(-k, k - n + 1, 0) for k, n in zip(place, inside)]
        kind = DUMMY if max(behind) > LAYERS // 2 else WALL
        if max(behind) == 0:
            if place[0] >= across or place[1] >= 2 * across:
                continue
            kind = FLUID
        where = [SPACING * (k + 0.5) for k in place] + [0.0] * (3 - len(place))
        lines.append(f"{kind} {where[0]} {where[1]} {where[2]} 0 0 0")
    text = "\n".join(["0", str(len(lines)), *lines]) + "\n"
    (folder / "input.prof").write_text(text, encoding="ascii")
    return len(lines)


def their_seconds(program: Path, column: Column, steps: int, threads: int, folder: Path) -> float:
    """Return the time (s) of MPS-Basic for its start and a number of steps."""
    far = (BASIN + 1) * column.width + 2 * LAYERS * SPACING
    text = SETTINGS.format(
        dimension=column.dimension,
        spacing=SPACING,
        radius=column.radius,
        gradient_radius=GRADIENT_RADIUS,
        step=STEP,
        end=(steps - 0.5) * STEP,
        low=-2 * LAYERS * SPACING,
        right=far,
        top=far,
        back=far,
    )
    (folder / "settings.yml").write_text(text, encoding="ascii")
    output = tempfile.mkdtemp(dir=folder)
    begin = time.perf_counter()
    subprocess.run(
        [program, "--setting", folder / "settings.yml", "--output", output],
        check=True,
        capture_output=True,
        env={**os.environ, "OMP_NUM_THREADS": str(threads)},
    )
    return time.perf_counter() - begin


def compare(program: Path, column: Column, threads: int) -> dict[str, float]:
    """Let a column collapse with both programs in turn, and print a line."""
    ours, theirs, step = [], [], 0.0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        all_particles = write_basin(column, folder)
        for _ in range(REPETITIONS):
            speed, step = our_speed(column, threads)
            ours.append(speed)
            first, last = (
                their_seconds(program, column, steps, threads, folder)
                for steps in (FIRST_STEPS, FIRST_STEPS + STEPS)
            )
            theirs.append(STEPS / (last - first))
    case = {
        "dimension": column.dimension,
        "radius": column.radius,
        "threads": threads,
        "particles": column.particles,
        "mps_basic_particles": all_particles,
        "snowshed_per_s": max(ours),
        "mps_basic_per_s": max(theirs) * column.particles,
        "mps_basic_with_walls_per_s": max(theirs) * all_particles,
        "ratio": max(ours) / max(theirs) / column.particles,
        "ratio_with_walls": max(ours) / max(theirs) / all_particles,
        "snowshed_step_s": step,
        "mps_basic_step_s": STEP,
    }
    print(" ".join(f"{value:>9.3g}" for value in case.values()), flush=True)
    return case


def main() -> None:
    """Print a table of speeds and their ratios, and write it to a file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=Path, help="program of MPS-Basic")
    parser.add_argument("--radius", type=float, nargs="*", default=[2.1, 3.1])
    parser.add_argument("--particles2d", type=int, nargs="*", default=[1458, 9800])
    parser.add_argument("--particles3d", type=int, nargs="*", default=[19652])
    parser.add_argument("--threads", type=int, nargs="*", default=[1, 2])
    options = parser.parse_args()
    sizes = [(2, count) for count in options.particles2d]
    sizes += [(3, count) for count in options.particles3d]
    columns = [Column.of(*size, radius) for size in sizes for radius in options.radius]
    heads = ("", "radius", "threads", "water", "+ walls", "ours/s", "its/s", "+ walls/s")
    print(*(f"{head:>9}" for head in (*heads, "ratio", "+ walls", "our step", "its step")))
    cases = [compare(options.program, column, n) for column in columns for n in options.threads]
    keep_cases(cases, "mps")


if __name__ == "__main__":
    main()
