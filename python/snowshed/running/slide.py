"""A snow slide from files of terrain and release areas, in one call."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Optional

from snowshed.base.progress import Reporter
from snowshed.results.reader import Results
from snowshed.running.run import run
from snowshed.scene.builders.slides import slide_scene
from snowshed.scene.builders.terrain_copy import removing_copies, terrain_copy
from snowshed.scene.scene import PathLike


def slide(
    terrain: PathLike,
    release: Optional[PathLike],
    folder: PathLike,
    *,
    thickness: Optional[float] = None,
    max_time: Optional[float] = None,
    progress: Optional[Reporter] = None,
    pictures: bool = True,
    **options: Any,
) -> Results:
    """Simulate a snow slide on terrain, and write a results folder.

    Parameters
    ----------
    terrain
        Elevations: an ESRI ASCII grid or a GeoTIFF, on a projected map.
    release
        Polygons of the release areas: GeoPackage, shapefile or GeoJSON. None: the cells where the
        option `thickness_raster` has snow.
    folder
        The results folder; new or empty. A copy of a GeoTIFF is written beside it.
    thickness
        Thickness of the released snow, normal to the ground [m], instead of the file's.
    max_time
        Longest simulated time [s]. [default: 400]
    progress
        Called with a `Progress` about twice a second.
    pictures
        Whether to draw ``slide.png`` and write ``slide.html``.
    **options
        Further parameters of `snowshed.scene.builders.slide_scene`, such as `settings`.

    Returns
    -------
    Results
        The results folder; `Results.summary` and `Results.maps` hold the figures and the maps.

    Raises
    ------
    InputError, OSError
        As from `slide_scene`, or if the folder is not empty.
    SimulationError
        If the simulation cannot go on.
    Interrupted
        After Ctrl-C; ``snowshed.run(folder / "scene.json", folder, resume=True)`` resumes.

    Examples
    --------
    >>> import numpy as np
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed.io.raster.raster import Raster, write_ascii_grid
    >>> ground = np.repeat([np.linspace(60.0, 0.0, 41)], 21, axis=0)
    >>> area = '{"type": "Polygon", "coordinates": [[[20,30],[60,30],[60,70],[20,70],[20,30]]]}'
    >>> with TemporaryDirectory() as folder:
    ...     map_file, polygon = Path(folder) / "hill.asc", Path(folder) / "release.geojson"
    ...     write_ascii_grid(map_file, Raster(ground, 0.0, 0.0, 5.0))
    ...     _ = polygon.write_text(area)
    ...     results = slide(map_file, polygon, f"{folder}/out", thickness=0.5, max_time=0.5)
    ...     results.summary.ended
    'time_limit'
    """
    target = Path(folder)
    with removing_copies(target):
        scene = slide_scene(
            terrain, release, thickness=thickness, ascii_copy=terrain_copy(target), **options
        )
        if max_time is not None:
            scene.set("events.max_time", max_time)
        return run(scene, target, progress=progress, pictures=pictures)
