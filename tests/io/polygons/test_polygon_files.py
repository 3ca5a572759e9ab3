"""Files of polygons: accepted formats are read, and others are refused without being opened."""

import json
import os
import shutil
import warnings
from pathlib import Path

import numpy as np
import pytest
from helpers.listener import silence
from helpers.polygon_files import HOLE, SQUARE, polygon, pyogrio, shapely, write
from helpers.slide_files import WITH_HOLE, box, write_features, write_polygons

from snowshed import InputError
from snowshed.base.limits import MAX_CORNERS, MAX_POLYGONS
from snowshed.base.notes import record_notes
from snowshed.io.raster.areas import read_areas

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning", "ignore::RuntimeWarning")

ENDINGS = (".gpkg", ".shp", ".geojson")
READ_DRIVERS = {"GPKG", "ESRI Shapefile", "GeoJSON"}


@pytest.mark.parametrize("ending", ENDINGS)
def test_parts_holes_and_heights_are_read(tmp_path, ending):
    high = shapely.force_3d(polygon(*SQUARE.exterior.coords, holes=[HOLE]), 7.0)
    two = shapely.MultiPolygon([shapely.force_3d(polygon((50, 0), (60, 0), (60, 9)), 1.0), high])
    kind = "MultiPolygon" if ending == ".shp" else "Unknown"
    file = write(tmp_path / f"a{ending}", [two, high], kind=kind, name=["A", ""], d0=[0.5, 0.25])
    areas = read_areas(file)
    assert [area.name for area in areas] == ["A", "A", "area 2"]
    assert [area.thickness for area in areas] == [0.5, 0.5, 0.25]
    assert {area.crs for area in areas} == {"EPSG:25833"}
    sizes = sorted(shapely.Polygon(area.outline, area.holes).area for area in areas)
    assert sizes == [45.0, 375.0, 375.0]
    assert all(len(corner) == 2 for area in areas for corner in area.outline)


@pytest.mark.parametrize("ending", ENDINGS)
def test_repeated_corners_are_dropped(tmp_path, ending):
    twice = polygon((10, 10), (10, 10), (30, 10), (30, 30), (30, 30), (30, 30), (10, 30))
    (area,) = read_areas(write(tmp_path / f"a{ending}", [twice], d0=[0.5]))
    assert sorted(area.outline) == [(10, 10), (10, 30), (30, 10), (30, 30)]


# --- formats ------------------------------------------------------------------------------------


def referring_files(address):
    """Return files that name other files or addresses, which GDAL recognises by their content."""
    source = f"/vsicurl/{address}/a.gpkg"
    layer = f'<OGRVRTLayer name="a"><SrcDataSource>{source}</SrcDataSource></OGRVRTLayer>'
    vrt = f"<OGRVRTDataSource>{layer}</OGRVRTDataSource>"
    square = {"type": "Polygon", "coordinates": box(0, 0, 9, 9)}
    feature = {"type": "Feature", "properties": {"text": vrt}, "geometry": square}
    return {
        "OGR_VRT": vrt,
        "WFS": f"<OGRWFSDataSource><URL>{address}/wfs</URL></OGRWFSDataSource>",
        "OAPIF": f'{{"links": [{{"href": "{address}", "rel": "data"}}], "conformsTo": []}}',
        "GDALG": json.dumps(
            {"type": "gdal_streamed_alg", "command_line": f"gdal vector pipeline ! read {source}"}
        ),
        "ESRIJSON": '{"features":[],"geometryType":"esriGeometryPolygon"}',
        "TopoJSON": '{"type":"Topology","objects":{},"arcs":[]}',
        "CSW": f"<GetCapabilities>{address}</GetCapabilities>",
        "GTFS": "stop_id,stop_name\n1,a\n",
        "CSV": 'WKT,thickness\n"POLYGON((0 0,9 0,9 9,0 0))",0.5\n',
        "GML": f'<!DOCTYPE a [<!ENTITY b SYSTEM "{address}/b">]><gml:a xmlns:gml="x">&b;</gml:a>',
        "a VRT within a text": json.dumps({"type": "FeatureCollection", "features": [feature]}),
    }


