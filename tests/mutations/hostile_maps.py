"""Maps, polygons and projects that try to do harm."""

from __future__ import annotations

import json
import os
import random
import shutil
import sqlite3
import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import good_files
from helpers.slide_files import box, plane, write_project
from mutate import mutated

from snowshed.io.raster.raster import write_ascii_grid

ENDINGS = (".gpkg", ".shp", ".geojson")
SECRET = b"a secret that stands outside"
Chance = random.Random


@dataclass(frozen=True)
class Attack:
    """A folder for hostile files, targets that nothing may reach, and random numbers."""

    folder: Path
    address: str
    outside: Path
    chance: Chance

    def target(self) -> str:
        """Return a target that nothing may reach."""
        server = self.address.removeprefix("http://")
        return self.chance.choice(
            [
                f"{self.address}/a.gpkg", f"/vsicurl/{self.address}/a.gpkg",
                f"/vsicurl_streaming/{self.address}/a.shp",
                f"/vsizip//vsicurl/{self.address}/a.zip",
                f"/vsis3/bucket/{server}", f"WFS:{self.address}", f"file://{self.outside}/a.gpkg",
                f"PG:host=127.0.0.1 port={server.rpartition(':')[2]}", f"{self.outside}/a.gpkg",
                f"{self.outside}/a.prj", f"../{self.outside.name}/a.geojson",
                f"//{server}/share/a.shp", f"/vsisubfile/0,{self.outside}/a.gpkg",
                f"/vsigzip/{self.outside}/a.gpkg", f"ogrvrt:{self.outside}/a.gpkg",
            ]
        )  # fmt: skip

    def large(self) -> int:
        """Return a large count; some exceed the limits."""
        return self.chance.choice([1000, 49_999, 60_000, 300_000])

    def number(self) -> str:
        """Return a text instead of a number, or an extreme number."""
        return self.chance.choice(
            ["nan", "inf", "-inf", "1e400", "1e308", "-1", "0", "1e-300", "1e-12", "5e-324", "",
             "9" * 400, "9" * 5000, "0x1p3", "1_0", "\x1b[31m", "1|2", "0:1e-9", "0:inf", "1e300",
             "0:0", "0:-1", ":", "|", "1:2:3", "True", "None", "%(a)s", "${a}", "0.1", "2", "x",
             "\u0661"]
        )  # fmt: skip


# --- polygons -----------------------------------------------------------------------------------


def descriptions(t: Attack) -> Path:
    """Write a file that refers to another source, with an ending that readers open."""
    target, chance = t.target(), t.chance
    layer = f'<OGRVRTLayer name="a"><SrcDataSource>{target}</SrcDataSource></OGRVRTLayer>'
    vrt = f"<OGRVRTDataSource>{layer}</OGRVRTDataSource>"
    sql = f"<SrcSQL dialect='sqlite'>SELECT * FROM '{target}'.a</SrcSQL>"
    text = chance.choice(
        [
            vrt, vrt.replace("</OGRVRTLayer>", f"{sql}</OGRVRTLayer>"),
            f"<OGRVRTDataSource><OGRVRTUnionLayer name='u'>{layer}</OGRVRTUnionLayer>"
            "</OGRVRTDataSource>",
            f"<OGRVRTDataSource><OGRVRTWarpedLayer>{layer}<TargetSRS>{target}</TargetSRS>"
            "</OGRVRTWarpedLayer></OGRVRTDataSource>",
            f"<OGRWFSDataSource><URL>{target}</URL></OGRWFSDataSource>",
            json.dumps({"type": "gdal_streamed_alg", "command_line": f"gdal vector read {target}"}),
            json.dumps({"links": [{"href": target, "rel": "data"}], "conformsTo": [target]}),
            json.dumps({"type": "FeatureCollection", "features": [], "next": target, "note": vrt}),
            f"<!DOCTYPE a [<!ENTITY b SYSTEM '{target}'>]><gml:FeatureCollection>&b;</gml:x>",
            f"<kml><NetworkLink><Link><href>{target}</href></Link></NetworkLink></kml>",
            f"<VRTDataset><SourceFilename>{target}</SourceFilename></VRTDataset>", target,
            f"{target}\n{vrt}",
        ]
    )  # fmt: skip
    prefix = chance.choice(
        ["", " ", "\ufeff", "\n" * 2000, '{"a": 1}\n', "<?xml version='1.0'?>\n"]
    )
    content = (prefix + text).encode()
    if chance.random() < 0.3:  # after the first bytes of a format that is read
        content = chance.choice([b"\0\0\x27\x0a" + bytes(20), b"SQLite format 3\0"]) + content
    file = t.folder / f"a{chance.choice(ENDINGS)}"
    file.write_bytes(content)
    for companion in (".shx", ".dbf", ".prj"):
        file.with_suffix(companion).write_text(vrt if companion != ".prj" else target)
    return file


