"""GeoTIFF by GDAL's rules: scale, unit, bands, missing values, position, and refused files."""

import os
import re
import warnings

import numpy as np
import pytest
from helpers.raster_files import CELL, NORTH, SIDE, SLOPE, WEST, in_unit, scaled, write_geotiff

from snowshed import InputError, SnowshedNote
from snowshed.base.limits import MAX_RASTER_CELLS
from snowshed.base.notes import record_notes
from snowshed.io.raster.raster import read_raster

rasterio = pytest.importorskip("rasterio")

FOOT, SURVEY_FOOT = 0.3048, 1200 / 3937
PAM = '<PAMDataset><PAMRasterBand band="1">{}</PAMRasterBand></PAMDataset>'


def read_with_notes(path, **options):
    with record_notes() as notes, warnings.catch_warnings():
        raster = read_raster(path, **options)
    return raster, notes


def assert_slope(raster, tolerance=1e-9):
    assert (raster.east, raster.cell) == (WEST + CELL / 2, CELL)
    assert raster.north == NORTH - (SIDE - 0.5) * CELL
    np.testing.assert_allclose(raster.heights, SLOPE[::-1], rtol=0, atol=tolerance)


@pytest.mark.filterwarnings("ignore::snowshed.SnowshedNote")
@pytest.mark.parametrize(
    ("bands", "dtype", "change", "tolerance", "note"),
    [
        (np.round(SLOPE * 10), "int16", scaled(0.1), 0.051, "multiplied by 0.1"),
        (np.round((SLOPE - 500) * 100), "uint16", scaled(0.01, 500.0), 0.0051, ", and 500 added"),
        (SLOPE + 100, "float64", scaled(1.0, -100.0), 1e-9, "-100 added"),
        (SLOPE / FOOT, "float64", in_unit("ft"), 1e-9, "one unit is 0.3048 m"),
        (SLOPE / SURVEY_FOOT, "float64", in_unit("US survey foot"), 1e-9, "is 0.3048006096 m"),
        (SLOPE * 10, "float64", in_unit("dm"), 1e-9, "one unit is 0.1 m"),
    ],
    ids=["scale", "offset", "only offset", "feet", "survey feet", "decimetres"],
)
def test_numbers_are_converted_to_metres_with_a_note(
    tmp_path, bands, dtype, change, tolerance, note
):
    raster, notes = read_with_notes(write_geotiff(tmp_path / "a.tif", bands, dtype, change))
    assert_slope(raster, tolerance)
    assert len(notes) == 1
    assert note in notes[0]


@pytest.mark.parametrize("change", [None, in_unit("m"), in_unit("Metres"), scaled(1.0)])
def test_metres_need_no_note(tmp_path, change):
    raster, notes = read_with_notes(write_geotiff(tmp_path / "a.tif", change=change))
    assert_slope(raster)
    assert notes == []


def test_a_note_is_a_snowshed_note(tmp_path):
    write_geotiff(tmp_path / "a.tif", SLOPE / FOOT, change=in_unit("ft"))
    with pytest.warns(SnowshedNote, match=r"a\.tif: its values were converted to metres"):
        read_raster(tmp_path / "a.tif")


@pytest.mark.filterwarnings("ignore::snowshed.SnowshedNote")
@pytest.mark.parametrize(
    ("system", "metres", "horizontal"),
    [("26913+8228", FOOT, 26913), ("26913+6360", SURVEY_FOOT, 26913), ("25833+5941", 1, 25833)],
)
def test_heights_of_a_compound_system_are_converted_to_metres(tmp_path, system, metres, horizontal):
    write_geotiff(tmp_path / "a.tif", SLOPE / metres, crs=f"EPSG:{system}")
    raster, notes = read_with_notes(tmp_path / "a.tif")
    assert_slope(raster)
    assert raster.crs == f"EPSG:{horizontal}"
    assert len(notes) == (metres != 1)


THREE = np.stack([SLOPE * 0 + 20, SLOPE, SLOPE + 1])


