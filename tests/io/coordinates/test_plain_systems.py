"""Coordinate systems: descriptions are read, never fetched; comparisons are on the map."""

import numpy as np
import pytest
from helpers.listener import silence

from snowshed import InputError
from snowshed.io.coordinates.plain_systems import first_part, plain_system
from snowshed.io.coordinates.systems import are_same, is_in_degrees, is_in_feet, read_prj, system_of
from snowshed.io.raster.output import write_raster
from snowshed.io.raster.raster import Raster, read_raster, write_ascii_grid

rasterio = pytest.importorskip("rasterio")

WKT = rasterio.crs.CRS.from_epsg(25833).to_wkt()


@pytest.mark.parametrize(
    "words",
    ["EPSG:25833", "epsg:25833+5941", "OGC:CRS84", "ESRI:102031", WKT,
     "+proj=utm +zone=33 +ellps=GRS80 +towgs84=0,0,0 +units=m +no_defs",
     "+proj=merc +a=6378137 +b=6378137 +nadgrids=@null +wktext +no_defs",
     rasterio.crs.CRS.from_epsg(3857).to_wkt(), rasterio.crs.CRS.from_epsg(5973).to_wkt()],
)  # fmt: skip
def test_descriptions_are_read(words):
    assert plain_system(words) == words
    assert system_of(words) is not None


@pytest.mark.parametrize(
    "words",
    ["ADDRESS/a", "/etc/passwd", "a.prj", "/vsicurl/ADDRESS/a", "+init=/etc/passwd:1",
     "+proj=utm +zone=33 +nadgrids=/etc/passwd", "+proj=utm +zone=33 +geoidgrids=ADDRESS/a.gtx",
     "+proj=utm +zone=33 +nadgrids=@/etc/passwd", "+proj=pipeline +step +file=/etc/passwd",
     "urn:ogc:def:crs:EPSG::25833", "AUTO:42001", "{}", "", "EPSG:25833\0/etc/passwd",
     "ESRI::ADDRESS", "IGNF:LAMB93", "EPSG:" + "9" * 70000, 'PROJCS["' + "a" * 70000 + '"]',
     WKT[:-1] + ',EXTENSION["PROJ4","+proj=utm +zone=33 +init=/etc/passwd:1"]]'],
)  # fmt: skip
def test_systems_that_must_be_fetched_or_opened_are_ignored(tmp_path, words):
    with silence() as listener:
        words = words.replace("ADDRESS", listener.address)
        assert plain_system(words) == "" and system_of(words) is None
        assert not are_same(words, "EPSG:25833")
        assert not is_in_degrees(words) and not is_in_feet(words)
        flat = Raster(np.zeros((3, 3)), 0.0, 0.0, 5.0, crs=words)
        write_raster(tmp_path / "a.tif", flat)
        write_raster(tmp_path / "a.asc", flat)
    assert read_raster(tmp_path / "a.tif").crs == ""
    assert not (tmp_path / "a.prj").exists()


@pytest.mark.parametrize("text", ["ADDRESS/prj", "/etc/passwd", "+init=/etc/passwd:1", "[" * 999])
def test_the_prj_file_of_a_grid_must_be_a_description(tmp_path, text):
    write_ascii_grid(tmp_path / "a.asc", Raster(np.zeros((3, 3)), 0.0, 0.0, 5.0))
    with silence() as listener:
        (tmp_path / "a.prj").write_text(text.replace("ADDRESS", listener.address))
        with pytest.raises(InputError, match=r"a\.prj: not a coordinate system; allowed: WKT"):
            read_raster(tmp_path / "a.asc")
    (tmp_path / "a.prj").write_text(WKT)
    assert read_prj(tmp_path / "a.asc") == "EPSG:25833"


def test_a_raster_with_the_content_of_another_format_makes_no_request(tmp_path):
    with silence() as listener:
        source = f"<SourceFilename>/vsicurl/{listener.address}/a.tif</SourceFilename>"
        band = f'<VRTRasterBand dataType="Byte" band="1"><SimpleSource>{source}</SimpleSource>'
        vrt = f'<VRTDataset rasterXSize="9" rasterYSize="9">{band}</VRTRasterBand></VRTDataset>'
        wms = f'<GDAL_WMS><Service name="WMS"><ServerUrl>{listener.address}</ServerUrl></Service>'
        for text in (vrt, f"{wms}</GDAL_WMS>", f"{listener.address}/a.tif", "WCS"):
            for ending in (".tif", ".tiff", ".asc"):
                (tmp_path / f"a{ending}").write_text(text)
                with pytest.raises(InputError):
                    read_raster(tmp_path / f"a{ending}")


def test_masks_and_overviews_of_a_geotiff_make_no_request(tmp_path):
    flat = Raster(np.zeros((9, 9)), 500000.0, 6700000.0, 5.0, crs="EPSG:25833")
    write_raster(tmp_path / "a.tif", flat)
    with silence() as listener:
        source = f"<SourceFilename>/vsicurl/{listener.address}/a.tif</SourceFilename>"
        band = f'<VRTRasterBand dataType="Byte" band="1"><SimpleSource>{source}</SimpleSource>'
        vrt = f'<VRTDataset rasterXSize="9" rasterYSize="9">{band}</VRTRasterBand></VRTDataset>'
        for ending in (".ovr", ".aux.xml"):
            (tmp_path / f"a.tif{ending}").write_text(vrt)
        assert read_raster(tmp_path / "a.tif").heights.shape == (9, 9)
        (tmp_path / "a.tif.msk").write_text(vrt)
        with pytest.raises(InputError, match="a mask beside a raster is not read"):
            read_raster(tmp_path / "a.tif")


def test_compound_systems_are_compared_without_their_heights():
    compound = rasterio.crs.CRS.from_epsg(5973).to_wkt()  # UTM 33N with heights
    assert compound.startswith("COMPD_CS")
    assert are_same(compound, "EPSG:25833") and are_same("EPSG:25833+5941", "EPSG:25833")
    assert not are_same(compound, "EPSG:25832")
    assert is_in_degrees("EPSG:4326+5773") and not is_in_degrees(compound)
    assert is_in_feet("EPSG:2272+6360") and not is_in_feet("EPSG:25833+6360")
    assert first_part(compound).startswith("PROJCS[")


def test_the_prj_file_of_results_has_the_horizontal_part_of_a_compound_system(tmp_path):
    flat = Raster(np.zeros((3, 3)), 0.0, 0.0, 5.0, crs="EPSG:25833+5941")
    write_raster(tmp_path / "a.asc", flat)
    assert read_prj(tmp_path / "a.asc") == "EPSG:25833"