def geojson_of(t: Attack, rings: Any = None, crs: Any = None, **fields: Any) -> Path:
    feature = {
        "type": "Feature",
        "properties": {"thickness": 0.5, **fields},
        "geometry": {"type": "Polygon", "coordinates": rings or box(10, 10, 30, 30)},
    }
    crs = crs or {"type": "name", "properties": {"name": "EPSG:31287"}}
    data = {"type": "FeatureCollection", "crs": crs, "features": [feature]}
    (t.folder / "a.geojson").write_text(json.dumps(data))
    return t.folder / "a.geojson"


def systems_of_geojson(t: Attack) -> Path:
    target = t.chance.choice(
        [t.target(), f"+init={t.target()}", f"+proj=utm +nadgrids={t.target()}"]
    )
    kind = t.chance.choice(["name", "link", "EPSG", "OGC", None, 1])
    key = t.chance.choice(["name", "href", "code", "urn"])
    crs: Any = {"type": kind, "properties": {key: target, "type": "proj4"}}
    return geojson_of(
        t, crs=t.chance.choice([crs, target, [crs], {"type": kind}, {"properties": target}])
    )


def counts_of_geojson(t: Attack) -> Path:
    count = t.large()
    kind = t.chance.randrange(9)
    ring = [[10 + k / count, 10 + (k * k % 97) / 9] for k in range(count)]
    if kind == 0:
        return geojson_of(t, [ring])
    if kind == 1:
        return geojson_of(t, box(10, 10, 30, 30) * count)
    if kind == 2:
        return geojson_of(t, **{f"p{k}": k for k in range(count)})
    if kind == 3:
        return geojson_of(t, name="n" * (10 * count), thickness="9" * count)
    if kind == 4:
        return geojson_of(t, [[[[]] * count]])
    file = geojson_of(t)
    text = file.read_text()
    if kind == 5:
        text = "[" * count + text
    elif kind == 6:
        text = text.replace('"EPSG:31287"', '"' + "a" * 10 * count + '"')
    elif kind == 7:
        text = text.replace("[10, 10]", f"[{'9' * count}, 10]")
    else:
        text = text.replace('"features": [', '"features": [' + "{}," * count)
    file.write_text(text)
    return file


def package(t: Attack) -> Path:
    return good_files.polygons(".gpkg")(t.folder)


ENDLESS = "WITH RECURSIVE r(n) AS (SELECT 1 UNION ALL SELECT n + 1 FROM r)"


