"""GeoPackages: tables are read, and nothing in them is evaluated."""

import sqlite3
import struct

import numpy as np
import pytest
from helpers.polygon_files import SQUARE, polygon, pyogrio, shapely, write
from helpers.slide_files import write_polygons

from snowshed import InputError
from snowshed.base.notes import record_notes
from snowshed.io.raster.areas import read_areas

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning", "ignore::RuntimeWarning")


@pytest.fixture
def package(tmp_path):
    return write(tmp_path / "a.gpkg", [SQUARE], name=["A"], thickness=[0.5])


def change(file, *statements):
    with sqlite3.connect(file) as connection:
        for name in connection.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'"):
            connection.execute(f'DROP TRIGGER "{name[0]}"')
        for statement in statements:
            connection.execute(statement)
    connection.close()
    return file


ENDLESS = "WITH RECURSIVE r(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM r)"


@pytest.mark.parametrize(
    "statements",
    [
        ('ALTER TABLE "a" RENAME TO "old"',
         f'CREATE VIEW "a" AS {ENDLESS} SELECT n AS fid, geom, name, thickness FROM r, old'),
        ('ALTER TABLE "a" RENAME TO "old"',
         'CREATE VIEW "a" AS SELECT fid, geom, hex(zeroblob(4e8)) AS thickness FROM old'),
        ("ALTER TABLE gpkg_contents RENAME TO old",
         f"CREATE VIEW gpkg_contents AS {ENDLESS} SELECT old.* FROM r, old"),
        ("ALTER TABLE gpkg_spatial_ref_sys RENAME TO old",
         "CREATE VIEW gpkg_spatial_ref_sys AS SELECT * FROM old"),
    ],
    ids=["endless", "large", "contents", "systems"],
)  # fmt: skip
def test_views_are_not_evaluated(package, statements):
    change(package, *statements)
    with pytest.raises(InputError, match="is a view, which is not evaluated; save it as a table"):
        read_areas(package)


def test_generated_and_unused_columns_are_not_read(package):
    change(
        package,
        'ALTER TABLE "a" ADD COLUMN thickness_cm AS (length(hex(zeroblob(400000000))))',
        'ALTER TABLE "a" ADD COLUMN photo BLOB',
        'UPDATE "a" SET photo = zeroblob(70000000)',
    )
    (area,) = read_areas(package)
    assert (area.name, area.thickness) == ("A", 0.5)


def test_a_package_with_several_layers_needs_a_choice(tmp_path, package):
    triangle = polygon((0, 0), (5, 0), (5, 5))
    geometries = np.array([shapely.to_wkb(triangle)], dtype=object)
    pyogrio.raw.write(
        *(package, geometries, [], np.array([])), crs="EPSG:25833", geometry_type="Polygon",
        layer="b", append=True,
    )  # fmt: skip
    with pytest.raises(InputError, match=r"has 2 layers: 'a', 'b'; choose one \(`layer=`\)"):
        read_areas(package)
    assert len(read_areas(package, "b")[0].outline) == 3
    assert len(read_areas(package, "a")[0].outline) == 4
    with pytest.raises(InputError, match="has no layer 'c'; it has 'a', 'b'"):
        read_areas(package, "c")
    with pytest.raises(InputError, match="has one layer, 'a'; `layer=` 'b'"):
        read_areas(write_polygons(tmp_path / "a.geojson"), "b")


def test_an_additional_layer_of_points_is_noted(package):
    point = np.array([shapely.to_wkb(shapely.Point(1, 2))], dtype=object)
    pyogrio.raw.write(
        *(package, point, [], np.array([])), crs="EPSG:25833", geometry_type="Point",
        layer="stations", append=True,
    )  # fmt: skip
    with record_notes() as notes:
        assert len(read_areas(package)) == 1
    assert "layer 'a' is read, the only one that may hold polygons" in notes[0]


def test_changes_in_the_log_of_another_program_are_read(package):
    writer = sqlite3.connect(package)
    writer.execute("PRAGMA journal_mode = WAL")
    writer.execute("UPDATE gpkg_contents SET identifier = 'b'")
    for name in writer.execute("SELECT name FROM sqlite_master WHERE type='trigger'").fetchall():
        writer.execute(f'DROP TRIGGER "{name[0]}"')
    writer.execute('UPDATE "a" SET thickness = 0.75')
    writer.commit()
    content_before = {file.name: file.read_bytes() for file in package.parent.iterdir()}
    assert read_areas(package)[0].thickness == 0.75
    assert {file.name: file.read_bytes() for file in package.parent.iterdir()} == content_before
    writer.close()


def test_a_name_that_is_not_text_is_refused(package):
    """SQLite's message contains the name, which is not UTF-8."""
    content = package.read_bytes()
    assert content.count(b"trigger_insert_feature")
    package.write_bytes(content.replace(b"trigger_insert_f", b"trigger_insert_\xe6", 1))
    with pytest.raises(InputError, match="not a GeoPackage that can be read"):
        read_areas(package)


def test_a_hot_journal_is_not_played_back(package):
    journal = package.with_name("a.gpkg-journal")
    journal.write_bytes(b"\xd9\xd5\x05\xf9\x20\xa1\x63\xd7" + bytes(512))
    with pytest.raises(InputError, match="an interrupted write left"):
        read_areas(package)
    assert journal.exists()


def test_deeply_nested_geometries_are_refused(package):
    nested = struct.pack("<BII", 1, 7, 1) * 1_000_000 + struct.pack("<BII", 1, 3, 0)
    for wkb in (nested, struct.pack("<BII", 1, 6, 1) + nested):
        change(package)
        with sqlite3.connect(package) as connection:
            blob = b"GP\0\1" + struct.pack("<i", 25833) + wkb
            connection.execute('UPDATE "a" SET geom = ?', (blob,))
        connection.close()
        with pytest.raises(InputError, match="feature 1: not a polygon"):
            read_areas(package)
