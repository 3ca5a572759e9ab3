"""Checksums in a store: a damaged row is found when it is read.

Their names: ``run HASH`` for the scene of a run, ``study NAME`` for the runs of a study, ``results
HASH`` for measures, ``particles HASH`` for stored particles and ``notes HASH`` for notes. A store
of an earlier version gets its checksums when it is opened.
"""

from __future__ import annotations

import hashlib
import json
import sqlite3
from collections.abc import Sequence
from typing import Any

#: Kinds of checksums that come with the results of a run.
OF_RESULTS = ("results", "particles", "notes")
TABLE = (
    "CREATE TABLE IF NOT EXISTS checksum"
    " (name TEXT PRIMARY KEY, digest TEXT NOT NULL) WITHOUT ROWID"
)
#: The tables of results; columns of a later version are empty in older rows, and do not count.
RESULTS = ("event", "event_timing", "run_timing")


def store_checksum(write: sqlite3.Connection, name: str, content: object) -> None:
    """Store the checksum of content that the same transaction writes."""
    write.execute("INSERT OR REPLACE INTO checksum VALUES (?, ?)", (name, digest(content)))


def store_run_checksum(write: sqlite3.Connection, hash_: str) -> None:
    """Store the checksum of a run before it is computed."""
    columns = "SELECT hash, version, scene FROM run WHERE hash = ?"
    store_checksum(write, f"run {hash_}", write.execute(columns, (hash_,)).fetchone())


def store_study_checksum(write: sqlite3.Connection, study: str) -> None:
    """Store the checksum of the axes and the runs of a study."""
    store_checksum(write, f"study {study}", study_of(write, study))


def store_results_checksum(write: sqlite3.Connection, hash_: str) -> None:
    """Store the checksums of the results of a run, and of its particles and notes, if any."""
    store_checksum(write, f"results {hash_}", results_of(write, hash_))
    query = "SELECT event, data FROM event_particles WHERE hash = ? ORDER BY event"
    if particles := write.execute(query, (hash_,)).fetchall():
        store_checksum(write, f"particles {hash_}", particles)
    (notes,) = write.execute("SELECT notes FROM run WHERE hash = ?", (hash_,)).fetchone()
    if notes:  # apart from the other results, because rows of earlier versions have none
        store_checksum(write, f"notes {hash_}", notes)


def store_all_checksums(write: sqlite3.Connection) -> None:
    """Store the checksums of the whole content of a store of an earlier version."""
    for hash_, status in write.execute("SELECT hash, status FROM run").fetchall():
        store_run_checksum(write, hash_)
        if status != "pending":
            store_results_checksum(write, hash_)
    for (study,) in write.execute("SELECT name FROM study").fetchall():
        store_study_checksum(write, study)


def study_of(connection: sqlite3.Connection, study: str) -> Sequence[Any]:
    """Return the rows of a study in a store."""
    axes = connection.execute("SELECT axes FROM study WHERE name = ?", (study,)).fetchall()
    query = "SELECT position, hash FROM study_run WHERE study = ? ORDER BY position"
    return [axes, connection.execute(query, (study,)).fetchall()]


def digest(content: object) -> str:
    """Return the checksum of numbers, texts, bytes, and lists of them.

    Examples
    --------
    >>> digest(["a", 1.5, None]) == digest(("a", 1.5, None))
    True
    """
    text = json.dumps(content, default=_digest_of_bytes)
    return hashlib.blake2b(text.encode(), digest_size=16).hexdigest()


def _digest_of_bytes(value: object) -> str:
    return hashlib.blake2b(value, digest_size=16).hexdigest()  # type: ignore[arg-type]


def results_of(connection: sqlite3.Connection, hash_: str) -> Sequence[Any]:
    """Return the rows of the results of a run, without its particles."""
    parts: list[Any] = connection.execute(
        "SELECT status, error FROM run WHERE hash = ?", (hash_,)
    ).fetchall()
    for table in RESULTS:
        cursor = connection.execute(f"SELECT * FROM {table} WHERE hash = ?", (hash_,))
        names = [column[0] for column in cursor.description]
        rows = [
            sorted((name, value) for name, value in zip(names, row) if value is not None)
            for row in cursor
        ]
        parts.append(sorted(rows, key=_event_key))
    return parts


def _event_key(row: Sequence[tuple[str, Any]]) -> str:
    return str(dict(row).get("event", "")).zfill(9)
