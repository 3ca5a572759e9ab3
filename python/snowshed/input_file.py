"""Reading files that somebody else may have written, of whatever size."""

from __future__ import annotations

from pathlib import Path

from snowshed._core import InputError

#: What people write, scenes and studies and lists, is nowhere near as long; tables may be.
LARGEST_MB, LARGEST_TABLE_MB = 64, 1024


def read_input(path: Path, largest_mb: int = LARGEST_MB) -> bytes:
    """Return the content of a file; devices without end are read no farther than the limit.

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
    largest = largest_mb << 20
    with path.open("rb") as file:
        content = file.read(largest + 1)
    if len(content) > largest:
        raise InputError(f"{path}: longer than {largest_mb} MB")
    return content
