"""The only reader of terrain refuses impossible elevations for every caller."""

import dataclasses

import numpy as np
import pytest
from helpers.raster_files import CELL, SLOPE, grid_text, in_unit, scaled, write_geotiff

from snowshed import InputError
from snowshed.base.notes import record_notes
from snowshed.io.raster.raster import Raster
from snowshed.scene import on_terrain, single_panel, slide_scene
from snowshed.scene.builders.terrain_checks import check_terrain, read_terrain

pytest.importorskip("rasterio")


def sloping(change=None, fall=0.3, low=900.0, cell=CELL):
    heights = low - fall * cell * np.arange(20.0)[None, :] * np.ones((20, 1))
    if change is not None:
        heights[10, 10] = change
    return Raster(heights, 0.0, 0.0, cell, "dem")


@pytest.mark.parametrize(
    ("terrain", "message"),
    [
        (sloping(0.0), r"of 885 m beside 0 m within 5 m, at \(50, 45\) and \(50, 50\); are some"),
        (sloping(0.0, low=60.0), "elevations of 45 m beside 0 m"),
        (sloping(-100.0, low=100.0), "are some missing"),
        (sloping(1200.0), "beside 1200 m within 5 m"),
        (sloping(-9999.0), r"-9999 to 900 m do not occur on Earth .* such as that at \(50, 50\)"),
        (sloping(9999.0), "a missing value that the file does not declare as NODATA"),
    ],
    ids=["zero", "low zero", "below", "spike", "-9999", "9999"],
)
def test_missing_elevations_are_refused(terrain, message):
    with pytest.raises(InputError, match=message):
        check_terrain(terrain)


@pytest.mark.parametrize(
    "terrain",
    [
        sloping(), sloping(860.0), sloping(0.0, low=14.0), sloping(841.0, cell=20.0, low=1000.0),
        sloping(np.nan), sloping(fall=0.9),
    ],
    ids=["slope", "pit of 25 m", "low shore", "face of 100 m", "hole", "42 degrees"],
)  # fmt: skip
def test_plausible_ground_is_accepted(terrain):
    check_terrain(terrain)


def test_steeper_slopes_may_be_allowed():
    check_terrain(sloping(0.0, low=60.0), max_slope=88.0)
    check_terrain(sloping(0.0), max_slope=90.0)


@pytest.mark.filterwarnings("ignore::snowshed.SnowshedNote")
@pytest.mark.parametrize(
    ("form", "message"),
    [
        ({"crs": "EPSG:2232"}, "its coordinates are in feet .*gdalwarp -t_srs"),
        ({"crs": "EPSG:4326"}, "its map is in degrees"),
        ({"bands": np.stack([SLOPE, SLOPE])}, "has 2 bands"),
        ({"bands": SLOPE % 200, "dtype": "uint8"}, "8-bit values are those of a picture"),
        ({"bands": np.where(SLOPE[5, 5] == SLOPE, 0, SLOPE)}, "are some missing"),
        ({"bands": SLOPE / 0.3048 * 12}, "do not occur on Earth"),
    ],
    ids=["feet", "degrees", "bands", "picture", "zero", "inches"],
)
def test_slides_and_structures_refuse_the_same_terrain(tmp_path, form, message):
    file = write_geotiff(tmp_path / "dem.tif", **form)
    panel = single_panel(height=0.8, length=1.0, tilt=45.0, snow=0.15, dx=0.1)
    origin = {"origin": (500_030.0, 6_700_030.0), "azimuth": 90.0, "x": (-3, 4)}
    with pytest.raises(InputError, match=message):
        on_terrain(panel, file, tmp_path / "ground.npy", **origin)
    with pytest.raises(InputError, match=message):
        slide_scene(file, tmp_path / "none.gpkg", thickness=0.5)
    assert not (tmp_path / "ground.npy").exists()