def written_by_gdal(folder):
    """Return a file of every driver that writes polygons, by the driver's name."""
    files_by_driver = {}
    for driver, mode in pyogrio.list_drivers().items():
        file = folder / driver.replace(" ", "_")
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                pyogrio.raw.write(
                    file,
                    np.array([shapely.to_wkb(SQUARE)], dtype=object),
                    [np.array([0.5])],
                    np.array(["thickness"]),
                    crs="EPSG:25833",
                    geometry_type="Polygon",
                    driver=driver,
                )
        except Exception:
            assert "w" not in mode or driver not in READ_DRIVERS
            continue
        files = [file] if file.is_file() else sorted(folder.glob(f"{file.name}*"))
        files = [path for path in files if path.is_file()] or sorted(file.glob("*"))
        if files:
            files_by_driver[driver] = files
    return files_by_driver


def test_only_the_named_formats_are_read(tmp_path):
    """Every format that this GDAL writes is tried with every accepted ending."""
    (tmp_path / "written").mkdir()
    with silence() as listener:
        contents = {
            driver: [file.read_bytes() for file in files]
            for driver, files in written_by_gdal(tmp_path / "written").items()
        }
        assert len(contents) > 15 and READ_DRIVERS & contents.keys()
        contents.update(
            {name: [text.encode()] for name, text in referring_files(listener.address).items()}
        )
        for driver, files in contents.items():
            for content in files:
                for ending in ENDINGS:
                    (tmp_path / f"a{ending}").write_bytes(content)
                    if driver not in READ_DRIVERS:
                        with pytest.raises(InputError):
                            read_areas(tmp_path / f"a{ending}")
        for ending in ENDINGS:
            good_file = write(tmp_path / f"good{ending}", [SQUARE], thickness=[0.5])
            assert len(read_areas(good_file)) == 1


def test_gdal_alone_would_make_a_request(tmp_path, monkeypatch):
    """The listener notices connections, so the previous test can fail."""
    monkeypatch.setenv("GDAL_HTTP_TIMEOUT", "5")  # earlier versions wait for ever
    with pytest.raises(AssertionError), silence() as listener:
        (tmp_path / "a.gpkg").write_text(referring_files(listener.address)["OGR_VRT"])
        with pytest.raises(Exception, match=r"a\.gpkg"):
            pyogrio.raw.read(tmp_path / "a.gpkg")


def test_an_esri_json_is_refused_by_name(tmp_path):
    (tmp_path / "a.geojson").write_text(referring_files("")["ESRIJSON"])
    with pytest.raises(InputError, match="it is Esri JSON; export it as GeoJSON"):
        read_areas(tmp_path / "a.geojson")


def test_pipes_are_refused_at_once(tmp_path):
    os.mkfifo(tmp_path / "a.gpkg")
    with pytest.raises(InputError, match="not a regular file"):
        read_areas(tmp_path / "a.gpkg")
    write(tmp_path / "b.shp", [SQUARE], thickness=[0.5])
    (tmp_path / "b.dbf").unlink()
    os.mkfifo(tmp_path / "b.dbf")
    with pytest.raises(InputError, match=r"b.dbf: not a regular file"):
        read_areas(tmp_path / "b.shp")


# --- coordinate systems -------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("crs", "message"),
    [
        ({"type": "link", "properties": {"href": "ADDRESS", "type": "ogcwkt"}}, "crs: a link"),
        ({"type": "name", "properties": {"name": "ADDRESS"}}, "is not a code such as"),
        ({"type": "name", "properties": {"name": "/etc/passwd"}}, "is not a code such as"),
        ({"type": "name", "properties": {"name": "+init=/tmp/a:1"}}, "is not a code such as"),
        ("EPSG:25833", "not as GeoJSON has it"),
    ],
)
def test_the_coordinate_system_of_a_geojson_must_be_a_name(tmp_path, crs, message):
    file = write_polygons(tmp_path / "a.geojson")
    with silence() as listener:
        text = json.dumps({**json.loads(file.read_text()), "crs": crs})
        file.write_text(text.replace("ADDRESS", f"{listener.address}/crs"))
        with pytest.raises(InputError, match=message):
            read_areas(file)


@pytest.mark.parametrize(
    "name",
    [
        "urn:ogc:def:crs:EPSG::31287",
        "http://www.opengis.net/def/crs/EPSG/0/31287",
        "urn:ogc:def:crs:EPSG:9.9:31287",
        "epsg:31287",
    ],
)
def test_names_of_a_coordinate_system_in_geojson(tmp_path, name):
    (area,) = read_areas(write_polygons(tmp_path / "a.geojson", crs=name, thickness=0.5))
    assert area.crs.upper() == "EPSG:31287"


