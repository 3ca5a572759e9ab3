"""A snow slide from files of terrain and release areas, in one call."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Optional, Union

from snowshed.base.arguments import checked
from snowshed.base.paths import PathLike
from snowshed.base.progress import Reporter
from snowshed.io.raster.output import MapFormat
from snowshed.io.raster.raster import Raster
from snowshed.methods.slide.settings import SlideSettings
from snowshed.results.reader import Results
from snowshed.running.run import run
from snowshed.scene.builders.slides import slide_scene
from snowshed.scene.builders.terrain_copy import copies_removed_on_failure, terrain_copy

if TYPE_CHECKING:
    import xarray


@checked
def slide(
    terrain: Union[PathLike, Raster, xarray.DataArray],
    release: object,
    folder: Optional[PathLike] = None,
    *,
    thickness: Optional[float] = None,
    max_time: Optional[float] = None,
    progress: Optional[Reporter] = None,
    pictures: bool = True,
    settings: Optional[SlideSettings] = None,
    map_format: MapFormat = "ascii",
) -> Results:
    """Simulate a snow slide on terrain, and write a results folder.

    Parameters
    ----------
    terrain
        Elevations: an ESRI ASCII grid or a GeoTIFF, on a projected map; or a `Raster`, or a
        DataArray of xarray with the coordinates x and y.
    release
        Polygons of the release areas: GeoPackage, shapefile or GeoJSON; shapely polygons, or a
        GeoDataFrame.
    folder
        The results folder; new or empty. A copy of a GeoTIFF is written beside it. None: a
        temporary folder, which is removed with the results.
    thickness
        Thickness of the released snow, normal to the ground [m], instead of the file's.
    max_time
        Longest simulated time [s]. [default: 400]
    progress
        Called with a `Progress` about twice a second.
    pictures
        Whether to draw ``slide.png`` and write ``slide.html``.
    settings
        Settings of the method. [default: `SlideSettings()`]
    map_format
        Format of the maps, "ascii" or "geotiff", as for `snowshed.run`.

    Returns
    -------
    Results
        The results folder; `Results.summary` and `Results.maps` hold the figures and the maps.

    Raises
    ------
    InputError, OSError
        As from `slide_scene`, or if the folder is not empty.
    SimulationError
        If the simulation cannot continue.
    Interrupted
        After Ctrl-C; ``snowshed.run(folder / "scene.json", folder, resume=True)`` resumes.

    Notes
    -----
    Other inputs, such as entrainment, are parameters of `snowshed.scene.slide_scene`, whose scene
    `snowshed.run` simulates.

    Examples
    --------
    >>> import json
    >>> from tempfile import TemporaryDirectory
    >>> import numpy as np
    >>> from snowshed.io.raster.raster import Raster, write_ascii_grid
    >>> hill = Raster(np.repeat([np.linspace(60.0, 0.0, 41)], 21, axis=0), 0.0, 0.0, 5.0)
    >>> ring = [[20, 30], [60, 30], [60, 70], [20, 70], [20, 30]]
    >>> area = {"type": "Feature", "properties": {},
    ...         "geometry": {"type": "Polygon", "coordinates": [ring]}}
    >>> areas = {"type": "FeatureCollection", "features": [area],
    ...          "crs": {"type": "name", "properties": {"name": "EPSG:31287"}}}
    >>> with TemporaryDirectory() as folder:
    ...     terrain, release = Path(folder) / "hill.asc", Path(folder) / "release.geojson"
    ...     write_ascii_grid(terrain, hill)
    ...     _ = release.write_text(json.dumps(areas))
    ...     results = slide(terrain, release, f"{folder}/out", thickness=0.5, max_time=0.5)
    ...     results.summary.ended
    'time_limit'
    """
    if folder is None:
        scene = slide_scene(terrain, release, thickness=thickness, settings=settings)
        if max_time is not None:
            scene.set("events.max_time", max_time)
        return run(scene, progress=progress, pictures=pictures, map_format=map_format)
    target = Path(folder)
    with copies_removed_on_failure(target):
        scene = slide_scene(
            terrain,
            release,
            thickness=thickness,
            settings=settings,
            ascii_copy=terrain_copy(target),
        )
        if max_time is not None:
            scene.set("events.max_time", max_time)
        return run(scene, target, progress=progress, pictures=pictures, map_format=map_format)
