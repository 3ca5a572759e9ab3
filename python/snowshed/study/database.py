"""The database of a store of studies: its tables, and how it is opened and changed.

Every change is one transaction with a write-ahead log that is flushed to the disk (WAL, FULL).

=============== ========================================================================
study           name, and its axes (JSON list of dotted paths)
study_run       the runs of each study, in order; studies may share runs
run             content hash, version, complete scene (JSON), status, error, owner, whether its
                particles are stored, the build that computes it (empty: unknown), and the notes
                on its results (JSON list; empty: none, or unknown)
event           measures after each event of a run: the columns of all methods
event_timing    wall time of each event, apart, because it differs when a run is repeated
event_particles packed particles after each event, or maps of slides, of runs that store them
run_timing      wall time of each run, and the machine that computed it
checksum        checksums of the other tables (see `snowshed.study.checksums`)
=============== ========================================================================
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from snowshed._core import InputError
from snowshed.methods.registry import DEFAULT, METHODS
from snowshed.study import checksums
from snowshed.study.errors import StudyError
from snowshed.study.locks import owner_lives

FILE = "store.sqlite"
RUNNING = "running"
APPLICATION = 0x534E4F57  # "SNOW": distinguishes our databases from others
#: Version 1 is from before there were checksums, or from an older process in the same store.
VERSIONS = (1, 2)
BUSY_S = 60.0  # s to wait for another process that is writing

SQL_TYPES: Mapping[type, str] = {int: "INTEGER", float: "REAL", str: "TEXT"}

#: Columns of each method's measures after an event: int, float or str.
MEASURE_COLUMNS: Mapping[str, Mapping[str, type]] = {
    name: method.run_class().COLUMNS for name, method in METHODS.items()
}
#: Columns of all methods, with their types in the store.
STORED_TYPES: Mapping[str, str] = {
    name: SQL_TYPES[kind] for columns in MEASURE_COLUMNS.values() for name, kind in columns.items()
}
#: Columns of the default method.
MEASURED_TYPES: Mapping[str, str] = {name: STORED_TYPES[name] for name in MEASURE_COLUMNS[DEFAULT]}
#: Facts about the computing of a run.
TIMING: Mapping[str, str] = {
    "run_wall_s": "REAL",
    "threads": "INTEGER",
    "particles": "INTEGER",
    "particle_updates": "INTEGER",
    "peak_memory_mb": "REAL",
    "host": "TEXT",
    "cpu": "TEXT",
    "finished": "TEXT",
}


def _columns(types: Mapping[str, str]) -> str:
    return ", ".join(f"{name} {kind}" for name, kind in types.items())


PARTICLES_TABLE = (
    "CREATE TABLE IF NOT EXISTS event_particles (hash TEXT NOT NULL REFERENCES run,"
    " event INTEGER NOT NULL, data BLOB NOT NULL, PRIMARY KEY (hash, event))"
)
#: Columns of the table ``run`` that stores of earlier versions lack.
ADDED_TO_RUN: Mapping[str, str] = {
    "keep_particles": "INTEGER NOT NULL DEFAULT 0",
    "build": "TEXT NOT NULL DEFAULT ''",
    "notes": "TEXT NOT NULL DEFAULT ''",
}
TABLES = (
    "CREATE TABLE study (name TEXT PRIMARY KEY, axes TEXT NOT NULL)",
    "CREATE TABLE run (hash TEXT PRIMARY KEY, version TEXT NOT NULL, scene TEXT NOT NULL,"
    " status TEXT NOT NULL DEFAULT 'pending' CHECK (status IN ('pending', 'done', 'failed')),"
    " error TEXT, owner TEXT, keep_particles INTEGER NOT NULL DEFAULT 0,"
    " build TEXT NOT NULL DEFAULT '', notes TEXT NOT NULL DEFAULT '')",
    "CREATE INDEX run_owner ON run (owner) WHERE owner IS NOT NULL",
    "CREATE TABLE study_run (study TEXT NOT NULL REFERENCES study, position INTEGER NOT NULL,"
    " hash TEXT NOT NULL REFERENCES run, PRIMARY KEY (study, position)) WITHOUT ROWID",
    f"CREATE TABLE event (hash TEXT NOT NULL REFERENCES run, event INTEGER NOT NULL,"
    f" {_columns(STORED_TYPES)}, PRIMARY KEY (hash, event)) WITHOUT ROWID",
    "CREATE TABLE event_timing (hash TEXT NOT NULL REFERENCES run, event INTEGER NOT NULL,"
    " wall_s REAL, PRIMARY KEY (hash, event)) WITHOUT ROWID",
    PARTICLES_TABLE,
    checksums.TABLE,
    f"CREATE TABLE run_timing (hash TEXT PRIMARY KEY REFERENCES run, {_columns(TIMING)})",
)


def connect(folder: Path) -> sqlite3.Connection:
    """Open the database and create missing tables; no other process may do so at the same time."""
    if not (folder / FILE).exists() and any(folder.iterdir()):
        raise InputError(f"{folder}: not empty, but holds no study; choose a new folder")
    with translate_errors(folder):
        connection = sqlite3.connect(folder / FILE, timeout=BUSY_S, isolation_level=None)
        try:
            connection.execute("PRAGMA journal_mode = WAL")
            connection.execute("PRAGMA synchronous = FULL")
            with transaction(connection):
                _provide_tables(connection, folder)
        except BaseException:
            connection.close()
            raise
    _provide_running(folder / RUNNING)
    return connection


def _provide_running(folder: Path) -> None:
    """Make the folder of runs; links are refused, because they could lead out of the store."""
    if folder.is_symlink():
        raise InputError(f"{folder}: a link; it must be a folder of the store itself")
    folder.mkdir(exist_ok=True)


def connect_read_only(folder: Path) -> sqlite3.Connection:
    """Open the database in a folder without write access, which no process can change."""
    log = folder / f"{FILE}-wal"
    if log.exists() and log.stat().st_size > 0:
        raise InputError(
            f"{folder}: read-only, and left in the middle of a change; copy it to a writable folder"
        )
    with translate_errors(folder):
        address = f"{(folder / FILE).as_uri()}?mode=ro&immutable=1"
        connection = sqlite3.connect(address, uri=True, isolation_level=None)
        try:
            _check_format(connection, folder)
        except BaseException:
            connection.close()
            raise
    return connection


def _provide_tables(connection: sqlite3.Connection, folder: Path) -> None:
    application = _pragma(connection, "application_id")
    if not application and not connection.execute("SELECT * FROM sqlite_master").fetchone():
        for table in TABLES:
            connection.execute(table)
        connection.execute(f"PRAGMA application_id = {APPLICATION}")
        connection.execute(f"PRAGMA user_version = {VERSIONS[-1]}")
    _check_format(connection, folder)
    _upgrade(connection, folder)


def _check_format(connection: sqlite3.Connection, folder: Path) -> None:
    if _pragma(connection, "application_id") != APPLICATION:
        raise InputError(f"{folder / FILE}: not a store of studies")
    if _pragma(connection, "user_version") not in VERSIONS:
        raise InputError(f"{folder / FILE}: made by another version of snowshed")
    if _pragma(connection, "user_version") == VERSIONS[-1] and not _has_checksums(connection):
        raise InputError(f"{folder / FILE}: damaged: the table of checksums is missing")


def _has_checksums(connection: sqlite3.Connection) -> bool:
    return bool(connection.execute("PRAGMA table_info(checksum)").fetchone())


def _upgrade(connection: sqlite3.Connection, folder: Path) -> None:
    """Add the missing tables to a store of an earlier version; earlier versions then refuse it.

    An earlier version that still computes in it would add results without checksums.
    """
    has_checksums = _has_checksums(connection)
    if _pragma(connection, "user_version") < VERSIONS[-1]:
        owners = connection.execute("SELECT DISTINCT owner FROM run WHERE owner IS NOT NULL")
        if not any(owner_lives(folder / RUNNING, str(owner)) for (owner,) in owners.fetchall()):
            connection.execute(f"PRAGMA user_version = {VERSIONS[-1]}")
        elif not has_checksums:
            raise InputError(
                f"{folder}: an earlier version of snowshed is computing in it; wait for its "
                "end, or stop it"
            )
    present = {row[1] for row in connection.execute("PRAGMA table_info(event)")}
    for name in STORED_TYPES.keys() - present:
        connection.execute(f"ALTER TABLE event ADD COLUMN {name} {STORED_TYPES[name]}")
    connection.execute(PARTICLES_TABLE)
    present = {row[1] for row in connection.execute("PRAGMA table_info(run)")}
    for name, kind in ADDED_TO_RUN.items():
        if name not in present:
            connection.execute(f"ALTER TABLE run ADD COLUMN {name} {kind}")
    if not has_checksums:
        connection.execute(checksums.TABLE)
        checksums.store_all_checksums(connection)


def _pragma(connection: sqlite3.Connection, name: str) -> int:
    return int(connection.execute(f"PRAGMA {name}").fetchone()[0])


@contextmanager
def transaction(connection: sqlite3.Connection) -> Iterator[sqlite3.Connection]:
    """Make all changes of the block, or none."""
    connection.execute("BEGIN IMMEDIATE")
    try:
        yield connection
        connection.execute("COMMIT")
    except BaseException:
        if connection.in_transaction:
            connection.execute("ROLLBACK")
        raise


@contextmanager
def translate_errors(folder: Path) -> Iterator[None]:
    """Turn errors of the database into errors that tell users their remedy."""
    try:
        yield
    except (sqlite3.Error, UnicodeDecodeError) as error:  # SQLite quotes damaged text
        raise StudyError(f"{folder / FILE}: {error}") from None
