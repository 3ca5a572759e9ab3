"""Particles as an OpenVDB file."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Optional, Union

import numpy as np
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.arrays import Floats
from snowshed.io.atomic import replacing
from snowshed.io.vdb.program import run_writer

STRIP_LAYERS = 9  # layers of grid cells that represent the plane of a 2D scene


@dataclass(frozen=True)
class WrittenVdb:
    """The contents of a written OpenVDB file.

    Attributes
    ----------
    volume
        Volume of the solid, from its OpenVDB level set, m3 (per metre of width in 2D).
    mass
        Sum over the density volume, kg (per metre of width in 2D).
    surface_voxels, density_voxels
        Active voxels of the level set and of the density volume.
    """

    volume: float
    mass: float
    surface_voxels: int
    density_voxels: int

    @property
    def density(self) -> float:
        """Mass over the volume of the solid, its pores included, kg/m3."""
        return self.mass / self.volume


@checked
def write_vdb(
    path: Union[str, os.PathLike[str]],
    positions: Floats,
    masses: Floats,
    *,
    dimension: int,
    dx: float,
    particles_per_voxel: float,
    width: Optional[float] = None,
    attributes: Optional[Mapping[str, NDArray[np.generic]]] = None,
) -> WrittenVdb:
    """Write particles as the level set ``surface``, the fog volume ``density`` and points.

    Parameters
    ----------
    path
        File to write; it appears whole or not at all.
    positions : (n, 3)
        Positions, m, z upward; y is ignored in 2D.
    masses : (n,)
        Masses, kg (per metre of width in 2D).
    dimension
        2 or 3.
    dx
        Size of the simulation's grid cells, m: voxels of the density volume. Those of the level
        set are half as large.
    particles_per_voxel
        Seeding of the snow; decides the radius of a particle.
    width
        In 2D, the width of the strip about y = 0 that solid and density fill, m; rounded to an
        odd number of cells. Default: nine cells.
    attributes
        Further quantities of the points, (n,) or (n, 3): floats or integers.

    Raises
    ------
    InputError
        If snowshed was built without OpenVDB, the lengths of arrays differ, or the particles make
        no solid.
    OSError
        If the file cannot be written.
    """
    count = len(positions)
    given = attributes or {}
    for name, array in {"positions": positions, "masses": masses, **given}.items():
        if len(array) != count:
            raise InputError(f"{name}: {len(array)} values for {count} particles")
    plain = {name: _plain(array) for name, array in given.items()}
    strip = _odd_cells(width, dx) * dx
    head = {
        "particles": count,
        "dimension": dimension,
        "voxel": dx,
        "particles_per_voxel": particles_per_voxel,
        "width": strip,
        "attributes": [
            [name, str(array.dtype), array.shape[1] if array.ndim > 1 else 1]
            for name, array in plain.items()
        ],
    }
    arrays = (np.asarray(positions, float), np.asarray(masses, float), *plain.values())
    request = b"".join(
        [json.dumps(head).encode(), b"\n", *(np.ascontiguousarray(a).tobytes() for a in arrays)]
    )
    try:
        with replacing(path) as beside:
            answer = json.loads(run_writer(beside, request))
    except InputError as error:
        raise InputError(f"{Path(path)}: {error}") from None
    across = strip if dimension == 2 else 1.0
    return WrittenVdb(
        answer["volume_m3"] / across,
        answer["mass_kg"] / across,
        answer["surface_voxels"],
        answer["density_voxels"],
    )


def _plain(array: NDArray[np.generic]) -> NDArray[np.generic]:
    """Return the array in a type that OpenVDB's points can hold."""
    is_integer = np.issubdtype(array.dtype, np.integer)
    return array.astype(np.int32 if is_integer else np.float32)


def _odd_cells(width: Optional[float], dx: float) -> int:
    """Return the number of cells across a strip: odd, with one cell in the middle."""
    if width is None:
        return STRIP_LAYERS
    if not 0 < width < np.inf:
        raise InputError(f"width: {width} m; must be positive")
    return 2 * round((width / dx - 1) / 2) + 1 if width > dx else 1
