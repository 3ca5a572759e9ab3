"""The grid of the material point method at a moment, as an xarray Dataset and for ParaView."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from snowshed._core import InputError
from snowshed.base.arrays import Floats
from snowshed.base.extras import require
from snowshed.io.vtk.vti import write_image
from snowshed.io.vtk.vtp import read_particles
from snowshed.methods.registry import method_of
from snowshed.results.particle_grid import GridFields, particles_to_grid
from snowshed.scene.scene import PathLike

if TYPE_CHECKING:
    import xarray

MEANINGS = {
    "mass": ("kg", "Mass at a node; in 2D per metre of width"),
    "velocity": ("m/s", "Velocity at a node; zero where there is no mass"),
    "density": ("kg/m3", "Mass at a node over the volume of a cell"),
}


def scene_grid(
    scene: Mapping[str, Any],
    positions: Floats,
    velocities: Floats,
    masses: Floats,
    affine: Optional[Floats] = None,
) -> GridFields:
    """Return what the particles of a run give to the nodes of its grid.

    Parameters
    ----------
    scene
        Complete scene data.
    positions, velocities, masses, affine
        See `snowshed.results.particle_grid.particles_to_grid`.

    Raises
    ------
    InputError
        If the scene's method has no grid, there are no particles, or memory does not suffice.
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
        The event they belong to, and the time in it, s.

    Returns
    -------
    xarray.Dataset
        Dimensions x, (y,) z, the nodes, m, and component.

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
        coords={**nodes, "component": axes, "event_number": event, "time": clock},
    )
    for name, (unit, meaning) in MEANINGS.items():
        dataset[name].attrs.update(units=unit, long_name=meaning)
    return dataset


def stored_grid(scene: Mapping[str, Any], file: Path) -> GridFields:
    """Return the grid of the particles that a run stored in a file.

    The file holds positions and velocities in single precision, and not the affine velocities of
    APIC, of whose momentum a node's share is then missing.
    """
    found = {name: values.astype(float) for name, values in read_particles(file).items()}
    return scene_grid(scene, found["position"], found["velocity"], found["mass"])


def write_grid(grid: GridFields, file: PathLike) -> None:
    """Write fields of a grid as a .vti file, which ParaView opens; in 2D y is zero."""
    values = {"mass": grid.mass, "velocity": grid.velocity, "density": grid.density}
    origin = grid.origin
    if grid.mass.ndim == 2:
        origin = np.insert(origin, 1, 0.0)
        values = {name: array[:, None] for name, array in values.items()}
        values["velocity"] = np.insert(values["velocity"], 1, 0.0, axis=-1)
    write_image(file, origin.tolist(), grid.dx, values)
