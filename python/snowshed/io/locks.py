"""File locks that end with the process that holds them, whatever ends it.

They are locks of the kernel (flock) on a file or a folder, and prove that a process is alive.
Unlike a process id, a lock cannot be mistaken for that of a later process, and it works across
containers.
"""

from __future__ import annotations

import fcntl
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def holding(path: Path, make: Callable[[Path], None]) -> Iterator[None]:
    """Hold the lock of a file or folder, after waiting for its present holder.

    Parameters
    ----------
    path
        The file or folder to lock.
    make
        Function that creates `path`, its argument; the path may exist already.

    Raises
    ------
    OSError
        If it cannot be created, or the file system has no locks.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     with holding(Path(folder) / "a.lock", Path.touch):
    ...         held = is_held(Path(folder) / "a.lock")
    ...     held, is_held(Path(folder) / "a.lock")
    (True, False)
    """
    while True:
        make(path)
        try:
            handle = os.open(path, os.O_RDONLY)
        except FileNotFoundError:
            continue  # its last holder has removed it just now
        try:
            _lock(handle, path, fcntl.LOCK_EX)
            if _still_there(handle, path):
                yield
                return
        finally:
            os.close(handle)


def is_held(path: Path) -> bool:
    """Return whether some process holds the lock; False if the path does not exist."""
    try:
        handle = os.open(path, os.O_RDONLY)
    except FileNotFoundError:
        return False
    try:
        # A shared lock, so that two processes that test at once do not see each other as holder.
        _lock(handle, path, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    finally:
        os.close(handle)
    return False


def _lock(handle: int, path: Path, kind: int) -> None:
    try:
        fcntl.flock(handle, kind)
    except BlockingIOError:
        raise
    except OSError as error:
        reason = f"the file system has no locks ({error.strerror})"
        raise OSError(error.errno, reason, os.fspath(path)) from None


def _still_there(handle: int, path: Path) -> bool:
    """Return whether the path still leads to the opened file; its last holder may remove it."""
    try:
        return os.path.samestat(os.fstat(handle), path.stat())
    except FileNotFoundError:
        return False
