"""The store of studies: an SQLite database that survives any end of the processes that use it.

Every change is one transaction with a write-ahead log that is flushed to the disk (WAL, FULL).

============= ==========================================================================
study         name, and its axes (JSON list of dotted paths)
study_run     the runs of each study, in order; studies may share runs
run           content hash, version, complete scene (JSON), status, error, and who computes it
event         what was measured after each event of a run: the columns of events.csv
event_timing  wall time of each event, apart, since it differs whenever a run is repeated
run_timing    wall time of each run, and what computed it
============= ==========================================================================

The status of a run is pending, done or failed. Its owner, while it is being computed, is the name
of a lock in the folder ``running`` (see `snowshed.study.owner`).
"""

from __future__ import annotations

import json
import os
import sqlite3
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.io.json_file import check_values, parse_object
from snowshed.run.results import EVENT_COLUMNS, WORDS
from snowshed.scene.scene import PathLike
from snowshed.study.errors import StudyError
from snowshed.study.locks import holding
from snowshed.study.outcome import Outcome
from snowshed.study.scene_hash import Run

FILE = "store.sqlite"
RUNNING = "running"
APPLICATION = 0x534E4F57  # "SNOW": tells our databases from others
VERSION = 1
NO_STUDY = "holds no study; start one with `snowshed study run`"
BUSY_S = 60.0  # s to wait for another process that is writing

COUNTS = ("steps",)
#: What is measured after an event, with the type it has in the store.
MEASURED_TYPES: Mapping[str, str] = {
    name: "INTEGER" if name in COUNTS else "TEXT" if name in WORDS else "REAL"
    for name in EVENT_COLUMNS
    if name not in ("event", "wall_s")
}
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


TABLES = (
    "CREATE TABLE study (name TEXT PRIMARY KEY, axes TEXT NOT NULL)",
    "CREATE TABLE run (hash TEXT PRIMARY KEY, version TEXT NOT NULL, scene TEXT NOT NULL,"
    " status TEXT NOT NULL DEFAULT 'pending' CHECK (status IN ('pending', 'done', 'failed')),"
    " error TEXT, owner TEXT)",
    "CREATE INDEX run_owner ON run (owner) WHERE owner IS NOT NULL",
    "CREATE TABLE study_run (study TEXT NOT NULL REFERENCES study, position INTEGER NOT NULL,"
    " hash TEXT NOT NULL REFERENCES run, PRIMARY KEY (study, position)) WITHOUT ROWID",
    f"CREATE TABLE event (hash TEXT NOT NULL REFERENCES run, event INTEGER NOT NULL,"
    f" {_columns(MEASURED_TYPES)}, PRIMARY KEY (hash, event)) WITHOUT ROWID",
    "CREATE TABLE event_timing (hash TEXT NOT NULL REFERENCES run, event INTEGER NOT NULL,"
    " wall_s REAL, PRIMARY KEY (hash, event)) WITHOUT ROWID",
    f"CREATE TABLE run_timing (hash TEXT PRIMARY KEY REFERENCES run, {_columns(TIMING)})",
)


@dataclass(frozen=True)
class StoredRun:
    """A run as the store knows it; see the table ``run``."""

    hash: str
    version: str
    scene: str
    status: str
    error: Optional[str]
    owner: Optional[str]


#: What tells a complete scene from anything else that a damaged store may hold.
WHOLE_SCENE = {"dimension": float, "seeding": dict, "numerics": dict, "events": dict}
RUN_COLUMNS = ", ".join(f"run.{name}" for name in StoredRun.__annotations__)


