"""The store of studies: an SQLite database that survives any end of its processes.

Its tables are described in `snowshed.study.database`. The status of a run is pending, done or
failed. While a run is computed, its owner is the name of a lock in the folder ``running`` (see
`snowshed.study.owner`).
"""

from __future__ import annotations

import json
import os
import sqlite3
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.build import build_id
from snowshed.base.callers import STUDY_RUN, either
from snowshed.base.paths import PathLike
from snowshed.io.json_file import check_values, parse_object
from snowshed.io.locks import holding
from snowshed.study import checksums
from snowshed.study.database import (
    FILE,
    RUNNING,
    STORED_TYPES,
    connect,
    connect_read_only,
    transaction,
    translate_errors,
)
from snowshed.study.other_builds import set_aside
from snowshed.study.outcome import RunOutcome
from snowshed.study.scene_hash import HASH_DIGITS, RunKey, is_hash

STATUSES = ("pending", "done", "failed")
WITHOUT_CHECKSUM = (
    "without its checksum: damaged, or added by an earlier version of snowshed after this one had "
    "opened the store"
)


def no_study() -> str:
    """Return a phrase on a folder without a study."""
    return f"holds no study; start one with {either(*STUDY_RUN)}"


@dataclass(frozen=True)
class StoredRun:
    """A run in the store; see the table ``run``."""

    hash: str
    version: str
    scene: str
    status: str
    error: Optional[str]
    owner: Optional[str]
    build: str
    notes: Sequence[str]
    keep_particles: bool


#: Values of columns that a read-only store of an earlier version lacks.
MISSING = {"build": "''", "notes": "''", "keep_particles": "0"}
#: Keys of a complete scene, which a damaged text may lack.
WHOLE_SCENE = {"dimension": float, "numerics": dict, "events": dict}