@pytest.mark.filterwarnings("ignore::snowshed.SnowshedNote")
def test_several_bands_need_a_choice(tmp_path):
    write_geotiff(
        tmp_path / "a.tif", THREE, change=lambda file: file.set_band_description(2, "elevation")
    )
    with pytest.raises(InputError, match=r"has 3 bands \('1: float64, 2: elevation, 3: float64'\)"):
        read_raster(tmp_path / "a.tif")
    with pytest.raises(InputError, match="has no band 4; allowed: 1, 2, 3"):
        read_raster(tmp_path / "a.tif", band=4)
    raster, notes = read_with_notes(tmp_path / "a.tif", band=2)
    assert_slope(raster)
    assert notes == ["a.tif: band 2 of 3 is read ('2: elevation')"]


@pytest.mark.parametrize("dtype", ["uint8", "uint16", "float32"])
def test_an_alpha_band_hides_cells(tmp_path, dtype):
    alpha = np.full(SLOPE.shape, 255.0)
    alpha[2, 3] = 0
    bands = np.stack([np.full(SLOPE.shape, 9.0), alpha])
    form = {"ALPHA": "YES", "photometric": "MINISBLACK"}
    raster = read_raster(write_geotiff(tmp_path / "a.tif", bands, dtype, **form))
    assert np.argwhere(np.isnan(raster.heights)).tolist() == [[SIDE - 3, 3]]


def with_hole(value):
    heights = SLOPE.copy()
    heights[2, 3] = value
    return heights


MIN_FLOAT32 = float(np.finfo("float32").min)


@pytest.mark.parametrize(
    ("value", "dtype", "nodata"),
    [
        (-9999, "float32", -9999), (np.nan, "float32", None), (np.nan, "float64", -9999),
        (np.nan, "float32", np.nan), (MIN_FLOAT32, "float32", -3.4028234663852886e38),
        (-32768, "int16", -32768), (0, "float32", 0),
    ],
)  # fmt: skip
def test_missing_values_agree_with_gdal(tmp_path, value, dtype, nodata):
    write_geotiff(tmp_path / "a.tif", with_hole(value), dtype, nodata=nodata)
    raster = read_raster(tmp_path / "a.tif")
    assert np.argwhere(np.isnan(raster.heights)).tolist() == [[SIDE - 3, 3]]


@pytest.mark.filterwarnings("ignore::snowshed.SnowshedNote")
def test_a_missing_value_is_compared_before_scaling(tmp_path):
    heights = np.round(with_hole(-3276.8) * 10)
    write_geotiff(tmp_path / "a.tif", heights, "int16", scaled(0.1), nodata=-32768)
    assert np.isnan(read_raster(tmp_path / "a.tif").heights).sum() == 1


def test_an_internal_mask_hides_cells_and_an_external_mask_is_refused(tmp_path):
    mask = np.full(SLOPE.shape, 255, "uint8")
    mask[2, 3] = 0
    for inside in (True, False):
        with rasterio.Env(GDAL_TIFF_INTERNAL_MASK=inside):
            write_geotiff(tmp_path / f"{inside}.tif", change=lambda file: file.write_mask(mask))
    assert np.isnan(read_raster(tmp_path / "True.tif").heights).sum() == 1
    with pytest.raises(InputError, match=r"False\.tif\.msk: a mask beside a raster is not read"):
        read_raster(tmp_path / "False.tif")


@pytest.mark.filterwarnings("ignore::snowshed.SnowshedNote")
@pytest.mark.parametrize(
    ("fact", "bands", "note"),
    [
        ("<Scale>0.1</Scale><Offset>0</Offset>", SLOPE * 10, "gives its 'scale 0.1'"),
        ("<UnitType>ft</UnitType>", SLOPE / FOOT, "gives its 'unit ft'"),
        ("<Metadata><MDI key='STATISTICS_MEAN'>7</MDI></Metadata>", SLOPE, None),
    ],
    ids=["scale", "unit", "statistics"],
)
def test_entries_of_the_file_aux_xml_are_applied_and_noted(tmp_path, fact, bands, note):
    write_geotiff(tmp_path / "a.tif", bands)
    (tmp_path / "a.tif.aux.xml").write_text(PAM.format(fact))
    raster, notes = read_with_notes(tmp_path / "a.tif")
    assert_slope(raster)
    assert any(note in text for text in notes) if note else notes == []


