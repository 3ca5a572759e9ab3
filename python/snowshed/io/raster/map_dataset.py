"""Maps as an xarray Dataset with the coordinates and the map projection of the CF conventions.

CF: NetCDF Climate and Forecast Metadata Conventions, version 1.11.
"""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import numpy as np

from snowshed._core import InputError
from snowshed.base.arrays import Floats
from snowshed.base.extras import require
from snowshed.io.atomic import replacing
from snowshed.io.coordinates.plain_systems import first_part, plain_system
from snowshed.io.coordinates.systems import horizontal_system
from snowshed.io.raster.raster import Raster

if TYPE_CHECKING:
    import xarray

CONVENTIONS = "CF-1.11"
#: The variable that describes the map projection; rioxarray looks for this name.
PROJECTION = "spatial_ref"
NETCDF = (".nc", ".nc4")
#: Libraries that write NetCDF-4, which is compressed.
COMPRESSING = ("netcdf4", "h5netcdf")
#: Names of projections in proj strings, and in CF.
PROJECTIONS = {
    "tmerc": "transverse_mercator",
    "utm": "transverse_mercator",
    "lcc": "lambert_conformal_conic",
    "laea": "lambert_azimuthal_equal_area",
}


def map_dataset(maps: Mapping[str, Floats], place: Raster) -> xarray.Dataset:
    """Return maps with the same place as a Dataset with dimensions y and x.

    Parameters
    ----------
    maps : mapping of (rows, columns)
        Values by name, the southernmost row first.
    place
        A raster with the position and the coordinate system of the maps.

    Raises
    ------
    InputError
        If xarray (extra ``study``) is not installed.
    """
    library = require("xarray", "study", "a Dataset of maps")
    rows, columns = place.heights.shape
    dataset: xarray.Dataset = library.Dataset(
        {name: (("y", "x"), values) for name, values in maps.items()},
        coords={
            "y": ("y", place.north + place.cell * np.arange(rows), _axis("y")),
            "x": ("x", place.east + place.cell * np.arange(columns), _axis("x")),
        },
        attrs={"crs": place.crs},
    )
    projection = projection_attributes(place.crs)
    if projection:
        dataset = dataset.assign_coords({PROJECTION: ((), 0, projection)})
        for name in maps:
            dataset[name].encoding["grid_mapping"] = PROJECTION
    return dataset


def _axis(name: str) -> dict[str, str]:
    return {
        "units": "m",
        "standard_name": f"projection_{name}_coordinate",
        "long_name": f"{name} coordinate of the map, at the nodes",
        "axis": name.upper(),
    }


def projection_attributes(crs: str) -> dict[str, Any]:
    """Return the attributes of a map projection in CF; empty if the system is unknown.

    ``crs_wkt`` (and ``spatial_ref``, which GDAL reads) is the complete description. The parameters
    of the projection are given for transverse Mercator, Lambert's conformal cone and Lambert's
    azimuthal projection.
    """
    system = horizontal_system(crs)
    if system is None:
        wkt = first_part(plain_system(crs))
        is_wkt = wkt.upper().startswith(("PROJCS", "PROJCRS"))
        return {"crs_wkt": wkt, "spatial_ref": wkt} if is_wkt else {}
    wkt = str(system.to_wkt())
    return {"crs_wkt": wkt, "spatial_ref": wkt, **_parameters(system.to_dict())}


def _parameters(proj: Mapping[str, Any]) -> dict[str, Any]:
    """Return the name and the parameters of a projection, from those of a proj string."""
    name = PROJECTIONS.get(str(proj.get("proj")))
    if name is None or ("k_0" in proj and proj["proj"] == "lcc"):
        return {}
    if proj["proj"] == "utm":
        south = bool(proj.get("south"))
        proj = {
            "lat_0": 0.0, "lon_0": 6.0 * int(proj["zone"]) - 183.0, "k_0": 0.9996,
            "x_0": 500_000.0, "y_0": 10_000_000.0 if south else 0.0,
        }  # fmt: skip
    origin = "projection_origin" if name == PROJECTIONS["laea"] else "central_meridian"
    values: dict[str, Any] = {
        "grid_mapping_name": name,
        "latitude_of_projection_origin": float(proj.get("lat_0", 0.0)),
        f"longitude_of_{origin}": float(proj.get("lon_0", 0.0)),
        "false_easting": float(proj.get("x_0", 0.0)),
        "false_northing": float(proj.get("y_0", 0.0)),
    }
    if name == PROJECTIONS["tmerc"]:
        values["scale_factor_at_central_meridian"] = float(proj.get("k_0", proj.get("k", 1.0)))
    if name == PROJECTIONS["lcc"]:
        values["standard_parallel"] = [
            float(proj[key]) for key in ("lat_1", "lat_2") if key in proj
        ]
    return values


def write_netcdf(path: Path, dataset: xarray.Dataset) -> None:
    """Write a Dataset as NetCDF, whole or not at all.

    NetCDF-4 with compression is written if netCDF4 or h5netcdf is installed; else NetCDF-3.

    Raises
    ------
    InputError
        If the name does not end in .nc or .nc4.
    OSError
        If it cannot be written.
    """
    if path.suffix.lower() not in NETCDF:
        raise InputError(f"{path}: not the name of a NetCDF file; allowed: {', '.join(NETCDF)}")
    xarray: Any = require("xarray", "study", "writing NetCDF")
    engines = xarray.backends.list_engines()
    engine = next((name for name in COMPRESSING if name in engines), "scipy")
    written = dataset.copy()
    written.attrs = {"Conventions": CONVENTIONS, **dataset.attrs}
    for name in ("x", "y"):
        written[name].encoding["_FillValue"] = None
    if engine in COMPRESSING:
        for variable in written.data_vars.values():
            variable.encoding.update(zlib=True, complevel=4, shuffle=True)
    write: Any = written.to_netcdf
    # HDF5 locks its files itself, so that it cannot write into one that is held already.
    with TemporaryDirectory() as folder:
        complete = Path(folder) / "maps.nc"
        write(complete, engine=engine)
        with replacing(path) as beside:
            shutil.copyfile(complete, beside)