@pytest.mark.filterwarnings("ignore::snowshed.SnowshedNote")
@pytest.mark.parametrize(
    ("bands", "change", "band"),
    [
        pytest.param(SLOPE * 100, scaled(0.01), None, marks=pytest.mark.slow),
        (SLOPE / 0.3048, in_unit("ft"), None),
        pytest.param(np.stack([SLOPE * 0, SLOPE]), None, 2, marks=pytest.mark.slow),
    ],
)
def test_the_ground_of_structures_does_not_depend_on_the_unit(tmp_path, bands, change, band):
    panel = single_panel(height=0.8, length=1.0, tilt=45.0, snow=0.15, dx=0.1)
    origin = {"origin": (500_030.0, 6_700_030.0), "azimuth": 90.0, "x": (-3, 4)}
    grounds = []
    for file, options in (
        (write_geotiff(tmp_path / "plain.tif"), {}),
        (write_geotiff(tmp_path / "other.tif", bands, change=change), {"band": band}),
    ):
        on_terrain(panel, file, tmp_path / "ground.npy", **origin, **options)
        grounds.append(np.load(tmp_path / "ground.npy"))
    # Whether the highest samples are above the ground's highest point depends on rounding.
    np.testing.assert_allclose(*(ground[..., :25] for ground in grounds), atol=1e-4)


def test_elevations_given_in_memory_are_checked_too(tmp_path):
    panel = single_panel(height=0.8, length=1.0, tilt=45.0, snow=0.15, dx=0.1)
    with pytest.raises(InputError, match="are some missing"):
        on_terrain(
            panel, sloping(0.0), tmp_path / "a.npy", origin=(50.0, 50.0), azimuth=90.0, x=(-3, 4)
        )


def test_a_packed_plane_of_many_cells_is_refused(tmp_path):
    """A kilobyte holds a single elevation for so many cells that a slide would take a gigabyte."""
    flat = np.full((2100, 2100), 500.0)
    file = write_geotiff(tmp_path / "dem.tif", flat, "float32", compress="deflate")
    with pytest.raises(InputError, match="hold 4410000 cells, more than can be packed into them"):
        read_terrain(file)


def test_a_text_grid_is_checked_too(tmp_path):
    (tmp_path / "dem.asc").write_text(grid_text(np.where(SLOPE[5, 5] == SLOPE, 0, SLOPE)))
    with pytest.raises(InputError, match=r"dem\.asc: elevations of .* are some missing"):
        read_terrain(tmp_path / "dem.asc")


def on_map(system, x, y):
    return dataclasses.replace(sloping(), east=x, north=y, crs=system)


@pytest.mark.parametrize(
    ("system", "x", "y", "message"),
    [
        ("EPSG:3857", 1.09e6, 5.9e6, r"100 m on the ground are 145\.7 m eastwards and 146\.1 m "),
        ("EPSG:3395", 1.09e6, 5.9e6, r"100 m on the ground are 146\.2 m eastwards"),
        ("EPSG:32662", 1.0e6, 5.2e6, r"145\.\d m eastwards and 100\.1 m northwards"),
        ("EPSG:3413", -6.0e6, -1.0e6, "so that slopes, areas and masses would be wrong"),
    ],
    ids=["web", "mercator", "plate", "polar"],
)
def test_maps_whose_lengths_are_not_those_on_the_ground_are_refused(system, x, y, message):
    with pytest.raises(InputError, match=message):
        check_terrain(on_map(system, x, y))


@pytest.mark.parametrize(
    ("system", "x", "y"),
    [
        ("EPSG:2056", 2.6e6, 1.2e6),
        ("EPSG:31287", 3.0e5, 4.0e5),
        ("EPSG:32632", 8.0e5, 5.2e6),
        ("EPSG:25833+5941", 1.0e5, 7.0e6),
        ('LOCAL_CS["site",UNIT["metre",1]]', 0.0, 0.0),
        ("EPSG:32632", 1e9, 1e9),
    ],
    ids=["switzerland", "austria", "utm", "compound", "local", "nowhere"],
)
def test_maps_of_surveys_have_no_note_on_their_lengths(system, x, y):
    with record_notes() as notes:
        check_terrain(on_map(system, x, y))
    assert notes == []


def test_small_errors_of_a_map_are_noted():
    with record_notes() as notes:
        check_terrain(on_map("EPSG:32632", 1.5e6, 5.2e6))
    assert "100 m on the ground are 101.2 m eastwards" in notes[0]
