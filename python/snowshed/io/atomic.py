"""Atomic files: written under a temporary name beside their target, then renamed."""

from __future__ import annotations

import errno
import fcntl
import os
import re
import secrets
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Union

from snowshed._core import InputError

#: Prefix of files that are being written, and of leftovers of killed processes.
LEFTOVER = re.compile(r"\.partial-[0-9a-f]{16}-")
#: Errors of file systems that cannot flush.
CANNOT_FLUSH = (errno.EINVAL, errno.ENOTSUP, errno.EROFS)
#: Flags to open a file that may be a link (refused) or a pipe without a writer.
WITHOUT_WAITING = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK


@contextmanager
def replacing(path: Union[str, os.PathLike[str]]) -> Iterator[Path]:
    """Yield a path to write to, in the same folder; it takes the place of `path` on success.

    If the file is a link, its target is replaced. Leftovers of killed processes are removed.

    Raises
    ------
    InputError
        If `path` is something other than a file, such as a folder or a device.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     with replacing(Path(folder) / "a.txt") as beside:
    ...         _ = beside.write_text("whole")
    ...     (Path(folder) / "a.txt").read_text()
    'whole'
    """
    path = Path(path)
    if path.exists() and not path.is_file():
        raise InputError(f"{path}: not a file; writing would destroy it")
    path = Path(os.path.realpath(path))
    if path.is_symlink():
        raise OSError(errno.ELOOP, os.strerror(errno.ELOOP), str(path))
    _remove_abandoned(path)
    beside = path.with_name(_partial(path))
    try:
        with _hold_lock(beside, _new_file):
            yield beside
            _flush(beside)
            beside.replace(path)
        _flush(path.parent)
    except OSError as error:
        if error.filename in (None, str(beside)):  # the user knows the target's name only
            error.filename = str(path)
        raise
    finally:
        beside.unlink(missing_ok=True)


@contextmanager
def replacing_folder(path: Union[str, os.PathLike[str]]) -> Iterator[Path]:
    """Yield a new folder beside `path`; it takes the place of `path`, if empty, on success.

    Leftovers of killed processes are removed.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     with replacing_folder(Path(folder) / "new") as beside:
    ...         _ = (beside / "a.txt").write_text("whole")
    ...     [file.name for file in (Path(folder) / "new").iterdir()]
    ['a.txt']
    """
    path = Path(os.path.realpath(path))
    path.parent.mkdir(parents=True, exist_ok=True)
    _remove_abandoned(path)
    beside = path.with_name(_partial(path))
    try:
        with _hold_lock(beside, Path.mkdir):
            yield beside
            beside.replace(path)
        _flush(path.parent)
    finally:
        shutil.rmtree(beside, ignore_errors=True)


def _remove_abandoned(path: Path) -> None:
    """Remove leftovers of dead processes for `path`."""
    with suppress(OSError):  # the folder cannot be read
        for other in path.parent.iterdir():
            leftover = LEFTOVER.match(other.name)
            if leftover and other.name[leftover.end() :] == _suffix(path.name):
                _remove_unless_held(other)


def _remove_unless_held(path: Path) -> None:
    """Remove a file or a folder whose lock no living process holds."""
    with suppress(OSError), _closing(os.open(path, WITHOUT_WAITING)) as descriptor:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)
        elif path.is_file():
            path.unlink()


@contextmanager
def _hold_lock(path: Path, make: Callable[[Path], None]) -> Iterator[None]:
    """Make a file or a folder and hold its lock; the system releases it when the process dies."""
    with _closing(_make_and_lock(path, make)):
        yield


def _make_and_lock(path: Path, make: Callable[[Path], None]) -> int:
    """Make a file or a folder; return a descriptor of it that holds its lock."""
    while True:
        make(path)
        with suppress(FileNotFoundError):
            descriptor = os.open(path, WITHOUT_WAITING)
            with suppress(OSError):  # the file system has no locks
                fcntl.flock(descriptor, fcntl.LOCK_EX)
            if path.exists():
                return descriptor
            os.close(descriptor)  # another process removed it before it was locked


@contextmanager
def _closing(descriptor: int) -> Iterator[int]:
    try:
        yield descriptor
    finally:
        os.close(descriptor)


def _new_file(path: Path) -> None:
    """Create an empty file; it must not exist."""
    os.close(os.open(path, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))


def remove_leftovers(folder: Path) -> None:
    """Remove leftovers of killed processes in a folder and its subfolders.

    Folders that are links are not entered.
    """
    for inside, _, names in os.walk(folder):
        for path in map(Path(inside).joinpath, names):
            if LEFTOVER.match(path.name) and path.is_file() and not path.is_symlink():
                path.unlink(missing_ok=True)


def _partial(path: Path) -> str:
    """Return a temporary name for the file or folder that becomes `path`.

    The name is random, so that nobody can plant a link there. The core removes such files from
    results folders.
    """
    return f".partial-{secrets.token_hex(8)}-{_suffix(path.name)}"


def _suffix(name: str) -> str:
    """Return the end of a name, which shows the kind of file; at most 100 bytes."""
    return os.fsdecode(os.fsencode(name)[-100:].lstrip(bytes(range(0x80, 0xC0))))


def write_text(path: Union[str, os.PathLike[str]], text: str) -> None:
    """Write a whole UTF-8 text file."""
    with replacing(path) as beside:
        beside.write_text(text, encoding="utf-8")


def _flush(path: Path) -> None:
    """Make a file or a folder survive a power cut, if the file system supports it."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    except OSError as error:
        if error.errno not in CANNOT_FLUSH:
            raise
    finally:
        os.close(descriptor)
