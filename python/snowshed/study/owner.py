"""The owner of runs: a process that claims them and holds a lock until it ends."""

from __future__ import annotations

import os
import platform
import re
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from snowshed.io.locks import holding
from snowshed.study.errors import StudyError
from snowshed.study.locks import is_owner, owner_lives
from snowshed.study.store import Store


@contextmanager
def ownership(store: Store) -> Iterator[str]:
    """Yield the name of a new owner, which can claim runs; its claims are released at the end.

    If the process dies, its lock ends, and `release_dead` of another process releases its claims.
    """
    node = re.sub(r"[^A-Za-z0-9.-]", "_", platform.node())[:64]
    owner = f"{node}-{os.getpid()}-{uuid.uuid4().hex[:8]}"
    with holding(_lock(store, owner), Path.touch):
        try:
            yield owner
        finally:
            with suppress(StudyError):  # a full disk; without its lock the owner counts as dead
                store.release(owner)
            _lock(store, owner).unlink(missing_ok=True)


def is_alive(store: Store, owner: str) -> bool:
    """Return whether the process of an owner still runs."""
    return owner_lives(store.running, owner)


def release_dead(store: Store) -> None:
    """Release the claims of owners that have died."""
    for owner in store.owners():
        if not is_alive(store, owner):
            store.release(owner)
            if is_owner(owner):
                _lock(store, owner).unlink(missing_ok=True)


def _lock(store: Store, owner: str) -> Path:
    return store.running / f"{owner}.lock"
