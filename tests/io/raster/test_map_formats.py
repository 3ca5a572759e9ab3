"""Compressed GeoTIFF and NetCDF of maps, read back by GDAL and by snowshed."""

import sys

import numpy as np
import pytest

from snowshed import InputError
from snowshed.io.raster.map_dataset import map_dataset, projection_attributes, write_netcdf
from snowshed.io.raster.output import write_raster
from snowshed.io.raster.raster import Raster, read_raster

rasterio = pytest.importorskip("rasterio")
xarray = pytest.importorskip("xarray")

UTM = "EPSG:25832"


def flow(rows=300, columns=400, crs=UTM):
    """Return a map with snow in its middle, a hole, and zeros elsewhere."""
    y, x = np.mgrid[:rows, :columns]
    values = np.exp(-((x - columns / 2) ** 2 + (y - rows / 2) ** 2) / 800.0) / 3.0
    values[values < 1e-3] = 0.0
    values[5, 7] = np.nan
    return Raster(values, 600_001.25, 5_200_003.75, 2.5, crs=crs)


@pytest.mark.parametrize("shape", [(300, 400), (40, 30), (1, 1), (257, 256)])
def test_a_geotiff_holds_the_same_bits_in_their_place(tmp_path, shape):
    raster = flow(*shape) if min(shape) > 8 else Raster(np.full(shape, 1 / 3), 0.5, 0.5, 1.0)
    write_raster(tmp_path / "a.tif", raster)
    again = read_raster(tmp_path / "a.tif")
    assert again.heights.tobytes() == raster.heights.tobytes()
    assert (again.east, again.north, again.cell) == (raster.east, raster.north, raster.cell)
    assert again.crs == raster.crs


def test_gdal_reads_the_geotiff(tmp_path):
    raster = flow()
    write_raster(tmp_path / "a.tif", raster)
    with rasterio.open(tmp_path / "a.tif") as file:
        assert file.profile["compress"] == "deflate"
        assert file.tags(ns="IMAGE_STRUCTURE")["PREDICTOR"] == "3"
        assert file.block_shapes == [(256, 256)] and file.is_tiled
        assert np.isnan(file.nodata) and file.crs.to_epsg() == 25832
        assert file.bounds.left == raster.east - 1.25
        assert file.bounds.bottom == raster.north - 1.25
        assert file.read(1, masked=True).mask[::-1].nonzero() == ([5], [7])
        np.testing.assert_array_equal(file.read(1)[::-1], raster.heights)
        x, y = raster.east + 200 * 2.5, raster.north + 150 * 2.5
        assert next(file.sample([(x, y)]))[0] == raster.heights[150, 200]


def test_a_geotiff_is_smaller_than_text_and_than_plain_numbers(tmp_path):
    write_raster(tmp_path / "a.tif", flow())
    write_raster(tmp_path / "a.asc", flow())
    size = (tmp_path / "a.tif").stat().st_size
    assert size < 0.5 * (tmp_path / "a.asc").stat().st_size
    assert size < 0.2 * flow().heights.nbytes


@pytest.mark.parametrize("engine", ["netcdf4", "h5netcdf", "scipy"])
def test_netcdf_gives_the_dataset_back(tmp_path, engine, monkeypatch):
    engines = xarray.backends.list_engines()
    if engine not in engines:
        pytest.skip(f"{engine} is not installed")
    monkeypatch.setattr(xarray.backends, "list_engines", lambda: {engine: engines[engine]})
    raster = flow(60, 80)
    dataset = map_dataset({"speed": raster.heights, "depth": 2.0 * raster.heights}, raster)
    write_netcdf(tmp_path / "a.nc", dataset)
    monkeypatch.undo()
    with xarray.open_dataset(tmp_path / "a.nc", decode_coords="all") as again:
        xarray.testing.assert_equal(again.load(), dataset)
        assert again.attrs["Conventions"] == "CF-1.11"
        assert again.x.attrs["standard_name"] == "projection_x_coordinate"
        assert again.y.attrs["standard_name"] == "projection_y_coordinate"
        assert (again.x.attrs["units"], again.y.attrs["axis"]) == ("m", "Y")
        assert "_FillValue" not in again.x.encoding or engine == "scipy"
        mapping = again[again.speed.encoding["grid_mapping"]].attrs
    assert rasterio.crs.CRS.from_wkt(mapping["crs_wkt"]).to_epsg() == 25832


def test_gdal_reads_the_netcdf(tmp_path):
    if "netCDF" not in rasterio.drivers.raster_driver_extensions().values():
        pytest.skip("this GDAL reads no NetCDF")
    raster = flow(60, 80)
    write_netcdf(tmp_path / "a.nc", map_dataset({"speed": raster.heights}, raster))
    with rasterio.open(f"netcdf:{tmp_path / 'a.nc'}:speed") as file:
        assert file.crs.to_epsg() == 25832
        assert file.bounds.left == raster.east - 1.25 and file.bounds.bottom == raster.north - 1.25
        np.testing.assert_array_equal(file.read(1)[::-1], raster.heights)


@pytest.mark.parametrize(
    ("crs", "name", "values"),
    [
        (
            "EPSG:25832",
            "transverse_mercator",
            {"longitude_of_central_meridian": 9.0, "scale_factor_at_central_meridian": 0.9996,
             "false_easting": 500_000.0, "false_northing": 0.0},
        ),
        (
            "EPSG:32733",
            "transverse_mercator",
            {"longitude_of_central_meridian": 15.0, "false_northing": 10_000_000.0},
        ),
        (
            "EPSG:31287",
            "lambert_conformal_conic",
            {"standard_parallel": [49.0, 46.0], "false_easting": 400_000.0},
        ),
        (
            "EPSG:3035",
            "lambert_azimuthal_equal_area",
            {"longitude_of_projection_origin": 10.0, "latitude_of_projection_origin": 52.0},
        ),
        ("EPSG:2056", None, {}),  # the Swiss oblique Mercator: its description is in crs_wkt
    ],
)  # fmt: skip
def test_the_projection_has_its_name_and_parameters(crs, name, values):
    attributes = projection_attributes(crs)
    assert attributes.get("grid_mapping_name") == name
    assert {key: attributes[key] for key in values} == values
    assert rasterio.crs.CRS.from_wkt(attributes["crs_wkt"]) == rasterio.crs.CRS.from_string(crs)


def test_an_unknown_system_has_no_projection(tmp_path):
    raster = flow(20, 20, crs="")
    dataset = map_dataset({"speed": raster.heights}, raster)
    assert "spatial_ref" not in dataset.coords and projection_attributes("") == {}
    write_netcdf(tmp_path / "a.nc", dataset)
    with xarray.open_dataset(tmp_path / "a.nc") as again:
        assert "grid_mapping" not in {**again.speed.attrs, **again.speed.encoding}


def test_another_ending_is_refused(tmp_path):
    raster = flow(20, 20)
    dataset = map_dataset({"speed": raster.heights}, raster)
    with pytest.raises(InputError, match=r"a\.hdf: not the name of a NetCDF file; allowed: \.nc"):
        write_netcdf(tmp_path / "a.hdf", dataset)
    assert list(tmp_path.iterdir()) == []


def test_without_rasterio_a_geotiff_is_refused(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "rasterio", None)
    with pytest.raises(InputError, match=r'pip install "snowshed\[terrain\]"'):
        write_raster(tmp_path / "a.tif", flow(20, 20))
    assert list(tmp_path.iterdir()) == []
