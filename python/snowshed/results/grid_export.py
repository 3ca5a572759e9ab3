"""The grids of a results folder as files for ParaView, one for each event or snapshot."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

from snowshed.base.paths import PathLike
from snowshed.results.grid import stored_grid, write_grid
from snowshed.results.reader import Results, particle_files


def export_grids(
    folder: PathLike, output: Optional[PathLike] = None, *, snapshots: bool = False
) -> list[Path]:
    """Write the grid of each event of a results folder as a .vti file, and return the files.

    Parameters
    ----------
    folder
        Results folder of a run by the material point method.
    output
        Folder for the files; default: ``grid`` in the results folder. Older files of the same name
        are replaced.
    snapshots
        Write the grids of snapshots during the events instead of those at the ends of events.

    Raises
    ------
    InputError
        If the folder holds no such particles, or the scene's method has no grid.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed import Scene, run_events
    >>> tiny = Scene.preset("lab-50").update({"dimension": 2, "numerics.dx": 0.02})
    >>> tiny = tiny.update({"events": {"count": 1, "max_time": 0.1}})
    >>> with TemporaryDirectory() as folder:
    ...     _ = run_events(tiny, folder, pictures=False)
    ...     [file.name for file in export_grids(folder)]
    ['event_001.vti']
    """
    folder = Path(folder)
    output = folder / "grid" if output is None else Path(output)
    scene = Results(folder).scene.data
    written = []
    for file in particle_files(folder, snapshots=snapshots):
        grid = stored_grid(scene, file)
        output.mkdir(parents=True, exist_ok=True)
        written.append(output / f"{file.stem}.vti")
        write_grid(grid, written[-1])
    return written
