"""Types of file names."""

from __future__ import annotations

import os
from typing import Union

from snowshed._core import InputError

PathLike = Union[str, os.PathLike[str]]


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
