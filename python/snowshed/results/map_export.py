"""The maps of a run as a NetCDF file with coordinates, units and the map projection."""

from __future__ import annotations

from pathlib import Path

from snowshed._core import version
from snowshed.base.arguments import checked
from snowshed.base.paths import PathLike
from snowshed.io.raster.map_dataset import write_netcdf
from snowshed.results.reader import Results


@checked
def write_maps(results: PathLike, path: PathLike) -> Path:
    """Write the maps of a slide as NetCDF with the attributes of the CF conventions.

    `xarray.open_dataset(path, decode_coords="all")` reads it back; GIS programs read it, too.

    Parameters
    ----------
    results
        The results folder.
    path
        The file, .nc or .nc4. It is compressed (NetCDF-4) if netCDF4 or h5netcdf is installed.

    Returns
    -------
    pathlib.Path
        The file.

    Raises
    ------
    InputError
        If the folder holds no results, the run has no maps, the file has another ending, or xarray
        is not installed.
    OSError
        If the file cannot be written.
    """
    file, run = Path(path), Results(results)
    maps = run.maps.copy()
    title = str(run.scene.data.get("title") or "Snow slide")
    maps.attrs.update(title=title, source=f"snowshed {version}")
    write_netcdf(file, maps)
    return file
