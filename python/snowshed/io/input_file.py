"""Reading files from untrusted sources, of any size."""

from __future__ import annotations

import codecs
import os
import resource
import select
import stat
import time
from pathlib import Path
from typing import BinaryIO

from snowshed._core import InputError
from snowshed.base.limits import MAX_PIPE_SILENCE_S, MAX_TEXT_BYTES, MB, PIPE_TIMEOUT_S


def read_regular(path: Path) -> bytes:
    """Return the content of a file of any size that fits into memory, but of no device or pipe.

    Raises
    ------
    InputError
        If it is not a regular file, or larger than half of the memory.
    OSError
        If it cannot be read.

    Examples
    --------
    >>> read_regular(Path("/dev/zero"))
    Traceback (most recent call last):
    ...
    snowshed._core.InputError: /dev/zero: not a regular file
    """
    with open_regular(path) as file:
        size = os.fstat(file.fileno()).st_size
        if size > _memory() / 2:
            raise InputError(f"{path}: {size / 1e9:.3g} GB do not fit into memory")
        return file.read()


def is_utf16(content: bytes) -> bool:
    """Return whether a text begins with the mark of UTF-16.

    Examples
    --------
    >>> is_utf16("date".encode("utf-16")), is_utf16(b"date")
    (True, False)
    """
    return content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))


def first_bytes(path: Path, count: int) -> bytes:
    """Return the first bytes of a regular file, or all of a shorter one; errors as `read_regular`.

    Examples
    --------
    >>> from tempfile import NamedTemporaryFile
    >>> with NamedTemporaryFile() as file:
    ...     first_bytes(Path(file.name), 4)
    b''
    """
    with open_regular(path) as file:
        return file.read(count)


def open_regular(path: Path) -> BinaryIO:
    """Return an open file that is neither a device nor a pipe, without waiting.

    Raises
    ------
    InputError
        If it is not a regular file.
    OSError
        If it cannot be opened.

    Examples
    --------
    >>> open_regular(Path("/dev/null"))
    Traceback (most recent call last):
    ...
    snowshed._core.InputError: /dev/null: not a regular file
    """
    file = open(path, "rb", opener=_open_at_once)  # noqa: SIM115 - the caller closes it
    if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
        file.close()
        raise InputError(f"{path}: not a regular file")
    return file


def stored_bytes(file: BinaryIO, enough: int) -> int:
    """Return the number of bytes of a file outside holes, counted up to `enough`.

    Holes read as zeros and take no space on the disk, so a file may claim any size.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryFile() as file:
    ...     _ = file.seek(1 << 30), file.write(b"end"), file.flush()
    ...     stored_bytes(file, 1 << 20) < 1 << 20
    True
    """
    length, at, end = 0, 0, os.fstat(file.fileno()).st_size
    position = file.tell()
    try:
        while at < end and length < enough:
            data = os.lseek(file.fileno(), at, os.SEEK_DATA)
            at = os.lseek(file.fileno(), data, os.SEEK_HOLE)
            length += at - data
    except OSError:  # no data after this offset
        pass
    finally:
        file.seek(position)
    return length


def _open_at_once(path: str, flags: int) -> int:
    return os.open(path, flags | os.O_NONBLOCK)


def _memory() -> int:
    """Return the memory of the machine, or the smaller limit of this process, bytes."""
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    machine = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    return machine if limit == resource.RLIM_INFINITY else min(machine, limit)


def read_input(path: Path, largest: int = MAX_TEXT_BYTES) -> bytes:
    """Return the content of a file; endless devices are read up to `largest` bytes.

    A pipe is read until its writer closes it, unless the writer is silent for too long.

    Raises
    ------
    InputError
        If it is longer than the limit, or a pipe without a writer.
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
            content = _read_pipe(file.fileno(), path, largest)
        elif status.st_size <= largest:
            content = file.read(largest + 1) or b""  # None before the first byte
        if status.st_size > largest or len(content) > largest:
            limit = f"{largest} bytes" if largest % MB else f"{largest // MB} MB"
            raise InputError(f"{path}: longer than {limit}")
    return content


def _read_pipe(descriptor: int, path: Path, largest: int) -> bytes:
    """Return the content of a pipe or a device, at most `largest` + 1 bytes."""
    content, end = bytearray(), time.monotonic() + PIPE_TIMEOUT_S
    while len(content) <= largest:
        wait = min(end - time.monotonic(), MAX_PIPE_SILENCE_S)
        if wait <= 0.0 or not select.select([descriptor], [], [], wait)[0]:
            raise InputError(
                f"{path}: a pipe or a device without a writer, or with a slow one; write its "
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