def programs_of_packages(t: Attack) -> Path:
    file = package(t)
    with sqlite3.connect(file) as connection:
        names = connection.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'")
        for (name,) in names.fetchall():
            connection.execute(f'DROP TRIGGER "{name}"')
        (table,) = connection.execute("SELECT table_name FROM gpkg_contents").fetchone()
        victim = t.chance.choice(
            [table, "gpkg_contents", "gpkg_geometry_columns", "gpkg_spatial_ref_sys"]
        )
        for statement in t.chance.choice(
            [
                [f'ALTER TABLE "{victim}" RENAME TO old',
                 f'CREATE VIEW "{victim}" AS {ENDLESS} SELECT old.* FROM r, old'],
                [f'ALTER TABLE "{victim}" RENAME TO old',
                 f'CREATE VIEW "{victim}" AS SELECT *, hex(zeroblob(400000000)) AS thick FROM old'],
                [f'ALTER TABLE "{table}" ADD COLUMN thick_cm AS (hex(zeroblob(400000000)))'],
                [f'ALTER TABLE "{table}" ADD COLUMN name_b BLOB',
                 f'UPDATE "{table}" SET name_b = zeroblob({100 * t.large()})'],
                [f'UPDATE "{table}" SET thickness = "{t.number()[:50]}"'],
                [f"UPDATE gpkg_contents SET table_name = '{t.target()}'"],
                [f"UPDATE gpkg_geometry_columns SET column_name = '{t.number()[:50]}'"],
                [f"UPDATE gpkg_geometry_columns SET srs_id = '{t.number()[:50]}'"],
                ["UPDATE gpkg_spatial_ref_sys SET organization = 'x', "
                 f"organization_coordsys_id = 0, definition = '{t.target()}'"],
                [f"CREATE TRIGGER a AFTER INSERT ON gpkg_contents BEGIN SELECT '{victim}'; END"],
                [f"INSERT INTO gpkg_contents (table_name, data_type, identifier) {ENDLESS} "
                 f"SELECT 'a' || n, 'features', n FROM r LIMIT {t.large() // 10}"],
                ['CREATE VIRTUAL TABLE v USING fts5(geom, thickness, name)',
                 "UPDATE gpkg_contents SET table_name = 'v'",
                 "UPDATE gpkg_geometry_columns SET table_name = 'v'"],
                *[[f'CREATE INDEX i{k} ON "{table}" (length(geom), name, thickness, geom)']
                  for k in range(2)],
            ]
        ):  # fmt: skip
            try:
                connection.execute(statement)
            except sqlite3.Error:
                continue  # not supported by this release of SQLite
    connection.close()
    if t.chance.random() < 0.2:
        file.with_name(f"{file.name}-wal").write_bytes(
            b"\x37\x7f\x06\x82" + t.chance.randbytes(900)
        )
    if t.chance.random() < 0.1:
        text = b"\xd9\xd5\x05\xf9\x20\xa1\x63\xd7" + bytes(504) + str(t.outside / "a.prj").encode()
        file.with_name(f"{file.name}-journal").write_bytes(text)
    return file


def geometries_of_packages(t: Attack) -> Path:
    file, chance = package(t), t.chance
    head = b"GP" + bytes([chance.randrange(2), chance.choice([1, 3, 5, 9, 11, 33, 255])])
    huge = chance.choice([0, 1, 1000, 2**31 - 1, 2**32 - 1])
    kind = chance.choice([1, 2, 3, 6, 7, 8, 10, 12, 15, 1003, 2006, 3003, 0x80000003, 0x20000006])
    nested = struct.pack("<BII", 1, chance.choice([6, 7]), 1) * chance.choice([1, 1000, 1_000_000])
    body = chance.choice([nested, b"", struct.pack("<BII", 1, kind, huge)])
    body += struct.pack("<BIII", 1, 3, huge, huge) + chance.randbytes(chance.choice([0, 100, 9000]))
    blob = head + struct.pack("<i", 31287) + bytes(chance.choice([0, 32, 48])) + body
    with sqlite3.connect(file) as connection:
        names = connection.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'")
        for (name,) in names.fetchall():
            connection.execute(f'DROP TRIGGER "{name}"')
        (table,) = connection.execute("SELECT table_name FROM gpkg_contents").fetchone()
        connection.execute(f'UPDATE "{table}" SET geom = ?', (blob,))
    connection.close()
    return file


def shapefile(t: Attack) -> Path:
    return good_files.polygons(".shp")(t.folder)


