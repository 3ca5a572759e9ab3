"""Polygons of a GeoPackage, read with SQLite from plain tables; computed tables are refused.

Views, triggers, virtual tables and generated columns are programs in the file, and are never run.
"""

from __future__ import annotations

import shutil
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Optional

from snowshed._core import InputError
from snowshed.base.extras import require
from snowshed.base.limits import (
    MAX_CORNERS,
    MAX_GEOPACKAGE_COPY_BYTES,
    MAX_GEOPACKAGE_VALUE_BYTES,
    MAX_LAYERS,
    MAX_POLYGONS,
    MAX_SQL_STEPS,
    MB,
)
from snowshed.base.messages import quoted
from snowshed.base.notes import InputNote, issue_note
from snowshed.io.atomic import replacing
from snowshed.io.coordinates.plain_systems import plain_system
from snowshed.io.coordinates.systems import system_of
from snowshed.io.polygons.layer import PolygonLayer, is_wanted
from snowshed.io.polygons.wkb import count_corners

SQLITE = b"SQLite format 3\0"
#: First bytes of files in which SQLite keeps changes: the write-ahead log and the rollback journal.
LOG = (b"\x37\x7f\x06\x82", b"\x37\x7f\x06\x83")
JOURNAL = (b"\xd9\xd5\x05\xf9\x20\xa1\x63\xd7",)
TABLES = ("gpkg_contents", "gpkg_geometry_columns", "gpkg_spatial_ref_sys")
#: Types of layers that may hold polygons.
SURFACES = (
    *("POLYGON", "MULTIPOLYGON", "GEOMETRY", "GEOMETRYCOLLECTION", "SURFACE"),
    *("CURVEPOLYGON", "MULTISURFACE"),
)
LINES = ("LINESTRING", "MULTILINESTRING", "CURVE", "MULTICURVE")
#: Allowed actions of statements; all others are denied.
ACTIONS = (sqlite3.SQLITE_SELECT, sqlite3.SQLITE_READ, sqlite3.SQLITE_PRAGMA)
FUNCTIONS = ("length", "typeof", "lower", "substr")
#: Bytes that precede a geometry, by the code of its envelope.
ENVELOPES = {0: 8, 1: 40, 2: 56, 3: 56, 4: 72}


def read_geopackage(
    path: Path, layer: Optional[str], option: str, *, lines: bool = False
) -> PolygonLayer:
    """Return the polygons of a layer; see `snowshed.io.polygons.read_layer`."""
    try:
        with _open_read_only(path) as connection:
            return _Package(path, connection, lines=lines).read(layer, option)
    except (sqlite3.Error, UnicodeError, OverflowError) as error:
        why = "reading it takes too long" if "interrupt" in str(error) else str(error)
        raise InputError(f"{path}: not a GeoPackage that can be read: {why}") from None


@contextmanager
def _open_read_only(path: Path) -> Iterator[sqlite3.Connection]:
    """Open a file, with the changes in its log, without writing beside it."""
    with TemporaryDirectory() as folder:
        log = _companion(path, "-wal", LOG)
        if _companion(path, "-journal", JOURNAL) is not None:
            raise InputError(
                f"{path}: an interrupted write left {path.name}-journal; open and close the file "
                "once in the program that wrote it"
            )
        file = path
        if log is not None:  # another program has it open: SQLite would have to write beside it
            file = Path(folder) / "copy.gpkg"
            for source, copy in ((path, file), (log, Path(f"{file}-wal"))):
                if source.stat().st_size > MAX_GEOPACKAGE_COPY_BYTES:
                    raise InputError(f"{path}: open in another program; close it there first")
                with replacing(copy) as beside:
                    shutil.copyfile(source, beside)
        mode = "mode=ro&immutable=1" if log is None else "mode=rw"
        with closing(sqlite3.connect(f"{file.absolute().as_uri()}?{mode}", uri=True)) as connection:
            _restrict(connection)
            yield connection