class Store:
    """The store in a folder; use `create` or `open`, and `close` it (or use it in ``with``).

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed import Scene
    >>> run = Run.of(Scene.preset("lab-50").resolve())
    >>> with TemporaryDirectory() as folder, Store.create(folder) as store:
    ...     store.register("lab", [], [run])
    ...     store.claim(run.hash, "me"), store.claim(run.hash, "somebody else")
    (True, False)
    """

    def __init__(self, folder: Path, connection: sqlite3.Connection) -> None:
        self.folder = folder
        self._connection = connection

    @classmethod
    def create(cls, folder: PathLike) -> Store:
        """Open the store in a folder, which is made if need be.

        Raises
        ------
        InputError
            If the folder holds other things.
        StudyError
            If the store cannot be used.
        """
        folder = Path(folder).absolute()
        if folder.exists() and not folder.is_dir():
            raise InputError(f"{folder}: not a folder")
        with holding(folder, _make_folder):
            return cls(folder, _connect(folder))

    @classmethod
    def open(cls, folder: PathLike) -> Store:
        """Open the store that is in a folder; where that cannot be written, for reading.

        Raises
        ------
        InputError
            If there is none.
        StudyError
            If the store cannot be used.
        """
        folder = Path(folder).absolute()
        if not (folder / FILE).is_file():
            raise InputError(f"{folder}: {NO_STUDY}")
        if os.access(folder, os.W_OK):
            return cls.create(folder)
        return cls(folder, _connect_read_only(folder))

    def __enter__(self) -> Store:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the store."""
        self._connection.close()

    @property
    def running(self) -> Path:
        """The folder of the runs that are being computed."""
        return self.folder / RUNNING

    def register(self, study: str, axes: Sequence[str], runs: Iterable[Run]) -> None:
        """Enter a study with its runs; it takes the place of one with the same name."""
        runs = list(runs)
        with self._transaction() as write:
            write.execute("DELETE FROM study_run WHERE study = ?", (study,))
            write.execute("INSERT OR REPLACE INTO study VALUES (?, ?)", (study, json.dumps(axes)))
            write.executemany(
                # A known run keeps its results; if it has none, files may be elsewhere by now.
                "INSERT INTO run (hash, version, scene) VALUES (?, ?, ?) ON CONFLICT (hash)"
                " DO UPDATE SET scene = excluded.scene WHERE status = 'pending'",
                ((run.hash, _core.version, run.scene) for run in runs),
            )
            write.executemany(
                "INSERT INTO study_run VALUES (?, ?, ?)",
                ((study, position, run.hash) for position, run in enumerate(runs)),
            )

    def studies(self) -> list[str]:
        """Return the names of the studies."""
        return [name for (name,) in self.read("SELECT name FROM study ORDER BY name")]

    def axes(self, study: str) -> list[str]:
        """Return the dotted paths of the parameters that vary in a study.

        Raises
        ------
        InputError
            If the store is damaged.
        """
        ((text,),) = self.read("SELECT axes FROM study WHERE name = ?", (self.named(study),))
        try:
            axes = json.loads(text)
        except (ValueError, RecursionError, TypeError):
            axes = None
        if not isinstance(axes, list) or not all(isinstance(path, str) for path in axes):
            raise self.damaged(f"the axes of {study} are no list of names")
        return axes

    def named(self, study: Optional[str]) -> str:
        """Return the study of that name, or the only one for None; else raise InputError."""
        names = self.studies()
        if study is None and len(names) == 1:
            return names[0]
        if not names:
            raise InputError(f"{self.folder}: {NO_STUDY}")
        if study is None or study not in names:
            wrong = "holds several studies" if study is None else f"holds no study {study!r}"
            raise InputError(f"{self.folder}: {wrong}; name one of: {', '.join(names)}")
        return study

    def runs(self, study: str) -> list[StoredRun]:
        """Return the runs of a study in order.

        Raises
        ------
        InputError
            If one of them is damaged.
        """
        rows = self.read(
            f"SELECT {RUN_COLUMNS} FROM study_run JOIN run USING (hash)"
            " WHERE study = ? ORDER BY position",
            (study,),
        )
        return [self._stored(row) for row in rows]

    def find(self, beginning: str) -> StoredRun:
        """Return the run whose hash begins so; raises InputError unless there is exactly one."""
        rows = self.read(
            f"SELECT {RUN_COLUMNS} FROM run WHERE substr(hash, 1, ?) = ? LIMIT 2",
            (len(beginning), beginning),
        )
        if len(rows) != 1:
            found = "several runs" if rows else "no run"
            raise InputError(f"{self.folder}: {found} with a hash that begins with {beginning!r}")
        return self._stored(rows[0])

    def damaged(self, what: str) -> InputError:
        """Return the error that says what is damaged."""
        return InputError(f"{self.folder / FILE}: damaged: {what}")

    def _stored(self, row: Sequence[Any]) -> StoredRun:
        if not all(text is None or isinstance(text, str) for text in row):
            raise self.damaged(f"run {row[0]!r}: not a text in every column")
        run = StoredRun(*row)
        where = f"{self.folder / FILE}: run {run.hash}: its scene"
        check_values(parse_object(run.scene, where), WHOLE_SCENE, where)
        return run

    def state(self, hash_: str) -> tuple[str, Optional[str]]:
        """Return the status of a run, which may be "unknown", and who computes it."""
        rows = self.read("SELECT status, owner FROM run WHERE hash = ?", (hash_,))
        return (rows[0][0], rows[0][1]) if rows else ("unknown", None)

    def claim(self, hash_: str, owner: str) -> bool:
        """Take a pending run that nobody else computes; return whether it is the owner's now."""
        with self._transaction() as write:
            claimed = write.execute(
                "UPDATE run SET owner = ?1 WHERE hash = ?2 AND status = 'pending'"
                " AND (owner IS NULL OR owner = ?1)",
                (owner, hash_),
            )
            return claimed.rowcount == 1

    def release(self, owner: str) -> None:
        """Give up all runs of an owner."""
        with self._transaction() as write:
            write.execute("UPDATE run SET owner = NULL WHERE owner = ?", (owner,))

    def owners(self) -> list[str]:
        """Return everybody who has claimed a run."""
        rows = self.read("SELECT DISTINCT owner FROM run WHERE owner IS NOT NULL")
        return [owner for (owner,) in rows]

    def record(self, outcome: Outcome) -> None:
        """Store what a run gave, unless it is stored already."""
        with self._transaction() as write:
            updated = write.execute(
                "UPDATE run SET status = ?, error = ?, owner = NULL"
                " WHERE hash = ? AND status = 'pending'",
                (outcome.status, outcome.error, outcome.hash),
            )
            if updated.rowcount == 0:
                return
            for row in outcome.events:
                key = {"hash": outcome.hash, "event": row["event"]}
                _insert(write, "event", {**key, **{name: row[name] for name in MEASURED_TYPES}})
                _insert(write, "event_timing", {**key, "wall_s": row["wall_s"]})
            _insert(write, "run_timing", {"hash": outcome.hash, **outcome.timing})

    def reset(self, hashes: Iterable[str]) -> None:
        """Make runs that failed pending again."""
        with self._transaction() as write:
            for hash_ in hashes:
                failed = write.execute(
                    "UPDATE run SET status = 'pending', error = NULL"
                    " WHERE hash = ? AND status = 'failed'",
                    (hash_,),
                )
                if failed.rowcount:
                    for table in ("event", "event_timing", "run_timing"):
                        write.execute(f"DELETE FROM {table} WHERE hash = ?", (hash_,))

    def read(self, query: str, values: Sequence[Any] = ()) -> list[tuple[Any, ...]]:
        """Return the rows of a query."""
        with _translated(self.folder):
            return self._connection.execute(query, values).fetchall()

    @contextmanager
    def _transaction(self) -> Iterator[sqlite3.Connection]:
        with _translated(self.folder), _transaction(self._connection) as write:
            yield write