def false_numbers_of_shapefiles(t: Attack) -> Path:
    file, chance = shapefile(t), t.chance
    part = file.with_suffix(chance.choice([".shp", ".shx", ".dbf"]))
    content = bytearray(part.read_bytes())
    for _ in range(chance.choice([1, 2, 5])):
        offset = chance.randrange(len(content) - 4)
        value = chance.choice([0, 1, 2**31 - 1, 2**32 - 1, 2**16, chance.randrange(2**32)])
        content[offset : offset + 4] = struct.pack(chance.choice("<>") + "I", value)
    if chance.random() < 0.3:
        content += bytes(content[100:]) * chance.choice([10, 20_000])
    part.write_bytes(content)
    return file


def companions_of_shapefiles(t: Attack) -> Path:
    file, chance = shapefile(t), t.chance
    ending = chance.choice([".prj", ".cpg", ".dbf", ".shx", ".qix", ".sbn", ".idm", ".shp.xml"])
    part = file.with_name(file.stem + ending)
    part.unlink(missing_ok=True)
    content = chance.randrange(4)
    if content == 0:
        os.mkfifo(part)
    elif content == 1:
        part.symlink_to(chance.choice(["/dev/zero", "/", "nowhere", "/proc/self/mem"]))
    elif content == 2:
        part.write_text(t.target() * chance.choice([1, 10_000]))
    else:
        part.write_bytes(chance.randbytes(chance.choice([0, 1, 33, 5000])))
    return file


def changed(ending: str) -> Callable[[Attack], Path]:
    def make(t: Attack) -> Path:
        file = good_files.polygons(ending)(t.folder)
        file.write_bytes(mutated(file.read_bytes(), t.chance.randrange(10**6)))
        return file

    return make


# --- maps and projects --------------------------------------------------------------------------


def systems_of_grids(t: Attack) -> Path:
    write_ascii_grid(t.folder / "a.asc", plane(columns=8, rows=6))
    words = t.chance.choice(
        [t.target(), f"+init={t.target()}", f"+proj=utm +zone=33 +nadgrids={t.target()}",
         'PROJCS["a",' * t.chance.choice([1, 5000]), "[" * 60_000, "EPSG:" + t.number(),
         f'GEOGCS["a",EXTENSION["PROJ4","+init={t.target()}"]]', f"ESRI::{t.target()}",
         f'{{"type": "ProjectedCRS", "name": "{t.target()}"}}', "\0" * t.large(), "a" * 10**6]
    )  # fmt: skip
    (t.folder / t.chance.choice(["a.prj", "a.PRJ"])).write_text(words)
    return t.folder / "a.asc"


def descriptions_of_rasters(t: Attack) -> Path:
    target = t.target()
    source = f"<SimpleSource><SourceFilename>{target}</SourceFilename></SimpleSource>"
    band = f'<VRTRasterBand dataType="Float32" band="1">{source}</VRTRasterBand>'
    text = t.chance.choice(
        [f'<VRTDataset rasterXSize="9" rasterYSize="9">{band}</VRTDataset>', target,
         f"<GDAL_WMS><Service name='TMS'><ServerUrl>{target}</ServerUrl></Service></GDAL_WMS>",
         f"<WCS_GDAL><ServiceURL>{target}</ServiceURL></WCS_GDAL>", f"GTIFF_DIR:1:{target}",
         json.dumps({"type": "FeatureCollection", "links": [{"href": target}]})]
    )  # fmt: skip
    if t.chance.random() < 0.5:
        file = good_files.geotiff(t.folder)
        suffix = t.chance.choice([".msk", ".ovr", ".aux.xml"])
        (t.folder / f"{file.name}{suffix}").write_text(text)
        return file
    (t.folder / "a.tif").write_text(text)
    return t.folder / "a.tif"


