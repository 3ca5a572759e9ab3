"""The grid of a run at a moment: computed from the particles, as a Dataset and for ParaView.

The solver stores no grid between steps. This is the same transfer from particles to grid, by the
same B-splines at the same nodes (docs/methods/mpm-step.md), outside of the steps. It is written in
NumPy, because the solver's transfer takes sorted tiles of particles in packs; tests compare the
two, so each checks the other.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.base.arrays import Floats
from snowshed.base.extras import require
from snowshed.base.paths import PathLike
from snowshed.io.vtk.vti import write_image
from snowshed.io.vtk.vtp import read_particles
from snowshed.methods.registry import method_of
from snowshed.results.particle_dataset import AXES

if TYPE_CHECKING:
    import xarray

MEANINGS = {
    "mass": ("kg", "Mass at a node; in 2D per metre of width"),
    "velocity": ("m/s", "Velocity at a node; zero where there is no mass"),
    "density": ("kg/m3", "Mass at a node over the volume of a cell"),
}
Basis = Literal["quadratic", "cubic"]
#: Number of nodes that a particle reaches along an axis, and the smallest distance of the particle
#: from the lowest of these nodes, in cells.
SUPPORT = {"quadratic": 3, "cubic": 4}
OFFSET = {"quadratic": 0.5, "cubic": 1.0}
MAX_NODES = 400_000_000


def scene_grid(
    scene: Mapping[str, Any],
    positions: Floats,
    velocities: Floats,
    masses: Floats,
    affine: Optional[Floats] = None,
) -> GridFields:
    """Return mass, velocity and density of a run's particles at the nodes of its grid.

    Parameters
    ----------
    scene
        Complete scene data.
    positions, velocities, masses, affine
        See `snowshed.results.grid.particles_to_grid`.

    Raises
    ------
    InputError
        If the scene's method has no grid, there are no particles, or the memory is too small.
    """
    method = method_of(scene)
    if not method.has_grid:
        raise InputError(f'/method: "{method.name}" has no grid')
    settings = scene["numerics"]
    return particles_to_grid(
        positions, velocities, masses, dx=settings["dx"], dimension=scene["dimension"],
        basis=settings["basis"], affine=affine,
    )  # fmt: skip


def grid_dataset(grid: GridFields, event: int, time: float) -> xarray.Dataset:
    """Return fields of a grid as a Dataset.

    Parameters
    ----------
    grid
        The fields.
    event, time
        The event of the fields, and the time in the event, s.

    Returns
    -------
    xarray.Dataset
        Dimensions x, (y,) z (coordinates of the nodes, m) and component (x, y, z, in 2D, too).

    Raises
    ------
    InputError
        If xarray (extra ``study``) is not installed.
    """
    library = require("xarray", "study", "a Dataset of a grid")
    axes = ["x", "z"] if grid.mass.ndim == 2 else ["x", "y", "z"]
    nodes = {
        axis: (axis, start + grid.dx * np.arange(count), {"units": "m"})
        for axis, start, count in zip(axes, grid.origin.tolist(), grid.mass.shape)
    }
    clock = ((), time, {"units": "s", "long_name": "Time in the event"})
    dataset: xarray.Dataset = library.Dataset(
        {
            "mass": (axes, grid.mass),
            "velocity": ([*axes, "component"], grid.velocity),
            "density": (axes, grid.density),
        },
        coords={**nodes, "component": list(AXES), "event_number": event, "time": clock},
    )
    for name, (unit, meaning) in MEANINGS.items():
        dataset[name].attrs.update(units=unit, long_name=meaning)
    return dataset


def stored_grid(scene: Mapping[str, Any], file: Path) -> GridFields:
    """Return the grid of the particles that a run stored in a file.

    The file holds positions and velocities in single precision. It does not hold the affine
    velocities of APIC, so that their share of a node's momentum is missing.
    """
    fields = {name: values.astype(float) for name, values in read_particles(file).items()}
    return scene_grid(scene, fields["position"], fields["velocity"], fields["mass"])


def write_grid(grid: GridFields, file: PathLike) -> None:
    """Write fields of a grid as a .vti file, which ParaView opens; in 2D y is zero."""
    values = {"mass": grid.mass, "velocity": grid.velocity, "density": grid.density}
    origin = grid.origin
    if grid.mass.ndim == 2:
        origin = np.insert(origin, 1, 0.0)
        values = {name: array[:, None] for name, array in values.items()}
    write_image(file, origin.tolist(), grid.dx, values)


@dataclass(frozen=True)
class GridFields:
    """Mass, velocity and density at the nodes of a regular grid.

    Attributes
    ----------
    origin : (d,)
        The first node, m; d is 2 (x, z) or 3.
    dx
        Distance of the nodes, m.
    mass : (nx, ny, nz) or (nx, nz)
        kg; in 2D per metre of width.
    velocity : (nx, ny, nz, 3) or (nx, nz, 3)
        Components x, y, z, m/s; y is zero in 2D, and all are zero where there is no mass.
    density
        Mass over the volume of a cell, kg/m3. It is too low beside walls and at surfaces, where
        snow fills only part of a node's cell.
    """

    origin: Floats
    dx: float
    mass: Floats
    velocity: Floats
    density: Floats


def particles_to_grid(
    positions: Floats,
    velocities: Floats,
    masses: Floats,
    *,
    dx: float,
    dimension: int,
    basis: Basis = "quadratic",
    affine: Optional[Floats] = None,
) -> GridFields:
    """Return mass, velocity and density of particles at the nodes of the grid.

    Parameters
    ----------
    positions, velocities : (n, 3)
        Positions, m, and velocities, m/s; in 2D the plane is (x, z).
    masses : (n,)
        Masses, kg.
    dx
        Size of the grid's cells, m.
    dimension
        2 or 3.
    basis
        Kind of the B-splines.
    affine : (n, 3, 3) or (n, 9), optional
        The matrices C of APIC, 1/s.

    Raises
    ------
    InputError
        If there are no particles, or the grid around them does not fit into memory.

    Examples
    --------
    >>> grid = particles_to_grid(np.array([[0.3, 0, 0.5]]), np.array([[1.0, 0, 0]]), np.ones(1),
    ...                          dx=0.1, dimension=2)
    >>> grid.mass.shape, float(grid.mass.sum().round(12)), grid.velocity[1, 1].round(12).tolist()
    ((3, 3), 1.0, [1.0, 0.0, 0.0])
    """
    if not len(positions):
        raise InputError("no particles: cannot build a grid")
    axes = [0, 2] if dimension == 2 else [0, 1, 2]
    points, speeds = positions[:, axes] / dx, velocities[:, axes]
    lowest = np.floor(points - OFFSET[basis]).astype(np.int64)
    first = lowest.min(axis=0)
    shape = tuple((lowest.max(axis=0) - first + SUPPORT[basis]).tolist())
    if np.prod(shape, dtype=float) > MAX_NODES:
        raise InputError(
            f"grid: {' x '.join(map(str, shape))} nodes around all particles do not fit into memory"
        )
    weights = _weights(points - OFFSET[basis] - lowest, basis)
    matrices = None if affine is None else affine.reshape(-1, 3, 3)[:, axes][:, :, axes]
    mass, momentum = np.zeros(shape), np.zeros((*shape, dimension))
    for steps in itertools.product(range(SUPPORT[basis]), repeat=dimension):
        share = masses * np.prod([weights[k][:, axis] for axis, k in enumerate(steps)], axis=0)
        nodes = lowest + np.array(steps)
        flat = np.ravel_multi_index(tuple((nodes - first).T), shape)
        mass += np.bincount(flat, share, mass.size).reshape(shape)
        given = speeds
        if matrices is not None:
            given = speeds + np.einsum("nij,nj->ni", matrices, (nodes - points) * dx)
        for axis in range(dimension):
            part = np.bincount(flat, share * given[:, axis], mass.size)
            momentum[..., axis] += part.reshape(shape)
    velocity = np.divide(
        momentum, mass[..., None], out=np.zeros_like(momentum), where=mass[..., None] > 0
    )
    if dimension == 2:
        velocity = np.insert(velocity, 1, 0.0, axis=-1)
    return GridFields(first * dx, dx, mass, velocity, mass / dx**dimension)


def _weights(fraction: Floats, basis: Basis) -> Sequence[Floats]:
    """Return the weights of the nodes along each axis (thesis 1.2.17-1.2.22)."""
    f, r = fraction, 1.0 - fraction
    if basis == "quadratic":
        return (0.5 * r**2, 0.75 - (f - 0.5) ** 2, 0.5 * f**2)
    return (
        r**3 / 6.0,
        2.0 / 3.0 - f**2 + 0.5 * f**3,
        2.0 / 3.0 - r**2 + 0.5 * r**3,
        f**3 / 6.0,
    )
