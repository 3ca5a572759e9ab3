"""Rasters and terrain, against planes and a cylinder whose distances are known."""

import math
import sys

import numpy as np
import pytest
import rasterio

from snowshed import InputError, Scene, _core
from snowshed.io import Raster, read_raster
from snowshed.scene import on_terrain, single_panel
from snowshed.scene.builders.terrain import signed_distances

ASCII = """ncols 3
nrows 2
xllcorner 1000
yllcorner 2000
cellsize 10
NODATA_value -9999
1 2 3
4 5 -9999
"""


def test_rows_of_an_ascii_grid_begin_in_the_south(tmp_path):
    (tmp_path / "a.asc").write_text(ASCII)
    raster = read_raster(tmp_path / "a.asc")
    assert (raster.east, raster.north, raster.cell) == (1005.0, 2005.0, 10.0)
    np.testing.assert_array_equal(raster.heights, [[4, 5, np.nan], [1, 2, 3]])
    heights = raster.height_at(np.array([1005.0, 1010.0]), np.array([2015.0, 2010.0]))
    np.testing.assert_allclose(heights, [1.0, 3.0])
    with pytest.raises(InputError, match=r"a\.asc: no height at 1020 east, 2010 north"):
        raster.height_at(np.array([1020.0]), np.array([2010.0]))
    with pytest.raises(InputError, match="999 east, 2010 north is outside the raster"):
        raster.height_at(np.array([999.0]), np.array([2010.0]))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("nrows 2\n", "", "the header has no nrows"),
        ("ncols 3", "ncols three", "'three' is not a valid number"),
        ("cellsize 10", "cellsize 0", "cellsize must be above 0"),
        ("4 5", "4 five", "'five' is not a valid number"),
        ("4 5 ", "4 ", "5 values; the header announces 6"),
        ("ncols 3", "ncols 2.5", "ncols must be a whole number"),
        ("ncols 3", "ncols nan", "'nan' is not a valid number"),
        ("nrows 2", "nrows 1e999", "'1e999' is not a valid number"),
        ("xllcorner 1000", "xllcorner nan", "'nan' is not a valid number"),
        ("4 5", "4 inf", "'inf' is not a valid number"),
    ],
)
def test_bad_ascii_grids_are_refused(tmp_path, old, new, message):
    (tmp_path / "a.asc").write_text(ASCII.replace(old, new))
    with pytest.raises(InputError, match=rf"a\.asc.*{message}"):
        read_raster(tmp_path / "a.asc")


def write_geotiff(path, crs, heights=((1, 2, 3), (4, 5, -9999)), dtype="float32", **options):
    form = {"driver": "GTiff", "width": 3, "height": 2, "count": 1, "dtype": dtype, "crs": crs}
    form.update(nodata=-9999, transform=rasterio.Affine(10, 0, 1000, 0, -10, 2020))
    with rasterio.open(path, "w", **{**form, **options}) as out:
        if heights is not None:
            out.write(np.array(heights, dtype=dtype), 1)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (
            {"heights": None, "width": 100_000, "height": 100_000, "tiled": True,
             "sparse_ok": True},
            "100000 columns and 100000 rows; at most 25000000 cells",
        ),
        ({"heights": ((1, 2, math.inf), (4, 5, 6))}, "a height that is not finite, 2 cells from"),
        ({"dtype": "complex64", "nodata": None}, "holds complex64 values"),
        ({"driver": "PNG", "dtype": "uint8", "nodata": None, "heights": ((1, 2, 3), (4, 5, 6))},
         "not a GeoTIFF"),
    ],
)  # fmt: skip
def test_geotiffs_without_terrain_are_refused(tmp_path, options, message):
    write_geotiff(tmp_path / "a.tif", "EPSG:2056", **options)
    with pytest.raises(InputError, match=rf"a\.tif: {message}"):
        read_raster(tmp_path / "a.tif")


def test_a_geotiff_and_an_ascii_grid_give_the_same_raster(tmp_path):
    write_geotiff(tmp_path / "a.tif", "EPSG:2056")
    (tmp_path / "a.asc").write_text(ASCII)
    geotiff, ascii_grid = read_raster(tmp_path / "a.tif"), read_raster(tmp_path / "a.asc")
    np.testing.assert_array_equal(geotiff.heights, ascii_grid.heights)
    assert (geotiff.east, geotiff.north, geotiff.cell) == (
        ascii_grid.east,
        ascii_grid.north,
        ascii_grid.cell,
    )
    write_geotiff(tmp_path / "degrees.tif", "EPSG:4326")
    with pytest.raises(InputError, match=r"its map is in degrees .*; project it to metres first"):
        read_raster(tmp_path / "degrees.tif")
    (tmp_path / "text.tif").write_text("heights")
    with pytest.raises(InputError, match=r"text\.tif: not a GeoTIFF"):
        read_raster(tmp_path / "text.tif")


