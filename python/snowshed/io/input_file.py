"""Reading files that somebody else may have written, of whatever size."""

from __future__ import annotations

import os
import resource
import select
import stat
import time
from pathlib import Path

from snowshed._core import InputError
from snowshed.io.limits import MB, PIPE, PIPE_SILENCE, TEXT


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

    A pipe is read as long as its writer goes on, but nothing waits for a writer that is silent.

    Raises
    ------
    InputError
        If it is longer than the limit, or a pipe into which nothing is written.
    OSError
        If it cannot be read.

    Examples
    --------
    >>> read_input(Path("/dev/zero"), 2**20)
    Traceback (most recent call last):
    ...
    snowshed._core.InputError: /dev/zero: longer than 1 MB
    """
    with open(path, "rb", opener=_open_at_once) as file:
        status = os.fstat(file.fileno())
        if not stat.S_ISREG(status.st_mode):
            content = _awaited(file.fileno(), path, largest)
        elif status.st_size <= largest:
            content = file.read(largest + 1) or b""  # None of what has nothing to say yet
        if status.st_size > largest or len(content) > largest:
            limit = f"{largest} bytes" if largest % MB else f"{largest // MB} MB"
            raise InputError(f"{path}: longer than {limit}")
    return content


def _awaited(descriptor: int, path: Path, largest: int) -> bytes:
    """Return what a pipe or a device holds, at most `largest` + 1 bytes."""
    content, end = bytearray(), time.monotonic() + PIPE
    while len(content) <= largest:
        wait = min(end - time.monotonic(), PIPE_SILENCE)
        if wait <= 0.0 or not select.select([descriptor], [], [], wait)[0]:
            raise InputError(
                f"{path}: a pipe or a device to which nobody writes, or too slowly; write its "
                "content to a file first"
            )
        try:
            part = os.read(descriptor, min(largest + 1 - len(content), MB))
        except BlockingIOError:  # another reader was faster
            continue
        if not part:
            break
        content += part
    return bytes(content)
