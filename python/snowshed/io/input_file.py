"""Reading files that somebody else may have written, of whatever size."""

from __future__ import annotations

from pathlib import Path

from snowshed._core import InputError

MB = 1 << 20
#: What people write, scenes and studies and lists, is nowhere near as long; tables may be.
LARGEST, LARGEST_TABLE = 64 * MB, 1024 * MB


def read_input(path: Path, largest: int = LARGEST) -> bytes:
    """Return the content of a file; devices without end are read no farther than `largest` bytes.

    Raises
    ------
    InputError
        If it is longer than the limit.
    OSError
        If it cannot be read.

    Examples
    --------
    >>> read_input(Path("/dev/zero"))
    Traceback (most recent call last):
    ...
    snowshed._core.InputError: /dev/zero: longer than 64 MB
    """
    with path.open("rb") as file:
        content = file.read(largest + 1)
    if len(content) > largest:
        limit = f"{largest} bytes" if largest % MB else f"{largest // MB} MB"
        raise InputError(f"{path}: longer than {limit}")
    return content