def test_without_its_library_a_geotiff_says_what_to_install(tmp_path, monkeypatch):
    (tmp_path / "a.tif").write_text("")
    (tmp_path / "a.asc").write_text(ASCII)
    monkeypatch.setitem(sys.modules, "rasterio", None)
    with pytest.raises(InputError, match=r'pip install "snowshed\[terrain\]"'):
        read_raster(tmp_path / "a.tif")
    assert read_raster(tmp_path / "a.asc").cell == 10.0
    with pytest.raises(OSError, match="No such file"):
        read_raster(tmp_path / "none.tif")


def test_distances_from_a_slope_agree_with_its_plane():
    xs = np.linspace(0.0, 2.0, 21)
    slope = math.radians(25.0)
    distances, bottom = signed_distances(-math.tan(slope) * xs[:, None], xs, np.zeros(1), 0.1)
    x, z = np.meshgrid(xs, bottom + 0.1 * np.arange(distances.shape[2]), indexing="ij")
    exact = z * math.cos(slope) + x * math.sin(slope)
    middle = (np.abs(x - 1.0) < 0.5) & (np.abs(exact) < 0.3)  # beyond, the terrain continues level
    np.testing.assert_allclose(distances[:, 0][middle], exact[middle], atol=1e-5)


def test_distances_in_3d_above_a_ridge():
    axis = np.linspace(-1.0, 1.0, 41)
    heights = np.sqrt(np.maximum(0.25 - axis[:, None] ** 2, 0.0)) * np.ones(5)
    ys = 0.05 * np.arange(5)
    distances, bottom = signed_distances(heights, axis, ys, 0.05)
    level = round((0.55 - bottom) / 0.05)
    z = bottom + 0.05 * level
    assert distances[20, 2, level] == pytest.approx(z - 0.5, abs=1e-4)
    corner = distances[20 + 8, 2, level]  # x = 0.4: nearest on a circle of radius 0.5
    assert corner == pytest.approx(math.hypot(0.4, z) - 0.5, abs=0.01)


def test_terrain_with_a_single_slope_equals_tilted_ground(tmp_path):
    """The grid made from a plane raster has the same distances as the plane."""
    psi = math.radians(20.0)
    east = np.arange(0.0, 21.0)
    raster = Raster(-math.tan(psi) * east[None, :] + np.zeros((5, 1)), 0.0, 0.0, 1.0)
    panel = single_panel(height=0.5, length=1.0, tilt=45.0, snow=0.1, dx=0.1)
    scene = on_terrain(
        panel, raster, tmp_path / "hill.npy", origin=(10.0, 2.0), azimuth=90.0, x=(-2, 4),
        spacing=0.2,
    )  # fmt: skip
    resolved = scene.resolve()
    simulation = _core.Simulation(resolved.json, resolved.base_dir)
    edge = 0.5 * math.cos(math.radians(45.0))
    for x, above in ((edge, 0.5), (1.5, 0.0), (1.0, 0.1)):
        z = above - (x - edge) * math.tan(psi)
        distance = simulation.obstacle_distance(np.array([[x, 0.0, z]]))[0]
        assert distance == pytest.approx(above * math.cos(psi), abs=0.01)
    assert panel.ground is not None and panel.obstacles is None  # the given scene is unchanged


def test_impossible_terrain_is_refused(tmp_path):
    raster = Raster(np.zeros((5, 5)), 0.0, 0.0, 1.0, "hill")
    location = {"origin": (2.0, 2.0), "azimuth": 0.0}
    with pytest.raises(InputError, match=r"hill: .* is outside the raster"):
        on_terrain(Scene(dimension=2), raster, tmp_path / "a.npy", x=(-5, 5), **location)
    with pytest.raises(InputError, match="x: 1 to 1 m is not allowed"):
        on_terrain(Scene(dimension=2), raster, tmp_path / "a.npy", x=(1, 1), **location)
    spike = np.zeros((5, 5))
    spike[2, 2] = 1e3
    with pytest.raises(InputError, match=r"spacing: 0\.01 m makes a grid of 201 x 201"):
        on_terrain(
            Scene(dimension=3),
            Raster(spike, 0.0, 0.0, 1.0),
            tmp_path / "a.npy",
            x=(-1, 1),
            y=(-1, 1),
            spacing=0.01,
            max_slope=90.0,
            **location,
        )
    assert not (tmp_path / "a.npy").exists()