KEYS = (
    "dt", "rho", "meshCellSize", "deltaTh", "muvoellmy", "tEnd", "tSteps", "relTh", "entTh",
    "simTypeList", "resType", "releaseScenario", "sphKernelRadius", "stopCrit", "relThFromFile",
    "frictModel", "cohesionMaxStrain", "thresholdMassSplit", "dam", "seed", "dtHyd", "gravAcc",
)  # fmt: skip


def inis(t: Attack) -> Path:
    lines = [f"{t.chance.choice(KEYS)} = {t.number()}" for _ in range(t.chance.choice([1, 2, 4]))]
    if t.chance.random() < 0.2:
        lines.append(t.chance.choice(["[DEFAULT]", f"[{t.target()}]", "a" * 10**6, " x\n" * 10**5]))
    return write_project(t.folder / "project", "\n".join(dict.fromkeys(lines)) + "\n")


def links(t: Attack) -> Path:
    project = write_project(t.folder / "project", "tEnd = 0.1\n")
    inputs, chance = project / "Inputs", t.chance
    link = inputs / chance.choice(
        ["LINES", "REL/b.geojson", "REL/rel.prj", "ENT", "RES/r.shp", "readme.txt", "dem.prj",
         "CFGs", "dem.asc", "com5SnowSlideCfg.ini", "../local_com5SnowSlideCfg.ini",
         "SECREL/a.gpkg", "x.csv"]
    )  # fmt: skip
    link.parent.mkdir(exist_ok=True)
    if link.is_dir():
        shutil.rmtree(link)
    link.unlink(missing_ok=True)
    target = chance.choice(
        ["/", "/dev/zero", "/etc", "/proc/self", str(t.outside), str(t.outside / "a.geojson"),
         f"../../../{t.outside.name}/a.prj", "..", ".", "nowhere", link.name, "/dev/stdin"]
    )  # fmt: skip
    if chance.random() < 0.2:
        os.mkfifo(link)
    else:
        link.symlink_to(target)
    return project


def names(t: Attack) -> Path:
    project = write_project(t.folder / "project", "tEnd = 0.1\n")
    rel = project / "Inputs/REL"
    name = t.chance.choice(
        ["\x1b[31mred", "a\nb", "\u202egpj", "a" * 240, "%s%n", "$(id)", "-o", "a;b", "=1+1",
         "\udcff", "<script>", "..", "a\tb", "x", "zip!a", "http:a", "vsicurl", "\x9b31m"]
    )  # fmt: skip
    (rel / "rel.geojson").rename(rel / f"{name}.geojson")
    if t.chance.random() < 0.3:
        folder = project / "Inputs" / "/".join(["deep"] * t.chance.choice([3, 20, 200]))
        folder.mkdir(parents=True)
    return project


def projects_with(make: Callable[[Attack], Path]) -> Callable[[Attack], Path]:
    """Put hostile polygons into a project's folder of release areas."""

    def make_project(t: Attack) -> Path:
        project = write_project(t.folder / "project", "tEnd = 0.1\n")
        rel = project / "Inputs/REL"
        shutil.rmtree(rel)
        rel.mkdir()
        make(Attack(rel, t.address, t.outside, t.chance))
        return project

    return make_project


MAKERS: dict[str, Callable[[Attack], Path]] = {
    "descriptions": descriptions,
    "systems of geojson": systems_of_geojson,
    "counts of geojson": counts_of_geojson,
    "programs of packages": programs_of_packages,
    "geometries of packages": geometries_of_packages,
    "lies of shapefiles": false_numbers_of_shapefiles,
    "companions of shapefiles": companions_of_shapefiles,
    "changed geojson": changed(".geojson"),
    "changed gpkg": changed(".gpkg"),
    "changed shp": changed(".shp"),
    "systems of grids": systems_of_grids,
    "descriptions of rasters": descriptions_of_rasters,
    "inis": inis,
    "links": links,
    "names": names,
    "descriptions in projects": projects_with(descriptions),
    "packages in projects": projects_with(programs_of_packages),
    "shapefiles in projects": projects_with(companions_of_shapefiles),
}
