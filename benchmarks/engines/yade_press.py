"""Confined compression of a sample with Yade: yade -n -x yade_press.py SAMPLE PRESS OUT [steps].

SAMPLE is a file of `VoxelSample.save`, and PRESS a file of `Press.save`. OUT becomes an NPZ file
with time_s, top_n (force on the top plate), bonds, and wall_s of the steps.

In Yade the mass of a clump is that of its spheres. Therefore all voxels become spheres with the
mass of a voxel, also the inner ones. The difference in inertia between a cube and a ball is
isotropic and is added. If the number of steps is given, as in measurements of speed, only the
voxels of the surface become spheres, with the same mass.

The folder of this file must be in PYTHONPATH.
"""

from __future__ import annotations

import math
import sys
import time
from pathlib import Path

import numpy as np
from press import Press
from voxel_sample import ICE_DENSITY, VoxelSample
from yade import utils
from yade import wrapper as y


def material(press: Press, friction: float) -> y.CohFrictMat:
    """Return a material without cohesion that gives each ball the mass of a voxel."""
    return y.CohFrictMat(
        young=press.elastic_modulus,
        poisson=press.stiffness_ratio,
        density=ICE_DENSITY * 6 / math.pi,
        frictionAngle=math.atan(friction),
        isCohesive=False,
    )


class Pressed:
    """Sample between plates and walls in Yade's scene."""

    def __init__(self, sample: VoxelSample, press: Press, hollow: bool) -> None:
        self.press = press
        rough = y.O.materials.append(material(press, press.friction))
        smooth = y.O.materials.append(material(press, 0.0))
        self.ids = self._add_grains(sample, rough, sample.surface | (not hollow))
        self.top = self._add_plate(sample, rough, sample.height + sample.radius, -press.speed)
        self._add_plate(sample, rough, -sample.radius, 0.0)
        self._add_walls(sample, smooth)
        self._set_engines()
        self.bonds = self._bond(sample)

    def _add_grains(self, sample: VoxelSample, rough: int, is_sphere: np.ndarray) -> np.ndarray:
        ids = np.full(len(sample.grain), -1)
        for grain in range(len(sample.mass)):
            members = np.flatnonzero((sample.grain == grain) & is_sphere)
            spheres = [
                utils.sphere(tuple(sample.centres[m]), sample.radius, material=rough)
                for m in members
            ]
            clump, parts = y.O.bodies.appendClumped(spheres, discretization=0)
            ids[members] = parts
            rest = (2 / 3 - 2 / 5) * sample.radius**2 * y.O.bodies[clump].state.mass
            inertia = y.O.bodies[clump].state.inertia
            y.O.bodies[clump].state.inertia = tuple(i + rest for i in inertia)
        return ids

    def _add_plate(self, sample: VoxelSample, rough: int, z: float, speed: float) -> list[int]:
        """Add a grid of spheres that extends two spheres beyond the box."""
        ids = []
        for i in range(-2, round(sample.box[0] / sample.radius / 2) + 2):
            for j in range(-2, round(sample.box[1] / sample.radius / 2) + 2):
                at = ((2 * i + 1) * sample.radius, (2 * j + 1) * sample.radius, z)
                body = utils.sphere(at, sample.radius, material=rough, fixed=True)
                body.state.vel = (0, 0, speed)
                ids.append(y.O.bodies.append(body))
        return ids

    def _add_walls(self, sample: VoxelSample, smooth: int) -> None:
        thick = 4 * sample.radius
        for axis in (0, 1):
            for sign in (-1, 1):
                centre, half = 0.5 * sample.box, sample.box.copy()
                half[axis] = thick / 2
                centre[axis] += sign * 0.5 * (sample.box[axis] + thick)
                y.O.bodies.append(
                    utils.box(tuple(centre), tuple(half), fixed=True, material=smooth)
                )

    def _set_engines(self) -> None:
        # Yade's default moves the points of contact of two spheres outward to where they would just
        # touch, so that cycles of load cannot creep. Slips of pressed spheres are then larger than
        # those of the points themselves, and peaks with friction are 1.5 % larger.
        spheres = y.Ig2_Sphere_Sphere_ScGeom6D(avoidGranularRatcheting=False)
        y.O.engines = [
            y.ForceResetter(),
            y.InsertionSortCollider([y.Bo1_Sphere_Aabb(), y.Bo1_Box_Aabb()]),
            y.InteractionLoop(
                [spheres, y.Ig2_Box_Sphere_ScGeom6D()],
                [y.Ip2_CohFrictMat_CohFrictMat_CohFrictPhys()],
                [y.Law2_ScGeom6D_CohFrictPhys_CohesionMoment(useIncrementalForm=True)],
            ),
            y.NewtonIntegrator(damping=self.press.damping, gravity=(0, 0, 0)),
        ]
        y.O.dt = self.press.time_step

    def _bond(self, sample: VoxelSample) -> list[tuple[int, int]]:
        """Make a bond for each pair of voxels of different grains that share a face."""
        face = (2 * sample.radius) ** 2
        pairs = [(int(a), int(b)) for a, b in self.ids[sample.bonds]]
        for a, b in pairs:
            contact = utils.createInteraction(a, b)
            contact.phys.normalAdhesion = self.press.tensile_strength * face
            contact.phys.shearAdhesion = self.press.shear_strength * face
            contact.phys.fragile = True
            contact.phys.cohesionBroken = False
        return pairs

    def top_force(self) -> float:
        """Return the force of the grains on the top plate, N."""
        return float(utils.sumForces(self.top, (0, 0, 1)))

    def count_bonds(self) -> int:
        """Return the number of intact bonds."""
        return sum(
            y.O.interactions.has(a, b)
            and y.O.interactions[a, b].isReal
            and not y.O.interactions[a, b].phys.cohesionBroken
            for a, b in self.bonds
        )


def main() -> None:
    """Run the test, and write its record."""
    sample, press = VoxelSample.load(Path(sys.argv[1])), Press.load(Path(sys.argv[2]))
    timed = len(sys.argv) > 4
    pressed = Pressed(sample, press, hollow=timed)
    steps = int(sys.argv[4]) if timed else press.steps(sample.height)
    rows = [(0.0, 0.0, len(pressed.bonds))]  # without any force yet
    if timed:
        y.O.run(10, wait=True)  # finds the contacts
    begin = time.perf_counter()
    if timed:
        y.O.run(steps, wait=True)
    while not timed and y.O.iter < steps:
        y.O.run(press.every, wait=True)
        # The forces belong to the positions before the last step's motion.
        rows.append((y.O.time - y.O.dt, pressed.top_force(), pressed.count_bonds()))
    wall = time.perf_counter() - begin
    times, forces, bonds = np.array(rows).T
    np.savez(
        sys.argv[3],
        time_s=times,
        top_n=forces,
        bonds=bonds,
        wall_s=wall,
        spheres=np.count_nonzero(sample.surface),
    )


main()