def _companion(path: Path, ending: str, begin: tuple[bytes, ...]) -> Optional[Path]:
    """Return the file of changes beside a database, if any."""
    file = path.with_name(path.name + ending)
    if not file.is_file():
        return None
    with file.open("rb") as opened:
        return file if opened.read(8).startswith(begin) else None


def _restrict(connection: sqlite3.Connection) -> None:
    steps = 0
    batch = 100_000

    def too_long() -> int:
        nonlocal steps
        steps += batch
        return int(steps > MAX_SQL_STEPS)

    def allows(action: int, first: Optional[str], second: Optional[str], *_: object) -> int:
        if action == sqlite3.SQLITE_FUNCTION:
            return sqlite3.SQLITE_OK if second in FUNCTIONS else sqlite3.SQLITE_DENY
        return sqlite3.SQLITE_OK if action in ACTIONS else sqlite3.SQLITE_DENY

    connection.text_factory = lambda text: text.decode("utf-8", errors="replace")
    connection.set_progress_handler(too_long, batch)
    if hasattr(connection, "setlimit"):  # from Python 3.11 on
        connection.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, MAX_GEOPACKAGE_VALUE_BYTES)
    for setting in ("trusted_schema = OFF", "cell_size_check = ON", "temp_store = MEMORY"):
        connection.execute(f"PRAGMA {setting}")
    connection.set_authorizer(allows)