def test_large_sidecar_files_and_pipes_are_refused(tmp_path):
    write_geotiff(tmp_path / "a.tif")
    (tmp_path / "a.tif.aux.xml").write_bytes(bytes((1 << 20) + 1))
    with pytest.raises(InputError, match=r"aux\.xml: 1048577 bytes; at most"):
        read_raster(tmp_path / "a.tif")
    (tmp_path / "a.tif.aux.xml").unlink()
    os.mkfifo(tmp_path / "a.tif.aux.xml")
    with pytest.raises(InputError, match="not a regular file"):
        read_raster(tmp_path / "a.tif")


def test_overviews_of_a_raster_are_not_opened(tmp_path):
    """A VRT in place of overviews would lead GDAL to another file."""
    write_geotiff(tmp_path / "a.tif")
    (tmp_path / "a.tif.ovr").write_text("<VRTDataset rasterXSize='6' rasterYSize='6'/>")
    assert_slope(read_raster(tmp_path / "a.tif"))


def test_the_position_on_the_map_agrees_with_gdal(tmp_path):
    write_geotiff(tmp_path / "p.tif", change=lambda file: file.update_tags(AREA_OR_POINT="Point"))
    assert_slope(read_raster(tmp_path / "p.tif"))
    up = rasterio.Affine(CELL, 0, WEST, 0, CELL, NORTH - SIDE * CELL)
    write_geotiff(tmp_path / "up.tif", SLOPE[::-1], transform=up)
    assert_slope(read_raster(tmp_path / "up.tif"))
    tifffile = pytest.importorskip("tifffile")
    tifffile.imwrite(tmp_path / "w.tif", SLOPE)
    with pytest.raises(InputError, match="has no position on the map"):
        read_raster(tmp_path / "w.tif")
    middle = f"{WEST + CELL / 2}\n{NORTH - CELL / 2}\n"
    (tmp_path / "w.tfw").write_text(f"{CELL}\n0\n0\n-{CELL}\n{middle}")
    assert_slope(read_raster(tmp_path / "w.tif"))


@pytest.mark.parametrize("name", ["a.asc", "a", "a.TIF", "a.bin"])
def test_a_geotiff_is_recognised_by_its_content(tmp_path, name):
    write_geotiff(tmp_path / "a.tif")
    (tmp_path / "a.tif").replace(tmp_path / name)
    assert_slope(read_raster(tmp_path / name))


GRID = rasterio.Affine(CELL, 0, WEST, 0, -CELL, NORTH)


@pytest.mark.filterwarnings("ignore::rasterio.errors.NotGeoreferencedWarning")
@pytest.mark.parametrize(
    ("form", "message"),
    [
        ({"change": scaled(0.0)}, "a scale of 0 and an offset of 0 are not allowed"),
        ({"change": scaled(float("nan"))}, "a scale of nan"),
        ({"change": in_unit("degrees")}, "its values are in 'degrees', which is not a unit of "
                                         "length"),
        ({"change": in_unit("m"), "crs": "EPSG:26913+8228"}, "correct one of them"),
        ({"transform": GRID @ rasterio.Affine.rotation(9)}, "not on square cells with north up"),
        ({"transform": GRID @ rasterio.Affine.scale(-1, 1)}, "not on square cells with north up"),
        ({"transform": GRID @ rasterio.Affine.scale(1, 2)}, "not on square cells"),
        ({"transform": rasterio.Affine.identity(), "crs": None}, "has no position on the map"),
        ({"crs": "EPSG:4979"}, "its map is in degrees"),
    ],
    ids=["zero", "nan", "unit", "contradiction", "turned", "mirrored", "oblong", "lost", "3d"],
)  # fmt: skip
def test_unreadable_rasters_are_named(tmp_path, form, message):
    write_geotiff(tmp_path / "a.tif", **form)
    with pytest.raises(InputError, match=rf"a\.tif: .*{re.escape(message)}"):
        read_raster(tmp_path / "a.tif")


