"""The owners of runs, by the locks of their processes."""

from __future__ import annotations

import re
from pathlib import Path

from snowshed.io.locks import is_held

OWNER = re.compile(r"[A-Za-z0-9._-]{0,64}-[0-9]+-[0-9a-f]{8}")


def is_owner(name: str) -> bool:
    """Return whether a name has the form of an owner, so that it cannot lead out of the store.

    Examples
    --------
    >>> is_owner("node1.local-4711-0a1b2c3d"), is_owner("../../victim")
    (True, False)
    """
    return OWNER.fullmatch(name) is not None


def owner_lives(folder: Path, owner: str) -> bool:
    """Return whether the process of an owner still runs; its lock would be in the folder."""
    return is_owner(owner) and is_held(folder / f"{owner}.lock")