class _Package:
    """A GeoPackage that is open."""

    def __init__(self, path: Path, connection: sqlite3.Connection, *, lines: bool) -> None:
        self.path = path
        self.lines = lines
        self.connection = connection

    def read(self, layer: Optional[str], option: str) -> PolygonLayer:
        for table in TABLES:
            self._check_table(table)
        table, geometry, system = self._choose(layer, option)
        self._check_table(table)
        types = self._types(table)
        fields = [*types]
        wanted = [field for field in fields if field != geometry and is_wanted(field)]
        shapes, rows = self._features(table, [geometry, *wanted])
        records = [
            {name: _typed(value, types[name]) for name, value in zip(wanted, row)} for row in rows
        ]
        names = [field for field in fields if field != geometry]
        return PolygonLayer(shapes, records, names, self._crs(system))

    def _check_table(self, table: str) -> None:
        """Refuse a name that is not a stored table of the file."""
        entry = self.connection.execute(
            "SELECT type, rootpage FROM sqlite_master WHERE lower(name) = lower(?)", (table,)
        ).fetchone()
        if entry is None:
            raise InputError(f"{self.path}: not a GeoPackage: it has no table {quoted(table)}")
        if entry[0] != "table" or not entry[1]:
            raise InputError(
                f"{self.path}: {quoted(table)} is a {entry[0] if entry[1] == 0 else 'program'}, "
                "which is not evaluated; save it as a table"
            )

    def _choose(self, layer: Optional[str], option: str) -> tuple[str, str, object]:
        """Return table, column of the geometry and coordinate system of the layer to read."""
        every = self.connection.execute(
            "SELECT c.table_name, g.column_name, g.geometry_type_name, g.srs_id FROM gpkg_contents "
            "AS c JOIN gpkg_geometry_columns AS g ON c.table_name = g.table_name "
            "COLLATE NOCASE WHERE c.data_type = 'features' LIMIT ?",
            (MAX_LAYERS + 1,),
        ).fetchall()
        if len(every) > MAX_LAYERS:
            raise InputError(f"{self.path}: more than {MAX_LAYERS} layers")
        names = ", ".join(quoted(str(row[0])) for row in every[:20])
        if layer is not None:
            matching = [row for row in every if row[0] == layer]
            if not matching:
                raise InputError(
                    f"{self.path}: has no layer {quoted(layer)}; it has {names or 'none'}"
                )
            return str(matching[0][0]), str(matching[0][1]), matching[0][3]
        types = SURFACES + LINES if self.lines else SURFACES
        noun = "lines or polygons" if self.lines else "polygons"
        readable = [row for row in every if str(row[2]).upper() in types]
        if not readable:
            raise InputError(f"{self.path}: holds no layer of {noun}")
        if len(readable) > 1:
            raise InputError(
                f"{self.path}: has {len(every)} layers: {names}; choose one ({option})"
            )
        if len(every) > 1:
            issue_note(
                f"{self.path}: layer {quoted(str(readable[0][0]))} is read, the only one that "
                f"may hold {noun}; the layers are {names}",
                InputNote,
            )
        return str(readable[0][0]), str(readable[0][1]), readable[0][3]

    def _types(self, table: str) -> dict[str, str]:
        """Return the stored columns of a table, and their types."""
        columns = self.connection.execute(f"PRAGMA table_xinfo({_name(table)})").fetchall()
        return {str(name): str(kind) for _, name, kind, _, _, _, hidden in columns if not hidden}

    def _features(self, table: str, columns: Sequence[str]) -> tuple[list[Any], list[Any]]:
        """Return the geometries, and the rows of the other columns."""
        shapely: Any = require("shapely", "terrain", "reading polygons")
        names = ", ".join(map(_name, columns))
        # An index may contain expressions, which SQLite would evaluate.
        rows = self.connection.execute(f"SELECT {names} FROM {_name(table)} NOT INDEXED")
        geometries: list[Optional[bytes]] = []
        others, corners, room = [], 0, MAX_GEOPACKAGE_VALUE_BYTES
        for number, row in enumerate(rows, 1):
            if number > MAX_POLYGONS:
                raise InputError(f"{self.path}: more than {MAX_POLYGONS} polygons")
            where = f"{self.path}, feature {number}"
            wkb = _wkb(row[0], where)
            if wkb is not None:
                corners += count_corners(wkb, where, lines=self.lines)
            if corners > MAX_CORNERS:
                raise InputError(
                    f"{self.path}: more than {MAX_CORNERS} corners; simplify the outlines"
                )
            room -= sum(len(value) for value in row if isinstance(value, (bytes, str)))
            if room < 0:
                raise InputError(
                    f"{self.path}: more than {MAX_GEOPACKAGE_VALUE_BYTES // MB} MB of polygons"
                )
            geometries.append(wkb)
            others.append(row[1:])
        try:
            return list(shapely.from_wkb(geometries)), others
        except shapely.errors.ShapelyError as error:
            raise InputError(f"{self.path}: a geometry is damaged: {error}") from None

    def _crs(self, system: object) -> str:
        row = self.connection.execute(
            "SELECT organization, organization_coordsys_id, definition FROM gpkg_spatial_ref_sys "
            "WHERE srs_id = ?",
            (system,),
        ).fetchone()
        if row is None:
            raise InputError(f"{self.path}: does not describe its coordinate system {system}")
        organization, number, definition = row
        plain = plain_system(str(definition))
        if str(organization).upper() == "EPSG" and isinstance(number, int):
            code = f"EPSG:{number}"
            return code if not plain or system_of(code) is not None else plain
        if "undefined" in str(definition).lower()[:60]:
            return ""
        if not plain:
            raise InputError(f"{self.path}: its coordinate system {system} is not supported")
        return plain


def _typed(value: object, kind: str) -> object:
    """Return a value; SQLite stores truth values as 0 and 1, which are no numbers.

    Examples
    --------
    >>> _typed(1, "BOOLEAN"), _typed(1, "INTEGER"), _typed(None, "BOOLEAN")
    (True, 1, None)
    """
    return bool(value) if kind.upper() == "BOOLEAN" and isinstance(value, int) else value


def _name(text: str) -> str:
    """Return a name in SQL's quotes."""
    return '"' + text.replace('"', '""') + '"'


def _wkb(value: object, where: str) -> Optional[bytes]:
    """Return the geometry in a value of a GeoPackage, if any."""
    if value is None:
        return None
    if not isinstance(value, bytes) or value[:2] != b"GP" or len(value) < 8:
        raise InputError(f"{where}: not a GeoPackage geometry")
    flags = value[3]
    begin = ENVELOPES.get(flags >> 1 & 7)
    if begin is None or flags & 0x20:
        raise InputError(f"{where}: its geometry type is unknown")
    return value[begin:]
