"""Names of files and folders."""

from __future__ import annotations

import os
import shlex
from pathlib import Path
from typing import Union

from snowshed._core import InputError

PathLike = Union[str, os.PathLike[str]]


def with_home(path: str) -> str:
    """Return the name of a file or folder, with the user's home in place of a leading ``~``.

    Examples
    --------
    >>> with_home("runs/a~"), with_home("~/runs") == os.path.join(os.path.expanduser("~"), "runs")
    ('runs/a~', True)
    """
    return os.path.expanduser(path)  # noqa: PTH111 - a name without a home stays as it is


def beside(folder: PathLike, prefix: str = "", suffix: str = "") -> Path:
    """Return a path beside a folder, which may also be named ``.`` or ``..``.

    Raises
    ------
    InputError
        If the folder is the root of the file system.

    Examples
    --------
    >>> beside("runs/a", suffix="-terrain.asc") == Path("runs/a-terrain.asc")
    True
    >>> beside(".", suffix="-x") == Path.cwd().with_name(f"{Path.cwd().name}-x")
    True
    """
    path = Path(folder)
    if path.name in ("", ".."):
        path = path.resolve()
    if not path.name:
        raise InputError(f"{path}: the root of the file system; give a folder")
    return path.with_name(f"{prefix}{path.name}{suffix}")


def utf8_path(path: PathLike) -> str:
    r"""Return the name of a file or folder.

    Raises
    ------
    InputError
        If the name is not UTF-8 or holds a NUL character, because scenes cannot hold such a name.

    Examples
    --------
    >>> utf8_path(os.fsdecode(b"bad\xff"))
    Traceback (most recent call last):
    ...
    snowshed._core.InputError: 'bad\udcff': this name is not UTF-8
    """
    name = os.fspath(path)
    if "\0" in name or any("\ud800" <= c <= "\udfff" for c in name):
        raise InputError(f"{name!r}: this name is not UTF-8")
    return name


def shell_words(*words: object) -> str:
    """Return words of a command as a shell reads them, for messages.

    Examples
    --------
    >>> shell_words("snowshed", "view", "my runs")
    "snowshed view 'my runs'"
    """
    return shlex.join(map(str, words))
