"""Reading files that somebody else may have written, of whatever size."""

from __future__ import annotations

import os
import resource
import stat
from pathlib import Path

from snowshed._core import InputError
from snowshed.io.limits import MB, TEXT


def read_regular(path: Path) -> bytes:
    """Return the content of a file of any size that fits into memory, but of no device or pipe.

    Raises
    ------
    InputError
        If it is no regular file, or is larger than half of the memory.
    OSError
        If it cannot be read.

    Examples
    --------
    >>> read_regular(Path("/dev/zero"))
    Traceback (most recent call last):
    ...
    snowshed._core.InputError: /dev/zero: not a regular file
    """
    with open(path, "rb", opener=_open_at_once) as file:
        status = os.fstat(file.fileno())
        if not stat.S_ISREG(status.st_mode):
            raise InputError(f"{path}: not a regular file")
        if status.st_size > _memory() / 2:
            raise InputError(f"{path}: {status.st_size / 1e9:.3g} GB do not fit into memory")
        return file.read()


def _open_at_once(path: str, flags: int) -> int:
    """Open a file without waiting, as for the writer of a pipe."""
    return os.open(path, flags | os.O_NONBLOCK)


def _memory() -> int:
    """Return the bytes that the machine, or the limit of this process, has."""
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    machine = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return machine if limit == resource.RLIM_INFINITY else min(machine, limit)


def read_input(path: Path, largest: int = TEXT) -> bytes:
    """Return the content of a file; devices without end are read no farther than `largest` bytes.

    Raises
    ------
    InputError
        If it is longer than the limit, or a pipe or a terminal, which could wait for ever.
    OSError
        If it cannot be read.

    Examples
    --------
    >>> read_input(Path("/dev/zero"))
    Traceback (most recent call last):
    ...
    snowshed._core.InputError: /dev/zero: longer than 64 MB
    """
    with open(path, "rb", opener=_open_at_once) as file:
        mode = os.fstat(file.fileno()).st_mode
        if stat.S_ISFIFO(mode) or stat.S_ISSOCK(mode) or file.isatty():
            raise InputError(f"{path}: not a regular file")
        content = file.read(largest + 1)
    if len(content) > largest:
        limit = f"{largest} bytes" if largest % MB else f"{largest // MB} MB"
        raise InputError(f"{path}: longer than {limit}")
    return content