def test_a_palette_and_several_images_are_refused(tmp_path):
    colours = {number: (number, number, number, 255) for number in range(256)}
    write_geotiff(
        tmp_path / "a.tif", SLOPE % 255, "uint8", lambda file: file.write_colormap(1, colours),
        photometric="palette",
    )  # fmt: skip
    with pytest.raises(InputError, match="its values are palette colours"):
        read_raster(tmp_path / "a.tif")
    tifffile = pytest.importorskip("tifffile")
    tifffile.imwrite(tmp_path / "b.tif", np.stack([SLOPE, SLOPE]), photometric="minisblack")
    with pytest.raises(InputError, match=r"b\.tif: holds 2 images; take one out of it"):
        read_raster(tmp_path / "b.tif")


@pytest.mark.parametrize(
    ("width", "height", "form"),
    [
        (10_000, 10_000, {}), (100_000_000, 1, {}), (1, MAX_RASTER_CELLS + 1, {}),
        (100_000, 100_000, {"tiled": True}),
    ],
)  # fmt: skip
def test_a_small_file_of_many_cells_is_refused_before_it_is_read(tmp_path, width, height, form):
    sparse = {"sparse_ok": True, "count": 1, "dtype": "float32", "crs": "EPSG:25833", **form}
    with rasterio.open(
        tmp_path / "a.tif", "w", driver="GTiff", width=width, height=height,
        transform=rasterio.Affine(CELL, 0, WEST, 0, -CELL, NORTH), **sparse,
    ):  # fmt: skip
        pass
    assert (tmp_path / "a.tif").stat().st_size < 2 << 20
    with pytest.raises(InputError, match=f"columns and {height} rows; at most {MAX_RASTER_CELLS}"):
        read_raster(tmp_path / "a.tif")


def test_a_block_that_would_fill_the_memory_is_refused(tmp_path):
    side = 8192  # 512 MB
    with rasterio.open(
        tmp_path / "a.tif", "w", driver="GTiff", width=20, height=20, count=1, crs="EPSG:25833",
        dtype="float64", transform=rasterio.Affine(CELL, 0, WEST, 0, -CELL, NORTH), tiled=True,
        blockxsize=side, blockysize=side, sparse_ok=True,
    ):  # fmt: skip
        pass
    with pytest.raises(InputError, match="bands take more than 256 MB"):
        read_raster(tmp_path / "a.tif")


@pytest.mark.parametrize("name", ["a.tif", "a.asc"])
def test_a_pipe_is_refused_and_does_not_hang(tmp_path, name):
    os.mkfifo(tmp_path / name)
    with pytest.raises(InputError, match="not a regular file"):
        read_raster(tmp_path / name)


def test_a_cut_file_is_refused(tmp_path):
    content = write_geotiff(tmp_path / "a.tif").read_bytes()
    (tmp_path / "a.tif").write_bytes(content[: len(content) // 2])
    with pytest.raises(InputError, match=r"a\.tif: not a GeoTIFF"):
        read_raster(tmp_path / "a.tif")


@pytest.mark.parametrize("system", ["http://127.0.0.1:9/a.wkt", "/etc/hostname"])
def test_a_coordinate_system_in_a_sidecar_file_is_not_fetched(tmp_path, system):
    write_geotiff(tmp_path / "a.tif")
    (tmp_path / "a.tif.aux.xml").write_text(f"<PAMDataset><SRS>{system}</SRS></PAMDataset>")
    with pytest.raises(InputError, match=r"a\.tif: not a GeoTIFF: Cannot import"):
        read_raster(tmp_path / "a.tif")


def test_empty_files_are_named(tmp_path):
    (tmp_path / "a.tif").write_bytes(b"")
    with pytest.raises(InputError, match=r"a\.tif: not a GeoTIFF: it is empty"):
        read_raster(tmp_path / "a.tif")
    write_geotiff(tmp_path / "a.tif")
    for name in ("a.tif.aux.xml", "a.tfw"):
        (tmp_path / name).write_bytes(b"")
    assert_slope(read_raster(tmp_path / "a.tif"))