class Store:
    """The store in a folder; use `create` or `open`, and `close` it (or use it in ``with``).

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from snowshed import Scene
    >>> run = RunKey.of(Scene.preset("lab-50").resolve())
    >>> with TemporaryDirectory() as folder, Store.create(folder) as store:
    ...     _ = store.register("lab", [], [run])
    ...     store.claim(run.hash, "me"), store.claim(run.hash, "somebody else")
    (True, False)
    """

    def __init__(self, folder: Path, connection: sqlite3.Connection) -> None:
        self.folder = folder
        self._connection = connection
        self._read_digests: tuple[object, Mapping[str, str]] = (None, {})

    @classmethod
    def create(cls, folder: PathLike) -> Store:
        """Open the store in a folder, and create both if they do not exist.

        Raises
        ------
        InputError
            If the folder holds other files.
        StudyError
            If the store cannot be used.
        """
        folder = Path(folder).absolute()
        if folder.exists() and not folder.is_dir():
            raise InputError(f"{folder}: not a folder")
        with holding(folder, _make_folder):
            return cls(folder, connect(folder))

    @classmethod
    def open(cls, folder: PathLike) -> Store:
        """Open the store in a folder; for reading only, if the folder is read-only.

        Raises
        ------
        InputError
            If there is none.
        StudyError
            If the store cannot be used.
        """
        folder = Path(folder).absolute()
        if not (folder / FILE).is_file():
            raise InputError(f"{folder}: {no_study()}")
        if os.access(folder, os.W_OK):
            return cls.create(folder)
        return cls(folder, connect_read_only(folder))

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

    def register(
        self,
        study: str,
        axes: Sequence[str],
        runs: Iterable[RunKey],
        *,
        keep_particles: bool = False,
        same_version: bool = False,
    ) -> int:
        """Register a study with its runs; it replaces a study of the same name.

        Parameters
        ----------
        study, axes, runs
            Name of the study, paths of the parameters that vary, and runs.
        keep_particles
            Whether the particles after each event are stored, too, for runs that are not computed
            yet.
        same_version
            Whether results of another build of the same version count. Otherwise they are set aside
            in the store, and the runs become pending again.

        Returns
        -------
        int
            The number of runs whose results were set aside.
        """
        runs, build = list(runs), build_id()
        with self._transaction() as write:
            aside = 0 if same_version else set_aside(write, [run.hash for run in runs], build)
            write.execute("DELETE FROM study_run WHERE study = ?", (study,))
            write.execute("INSERT OR REPLACE INTO study VALUES (?, ?)", (study, json.dumps(axes)))
            write.executemany(
                # A known run keeps its results; without results, its files may have moved since.
                "INSERT INTO run (hash, version, scene, build) VALUES (?, ?, ?, ?)"
                " ON CONFLICT (hash) DO UPDATE SET scene = excluded.scene,"
                " build = CASE WHEN owner IS NULL THEN excluded.build ELSE build END"
                " WHERE status = 'pending'",
                ((run.hash, _core.version, run.scene, build) for run in runs),
            )
            if keep_particles:
                write.executemany(
                    "UPDATE run SET keep_particles = 1 WHERE hash = ? AND status = 'pending'",
                    ((run.hash,) for run in runs),
                )
            write.executemany(
                "INSERT INTO study_run VALUES (?, ?, ?)",
                ((study, position, run.hash) for position, run in enumerate(runs)),
            )
            for run in runs:
                checksums.store_run_checksum(write, run.hash)
            checksums.store_study_checksum(write, study)
        return aside

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
        study = self.named(study)
        rows = self.read("SELECT axes FROM study WHERE name = ?", (study,))
        text: Any = rows[0][0] if rows else None
        try:
            axes = json.loads(text)
        except (ValueError, RecursionError, TypeError):
            axes = None
        if not isinstance(axes, list) or not all(isinstance(path, str) for path in axes):
            raise self.damaged(f"the axes of {study} are no list of names")
        self._check(f"study {study}", lambda: checksums.study_of(self._connection, study))
        return axes

    def named(self, study: Optional[str]) -> str:
        """Return the study of that name, or the only one for None; else raise InputError."""
        names = self.studies()
        if study is None and len(names) == 1:
            return names[0]
        if not names:
            raise InputError(f"{self.folder}: {no_study()}")
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
            f"SELECT {self._run_columns()} FROM study_run JOIN run USING (hash)"
            " WHERE study = ? ORDER BY position",
            (study,),
        )
        query = "SELECT count(*) FROM study_run WHERE study = ?"
        if self.read(query, (study,)) != [(len(rows),)]:
            raise self.damaged(f"{study}: some of its runs are missing")
        return [self._stored(row) for row in rows]

    def find(self, beginning: str) -> StoredRun:
        """Return the only run whose hash begins with a text; else raise InputError."""
        rows = self.read(
            f"SELECT {self._run_columns()} FROM run WHERE substr(hash, 1, ?) = ?"
            " AND length(hash) = ? LIMIT 2",
            (len(beginning), beginning, HASH_DIGITS),
        )
        if len(rows) != 1:
            matches = "several runs" if rows else "no run"
            raise InputError(f"{self.folder}: {matches} with a hash that begins with {beginning!r}")
        return self._stored(rows[0])

    def damaged(self, what: str) -> InputError:
        """Return the error about a damaged part."""
        return InputError(f"{self.folder / FILE}: damaged: {what}")

    def _stored(self, row: Sequence[Any]) -> StoredRun:
        if not all(text is None or isinstance(text, str) for text in row[:-1]):
            raise self.damaged(f"run {row[0]!r}: not a text in every column")
        notes = self._notes(row[0], row[-2])
        run = StoredRun(*[*row[:-2], notes, bool(row[-1])])
        if not is_hash(run.hash) or run.status not in STATUSES:
            raise self.damaged(f"run {run.hash!r}: {run.status!r}, or no content hash")
        where = f"{self.folder / FILE}: run {run.hash}: its scene"
        check_values(parse_object(run.scene, where), WHOLE_SCENE, where)
        self._check(f"run {run.hash}", lambda: [run.hash, run.version, run.scene])
        if self._digests and (run.status != "pending") != (f"results {run.hash}" in self._digests):
            lacks = WITHOUT_CHECKSUM if run.status != "pending" else "pending, but has results"
            raise self.damaged(f"run {run.hash}: {lacks}")
        return run

    def _notes(self, hash_: str, text: str) -> Sequence[str]:
        """Return the notes on a run from their JSON list; runs of earlier versions have none."""
        if text or f"notes {hash_}" in self._digests:
            self._check(f"notes {hash_}", lambda: text)
        try:
            notes = json.loads(text) if text else []
        except (ValueError, RecursionError):
            notes = None
        if not isinstance(notes, list) or not all(isinstance(note, str) for note in notes):
            raise self.damaged(f"run {hash_}: its notes are no list of texts")
        return tuple(notes)

    def check_results(self, hash_: str) -> None:
        """Raise InputError if the results of a run have changed since they were stored."""
        with translate_errors(self.folder):
            self._check(f"results {hash_}", lambda: checksums.results_of(self._connection, hash_))

    def _check(self, name: str, content: Callable[[], object]) -> None:
        """Raise InputError if the checksum of the content differs; an old store has none."""
        if not self._digests:
            return
        if name not in self._digests:
            raise self.damaged(f"{name}: {WITHOUT_CHECKSUM}")
        if self._digests[name] != checksums.digest(content()):
            raise self.damaged(f"{name}: its checksum is wrong")

    @property
    def _digests(self) -> Mapping[str, str]:
        """The checksums by name, read again when the store has changed."""
        with translate_errors(self.folder):
            version = self._connection.execute("PRAGMA data_version").fetchone()[0]
        state = (version, self._connection.total_changes)
        if self._read_digests[0] != state:
            there = self.columns("checksum")
            rows = self.read("SELECT name, digest FROM checksum") if there else []
            self._read_digests = (state, dict(rows))
        return self._read_digests[1]

    def state(self, hash_: str) -> tuple[str, Optional[str]]:
        """Return the status of a run, which may be "unknown", and its owner."""
        rows = self.read("SELECT status, owner FROM run WHERE hash = ?", (hash_,))
        return (rows[0][0], rows[0][1]) if rows else ("unknown", None)

    def claim(self, hash_: str, owner: str) -> bool:
        """Claim a pending run that no other owner computes; return whether this succeeded."""
        with self._transaction() as write:
            claimed = write.execute(
                "UPDATE run SET owner = ?1 WHERE hash = ?2 AND status = 'pending'"
                " AND (owner IS NULL OR owner = ?1)",
                (owner, hash_),
            )
            return claimed.rowcount == 1

    def release(self, owner: str) -> None:
        """Release all runs of an owner."""
        with self._transaction() as write:
            write.execute("UPDATE run SET owner = NULL WHERE owner = ?", (owner,))

    def owners(self) -> list[str]:
        """Return all owners that have claimed a run."""
        rows = self.read("SELECT DISTINCT owner FROM run WHERE owner IS NOT NULL")
        return [owner for (owner,) in rows]

    def record(self, outcome: RunOutcome) -> None:
        """Store the outcome of a run, unless it is stored already."""
        with self._transaction() as write:
            updated = write.execute(
                "UPDATE run SET status = ?, error = ?, notes = ?, owner = NULL"
                " WHERE hash = ? AND status = 'pending'",
                (outcome.status, outcome.error, _json_of_notes(outcome.notes), outcome.hash),
            )
            if updated.rowcount == 0:
                return
            for row in outcome.events:
                key = {"hash": outcome.hash, "event": row["event"]}
                _insert(write, "event", {**key, **{name: row.get(name) for name in STORED_TYPES}})
                _insert(write, "event_timing", {**key, "wall_s": row["wall_s"]})
            for event, data in outcome.particles.items():
                key = {"hash": outcome.hash, "event": event}
                _insert(write, "event_particles", {**key, "data": data})
            _insert(write, "run_timing", {"hash": outcome.hash, **outcome.timing})
            checksums.store_results_checksum(write, outcome.hash)

    def reset(self, hashes: Iterable[str]) -> None:
        """Set failed runs to pending."""
        with self._transaction() as write:
            for hash_ in hashes:
                failed = write.execute(
                    "UPDATE run SET status = 'pending', error = NULL, notes = ''"
                    " WHERE hash = ? AND status = 'failed'",
                    (hash_,),
                )
                if failed.rowcount:
                    for table in ("event", "event_timing", "event_particles", "run_timing"):
                        write.execute(f"DELETE FROM {table} WHERE hash = ?", (hash_,))
                    for kind in checksums.OF_RESULTS:
                        write.execute("DELETE FROM checksum WHERE name = ?", (f"{kind} {hash_}",))

    def particles(self, hash_: str) -> dict[int, bytes]:
        """Return the packed particles after each event of a run; empty if they were not stored.

        Raises
        ------
        InputError
            If the store is damaged.
        """
        if not self.columns("event_particles"):
            return {}
        query = "SELECT event, data FROM event_particles WHERE hash = ? ORDER BY event"
        particles = dict(self.read(query, (hash_,)))
        if not all(isinstance(data, bytes) for data in particles.values()):
            raise self.damaged(f"run {hash_}: its particles are no bytes")
        if particles or f"particles {hash_}" in self._digests:
            self._check(f"particles {hash_}", lambda: sorted(particles.items()))
        return particles

    def columns(self, table: str) -> set[str]:
        """Return the columns of a table; a read-only store of an earlier version has fewer."""
        return {row[1] for row in self.read(f"PRAGMA table_info({table})")}

    def _run_columns(self) -> str:
        present = self.columns("run")
        return ", ".join(
            f"run.{name}" if name in present else f"{MISSING[name]} AS {name}"
            for name in StoredRun.__annotations__
        )

    def read(self, query: str, values: Sequence[Any] = ()) -> list[tuple[Any, ...]]:
        """Return the rows of a query."""
        with translate_errors(self.folder):
            return self._connection.execute(query, values).fetchall()

    @contextmanager
    def _transaction(self) -> Iterator[sqlite3.Connection]:
        with translate_errors(self.folder), transaction(self._connection) as write:
            yield write


def _make_folder(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)


def _json_of_notes(notes: Sequence[str]) -> str:
    return json.dumps(list(notes), ensure_ascii=False) if notes else ""


def _insert(write: sqlite3.Connection, table: str, row: Mapping[str, Any]) -> None:
    names = ", ".join(row)
    marks = ", ".join("?" * len(row))
    write.execute(f"INSERT INTO {table} ({names}) VALUES ({marks})", tuple(row.values()))
