"""ESRI ASCII grids in common variants, against GDAL's reading of the same text."""

import numpy as np
import pytest
from helpers.raster_files import CELL, SIDE, SLOPE, WEST, grid_text

from snowshed import InputError
from snowshed.base.limits import MAX_RASTER_CELLS
from snowshed.base.notes import record_notes
from snowshed.io.raster.raster import Raster, read_raster, write_ascii_grid

rasterio = pytest.importorskip("rasterio")

CELL_TEXT = "884.960"  # m, in row 2 and column 10, counted from the north-west
CELL_INDEX = [[SIDE - 3, 10]]


def with_word(word, **header):
    text = grid_text(**header)
    assert text.count(CELL_TEXT) == 1
    return text.replace(CELL_TEXT, word)


def gdal_reads(path):
    with rasterio.open(path) as source:
        values = source.read(1, masked=True).astype("float64").filled(np.nan)
        return values[::-1], source.transform.c + 0.5 * source.transform.a


@pytest.mark.filterwarnings("ignore::snowshed.SnowshedNote")
@pytest.mark.parametrize(
    ("text", "missing"),
    [
        (grid_text(), []),
        (grid_text(cellsize=None, dx=5.0, dy="5.000"), []),
        (with_word("-3.40282346638529e+38", NODATA_value="-3.4028234663852886e+38"), CELL_INDEX),
        (with_word("-3.4028234663852886e+38", NODATA_value="-3.402823e+38"), CELL_INDEX),
        (with_word("-9999.0", NODATA_value="-9999"), CELL_INDEX),
        (with_word("nan", NODATA_value="-9999"), CELL_INDEX),
        (with_word("NaN"), CELL_INDEX),
        (with_word("1.#QNAN"), CELL_INDEX),
        (with_word("-1.#IND"), CELL_INDEX),
        (grid_text().replace(".", ",").replace("5,0", "5"), []),
        (grid_text().replace("\n", "\r\n").replace(" ", "\t"), []),
        (grid_text().upper(), []),
    ],
    ids=[
        "plain", "dx", "single", "few digits", "decimals", "nan", "NaN", "QNAN", "IND", "commas",
        "Windows", "capitals",
    ],
)  # fmt: skip
def test_a_grid_is_read_as_gdal_reads_it(tmp_path, text, missing):
    (tmp_path / "a.asc").write_bytes(text.encode())
    raster = read_raster(tmp_path / "a.asc")
    theirs, west = gdal_reads(tmp_path / "a.asc")
    np.testing.assert_allclose(raster.heights, theirs, rtol=1e-7)
    assert raster.east == pytest.approx(west, abs=1e-9)
    assert np.argwhere(np.isnan(raster.heights)).tolist() == missing


@pytest.mark.filterwarnings("ignore::snowshed.SnowshedNote")
@pytest.mark.parametrize(
    ("text", "note"),
    [
        (with_word("-9999"), "a.asc: 1 values of -9999 are missing; the header declares none"),
        (with_word("884,960"), "a.asc: 1 numbers have a decimal comma"),
        (grid_text(), None),
        (with_word("-9999", nodata_value=-9999), None),
    ],
    ids=["undeclared", "comma", "plain", "declared"],
)
def test_assumptions_are_noted(tmp_path, text, note):
    (tmp_path / "a.asc").write_text(text)
    with record_notes() as notes:
        read_raster(tmp_path / "a.asc")
    assert notes == ([note] if note else [])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (grid_text(cellsize=None, dx=5, dy=6), "dx and dy differ; resample the raster"),
        (grid_text(cellsize=None, dx=5), "one of cellsize and both dx and dy"),
        (grid_text(dx=5, dy=5), "one of cellsize and both dx and dy"),
        (with_word("inf"), "'inf' is not a valid number"),
        (with_word("1e9"), "'1e9' is beyond 1e5 m; the header has no nodata_value"),
        (grid_text().replace(" ", ", "), "neither an ESRI ASCII grid"),
        (grid_text().replace(" 8", ", 8"), "values are separated by blanks, not by commas"),
        ("north: 9\nsouth: 3\n", "neither an ESRI ASCII grid, which begins with ncols, nor a GeoT"),
        (grid_text(ncols=40_000, nrows=40_000), f"1600000000 cells; at most {MAX_RASTER_CELLS}"),
        (grid_text(cellsize="nan"), "'nan' is not a valid number"),
    ],
)
def test_invalid_grids_are_refused(tmp_path, text, message):
    (tmp_path / "a.asc").write_text(text)
    with pytest.raises(InputError, match=rf"a\.asc.*{message}"):
        read_raster(tmp_path / "a.asc")


def test_a_byte_order_mark_is_ignored(tmp_path):
    (tmp_path / "a.asc").write_text(grid_text(), encoding="utf-8-sig")
    assert read_raster(tmp_path / "a.asc").heights.shape == SLOPE.shape


@pytest.mark.filterwarnings("ignore::snowshed.SnowshedNote")
def test_feet_in_the_prj_become_metres(tmp_path):
    system = rasterio.crs.CRS.from_epsg(26913).to_wkt(version="WKT1_ESRI")
    feet = (
        'VERTCS["NAVD88_height_(ftUS)",VDATUM["North_American_Vertical_Datum_1988"],'
        'PARAMETER["Vertical_Shift",0.0],PARAMETER["Direction",1.0],'
        'UNIT["Foot_US",0.3048006096012192]]'
    )
    (tmp_path / "a.asc").write_text(grid_text(SLOPE * 3937 / 1200))
    (tmp_path / "a.prj").write_text(f"{system},{feet}")
    with record_notes() as notes:
        raster = read_raster(tmp_path / "a.asc")
    np.testing.assert_allclose(raster.heights, SLOPE[::-1], atol=1e-3)
    assert raster.crs == "EPSG:26913"
    assert not raster.plain
    assert notes == ["a.asc: its values were converted to metres; one unit is 0.3048006096 m"]


@pytest.mark.parametrize("values", [SLOPE.astype("float32").astype("float64"), SLOPE * np.pi])
def test_an_exact_copy_holds_every_bit(tmp_path, values):
    """Single-precision values, too, need over nine digits, because the core has doubles."""
    write_ascii_grid(tmp_path / "a.asc", Raster(values, WEST, 0.0, CELL), exact=True)
    np.testing.assert_array_equal(read_raster(tmp_path / "a.asc").heights, values)


@pytest.mark.parametrize(
    ("fact", "message"),
    [
        ("<Scale>0.1</Scale>", "gives Scale '0.1', which an ASCII grid cannot have"),
        ("<Offset>5</Offset>", "gives Offset '5'"),
        ("<UnitType>ft</UnitType>", "gives UnitType 'ft'"),
        (f"<NoDataValue le_hex_endian='x'>{CELL_TEXT}</NoDataValue>", "gives NoDataValue"),
        ("<Scale>1</Scale><Offset>0</Offset><UnitType>m</UnitType>", None),
        ("<NoDataValue>-9999</NoDataValue><Statistics><STDEV>3</STDEV></Statistics>", None),
    ],
)
def test_sidecar_files_that_change_a_grid_are_refused(tmp_path, fact, message):
    (tmp_path / "a.asc").write_text(grid_text())
    (tmp_path / "a.asc.aux.xml").write_text(f"<PAMDataset>{fact}</PAMDataset>")
    if message is None:
        assert read_raster(tmp_path / "a.asc").heights.shape == SLOPE.shape
    else:
        with pytest.raises(InputError, match=rf"a\.asc\.aux\.xml: {message}"):
            read_raster(tmp_path / "a.asc")