def _make_folder(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)


def _connect(folder: Path) -> sqlite3.Connection:
    """Open the database, making what it lacks; no other process may do so at the same time."""
    if not (folder / FILE).exists() and any(folder.iterdir()):
        raise InputError(f"{folder}: not empty, and holds no study; choose a new folder")
    with _translated(folder):
        connection = sqlite3.connect(folder / FILE, timeout=BUSY_S, isolation_level=None)
        try:
            connection.execute("PRAGMA journal_mode = WAL")
            connection.execute("PRAGMA synchronous = FULL")
            with _transaction(connection):
                _provide_tables(connection, folder)
        except BaseException:
            connection.close()
            raise
    (folder / RUNNING).mkdir(exist_ok=True)
    return connection


def _connect_read_only(folder: Path) -> sqlite3.Connection:
    """Open the database in a folder where nothing can be written, so that nobody changes it."""
    log = folder / f"{FILE}-wal"
    if log.exists() and log.stat().st_size > 0:
        raise InputError(
            f"{folder}: cannot be written, and was left amid a change; copy it to where it can be"
        )
    with _translated(folder):
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
        connection.execute(f"PRAGMA user_version = {VERSION}")
    _check_format(connection, folder)
    _add_new_measures(connection)


def _check_format(connection: sqlite3.Connection, folder: Path) -> None:
    if _pragma(connection, "application_id") != APPLICATION:
        raise InputError(f"{folder / FILE}: not a store of studies")
    if _pragma(connection, "user_version") != VERSION:
        raise InputError(f"{folder / FILE}: made by another version of snowshed")


def _add_new_measures(connection: sqlite3.Connection) -> None:
    """Give a store of earlier days the columns that events.csv has gained since."""
    present = {row[1] for row in connection.execute("PRAGMA table_info(event)")}
    for name in MEASURED_TYPES.keys() - present:
        connection.execute(f"ALTER TABLE event ADD COLUMN {name} {MEASURED_TYPES[name]}")


def _pragma(connection: sqlite3.Connection, name: str) -> int:
    return int(connection.execute(f"PRAGMA {name}").fetchone()[0])


def _insert(write: sqlite3.Connection, table: str, row: Mapping[str, Any]) -> None:
    names = ", ".join(row)
    marks = ", ".join("?" * len(row))
    write.execute(f"INSERT INTO {table} ({names}) VALUES ({marks})", tuple(row.values()))


@contextmanager
def _transaction(connection: sqlite3.Connection) -> Iterator[sqlite3.Connection]:
    connection.execute("BEGIN IMMEDIATE")
    try:
        yield connection
        connection.execute("COMMIT")
    except BaseException:
        if connection.in_transaction:
            connection.execute("ROLLBACK")
        raise


@contextmanager
def _translated(folder: Path) -> Iterator[None]:
    """Turn errors of the database into what the user can do about them."""
    try:
        yield
    except (sqlite3.Error, UnicodeDecodeError) as error:  # the latter: SQLite quotes damaged text
        raise StudyError(f"{folder / FILE}: {error}") from None
