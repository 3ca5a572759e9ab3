"""Results of other builds of snowshed in a store: they are set aside, and never lost.

A run whose results are set aside has the name of its build behind its hash, so that no study finds
it. `Store.register` does so before the run is computed again; the tables of
`snowshed.study.database` keep the results under the longer name.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterable

from snowshed.study import checksums

#: Tables with results, by run.
TABLES = ("event", "event_timing", "event_particles", "run_timing")


def set_aside(write: sqlite3.Connection, hashes: Iterable[str], build: str) -> int:
    """Set aside the results of runs that another build has computed; return their number.

    Parameters
    ----------
    write
        The transaction.
    hashes
        The runs.
    build
        The present build.
    """
    others = [
        (hash_, f"{hash_} {row[0]}")
        for hash_ in hashes
        if (
            row := write.execute(
                "SELECT build FROM run WHERE hash = ? AND build != ? AND status != 'pending'",
                (hash_, build),
            ).fetchone()
        )
    ]
    for hash_, name in others:
        for table in ("run", *TABLES):
            write.execute(f"DELETE FROM {table} WHERE hash = ?", (name,))
            write.execute(f"UPDATE {table} SET hash = ? WHERE hash = ?", (name, hash_))
        for kind in ("run", *checksums.OF_RESULTS):
            write.execute("DELETE FROM checksum WHERE name = ?", (f"{kind} {hash_}",))
        checksums.store_run_checksum(write, name)
        checksums.store_results_checksum(write, name)
    return len(others)