def test_a_geojson_in_metres_needs_a_coordinate_system(tmp_path):
    file = write_polygons(tmp_path / "a.geojson", box(500000, 6700000, 500050, 6700050))
    data = json.loads(file.read_text())
    del data["crs"]
    file.write_text(json.dumps(data))
    with pytest.raises(InputError, match=r"has no coordinate system; .* write it in metres"):
        read_areas(file)
    data["features"][0]["geometry"]["coordinates"] = box(13, 47, 13.1, 47.1)
    file.write_text(json.dumps(data))
    with pytest.raises(InputError, match="its coordinates are in degrees"):
        read_areas(file)


@pytest.mark.parametrize("text", ["ADDRESS/prj", "/etc/passwd", "+init=/etc/passwd:1", "{}"])
def test_the_prj_file_of_a_shapefile_must_be_a_description(tmp_path, text):
    file = write(tmp_path / "a.shp", [SQUARE], thickness=[0.5])
    with silence() as listener:
        (tmp_path / "a.prj").write_text(text.replace("ADDRESS", listener.address))
        with pytest.raises(InputError, match=r"a\.prj: not a coordinate system; allowed: WKT"):
            read_areas(file)


@pytest.mark.parametrize("ending", [".gpkg", ".shp"])
def test_a_missing_coordinate_system_is_noted(tmp_path, ending):
    file = write(tmp_path / f"a{ending}", [SQUARE], crs=None, thickness=[0.5])
    with record_notes() as notes:
        assert read_areas(file)[0].crs == ""
    assert notes == [f"{file}: has no coordinate system; that of the terrain is assumed"]


# --- thickness ----------------------------------------------------------------------------------


@pytest.mark.parametrize("ending", [".gpkg", ".geojson"])
@pytest.mark.parametrize(
    ("field", "value", "metres", "note"),
    [
        ("thickness", 0.5, 0.5, None),
        ("Thickness", 0.5, 0.5, "its field 'Thickness', in m"),
        ("d0", 0.5, 0.5, "its field 'd0', in m"),
        ("thickness_cm", 50, 0.5, "its field 'thickness_cm', in cm"),
        ("D0 [mm]", 500, 0.5, "its field 'D0 [mm]', in mm"),
        ("depth", 0.5, None, "ignored as a thickness: 'depth'"),
    ],
)
def test_the_field_of_the_thickness_is_noted(tmp_path, ending, field, value, metres, note):
    file = write(tmp_path / f"a{ending}", [SQUARE], **{field: [float(value)]})
    with record_notes() as notes:
        (area,) = read_areas(file)
    assert area.thickness == pytest.approx(metres)
    assert [note in text for text in notes] == [True] if note else not notes


@pytest.mark.parametrize("ending", [".gpkg", ".geojson"])
def test_a_truth_value_is_no_thickness(tmp_path, ending):
    """SQLite stores it as 1, which would be a metre."""
    file = write(tmp_path / f"a{ending}", [SQUARE, polygon((50, 0), (60, 0), (60, 9))],
                 d0=[True, False])  # fmt: skip
    with pytest.raises(InputError, match="feature 1: d0 'True' is not a number"):
        read_areas(file)


def test_fields_that_contradict_each_other_are_refused(tmp_path):
    file = write(tmp_path / "a.gpkg", [SQUARE], thickness=[0.5], d0=[0.6])
    with pytest.raises(InputError, match=r"thickness says 0.5 m and d0 0.6 m"):
        read_areas(file)
    write(file, [SQUARE], thickness_ft=[1.5])
    with pytest.raises(InputError, match="'thickness_ft' has the unit 'ft'; allowed: m, dm, cm"):
        read_areas(file)


def test_forest_needs_no_thickness(tmp_path):
    file = write_polygons(tmp_path / "a.geojson", thickness=0)
    with pytest.raises(InputError, match="thickness is 0 m; give one above 0"):
        read_areas(file)
    (area,) = read_areas(file, with_thickness=False)
    assert area.thickness is None


