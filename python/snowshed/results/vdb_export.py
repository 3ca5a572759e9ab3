"""The particles of a results folder as OpenVDB files, one for each event or snapshot."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.paths import PathLike
from snowshed.io.vdb.writing import WrittenVdb, write_vdb
from snowshed.io.vtk.vtp import read_particles
from snowshed.methods.registry import resolution_of
from snowshed.results.reader import Results, particle_files

POINT_QUANTITIES = ("velocity", "event", "mass", "density", "volumetric_plastic_strain", "id")


@dataclass(frozen=True)
class Exported:
    """A file and its content."""

    file: Path
    content: WrittenVdb


@checked
def export_folder(
    folder: PathLike,
    output: Optional[PathLike] = None,
    *,
    snapshots: bool = False,
    width: Optional[float] = None,
    report: Optional[Callable[[Exported], None]] = None,
) -> list[Exported]:
    """Write the stored particles of a run as OpenVDB files.

    Parameters
    ----------
    folder
        Results folder.
    output
        Folder for the files; default: ``vdb`` in the results folder. Older files of the same name
        are replaced.
    snapshots
        Write the snapshots during the events instead of the stacks after them.
    width
        Width of the strip in 2D, m; see `write_vdb`.
    report
        Called after each file.

    Raises
    ------
    InputError
        If the folder holds no such particles, or snowshed was built without OpenVDB.
    """
    folder = Path(folder)
    scene = Results(folder).scene.data
    output = folder / "vdb" if output is None else Path(output)
    files = particle_files(folder, snapshots=snapshots)
    written = []
    for file in files:
        exported = Exported(output / f"{file.stem}.vdb", _write(file, output, scene, width))
        if report is not None:
            report(exported)
        written.append(exported)
    return written


def _write(
    file: Path, output: Path, scene: Mapping[str, Any], width: Optional[float]
) -> WrittenVdb:
    particles = read_particles(file)
    if "mass" not in particles:
        raise InputError(f"{file}: its particles have no mass; run the scene again")
    output.mkdir(parents=True, exist_ok=True)
    points: dict[str, NDArray[np.generic]] = {
        name: particles[name] for name in POINT_QUANTITIES if name in particles
    }
    return write_vdb(
        output / f"{file.stem}.vdb",
        particles["position"],
        particles["mass"],
        dimension=scene["dimension"],
        dx=resolution_of(scene),
        particles_per_voxel=scene.get("seeding", {}).get("particles_per_voxel", 1.0),
        width=width,
        attributes=points,
    )