@pytest.mark.parametrize("ending", ENDINGS)
def test_too_many_corners_and_polygons_are_refused(tmp_path, ending):
    turn = np.linspace(0, 2 * np.pi, MAX_CORNERS + 1, endpoint=False)
    many = polygon(*np.c_[100 * np.cos(turn), 100 * np.sin(turn)])
    with pytest.raises(InputError, match=f"more than {MAX_CORNERS} corners"):
        read_areas(write(tmp_path / f"a{ending}", [many], d0=[0.5]))
    few = [SQUARE] * (MAX_POLYGONS + 1)
    with pytest.raises(InputError, match=f"more than {MAX_POLYGONS} polygons"):
        read_areas(write(tmp_path / f"b{ending}", few, d0=[0.5] * len(few)))


def test_a_feature_of_many_properties_is_read(tmp_path):
    fields = {f"p{number}": number for number in range(100_000)}
    file = write_features(tmp_path / "a.geojson", [(WITH_HOLE, {**fields, "thickness": 0.5})])
    assert read_areas(file)[0].thickness == 0.5


def test_an_index_that_repeats_a_record_is_counted(tmp_path):
    """The index of a short file names a large polygon many times."""
    turn = np.linspace(0, 2 * np.pi, 40_000, endpoint=False)
    file = write(tmp_path / "a.shp", [polygon(*np.c_[np.cos(turn), np.sin(turn)])], d0=[0.5])
    index = file.with_suffix(".shx")
    index.write_bytes(index.read_bytes() + index.read_bytes()[100:] * 5000)
    with pytest.raises(InputError, match=f"more than {MAX_CORNERS} corners"):
        read_areas(file)


@pytest.mark.parametrize(
    "text",
    ["[" * 100_000, '{"type": "FeatureCollection", "features": 1}', '{"type": "Polygon"}',
     '{"type": "Polygon", "coordinates": [[[1, 2], [3, "4"], [5, 6]]], "crs": null}',
     '{"type": "Polygon", "coordinates": [[[1, 2], [3, 1e400], [5, 6]]], "crs": null}',
     '{"type": "Polygon", "coordinates": [[[1, 2], [3, NaN], [5, 6]]], "crs": null}',
     '{"type": "Polygon", "coordinates": [[[1, 2], [3, 4]]], "crs": null}',
     '{"type": "Polygon", "coordinates": [[[1, 2], [3, ' + "9" * 400 + ']]], "crs": null}',
     '{"type": "Polygon", "coordinates": [[[1], [2], [3]]], "crs": null}',
     '{"type": "GeometryCollection", "geometries": []}', '{"type": {}}', "{}",
     '{"type": "Feature"}'],
)  # fmt: skip
def test_invalid_geojson_is_refused(tmp_path, text):
    (tmp_path / "a.geojson").write_text(text)
    with pytest.raises(InputError):
        read_areas(tmp_path / "a.geojson")


def test_a_shapefile_needs_its_ending_and_its_index(tmp_path):
    file = write(tmp_path / "a.shp", [SQUARE], d0=[0.5])
    shutil.copy(file, tmp_path / "b.gpkg")
    with pytest.raises(InputError, match=r"its name does not end in .shp"):
        read_areas(tmp_path / "b.gpkg")
    Path(tmp_path / "a.shx").unlink()
    with pytest.raises(InputError, match=r"its index a.shx is not beside it"):
        read_areas(file)


def test_features_without_corners_are_counted(tmp_path):
    file = write(tmp_path / "a.gpkg", [SQUARE, shapely.Polygon()], d0=[0.5, 0.5])
    with record_notes() as notes:
        assert len(read_areas(file)) == 1
    assert f"{file}: 1 feature without corners, left out" in notes


def test_a_unit_that_a_shapefile_cuts_off_is_told(tmp_path):
    file = write(tmp_path / "a.shp", [SQUARE], thickness_cm=[50.0])
    with record_notes() as notes:
        assert read_areas(file)[0].thickness is None
    assert any("a shapefile cuts names after ten characters" in note for note in notes)


def test_a_thickness_that_is_replaced_is_noted_and_not_read(tmp_path):
    file = write(tmp_path / "a.gpkg", [SQUARE], d0=[0.5], thickness_cm=[80.0])
    with record_notes() as notes:
        assert read_areas(file, replacement="depth.asc")[0].thickness is None
    (note,) = notes
    assert note.endswith("is that of depth.asc, not of its field 'd0' and 'thickness_cm'")
