"""Archives of arrays (.npz) from untrusted sources."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

MAX_BYTES = 1 << 30  # bytes


@contextmanager
def open_archive(content: bytes, largest: int = MAX_BYTES) -> Iterator[Any]:
    """Yield the arrays of an archive.

    A small archive can hold arrays that fill the memory, so their sizes are checked first.

    Parameters
    ----------
    content
        Content of the file.
    largest
        Largest size of the file, and of its arrays, bytes.

    Raises
    ------
    snowshed.base.damage.DAMAGED
        If the content is not an archive or is too large; while arrays are read, if one is damaged.

    Examples
    --------
    >>> stream = io.BytesIO()
    >>> np.savez_compressed(stream, a=np.zeros(2_000_000))
    >>> with open_archive(stream.getvalue(), 1_000_000) as arrays:  # doctest: +ELLIPSIS
    ...     arrays["a"]
    Traceback (most recent call last):
    ...
    ValueError: unpacks to 16000... bytes; at most 1000000 are allowed
    """
    if len(content) > largest:
        raise ValueError(f"{len(content)} bytes; at most {largest} are allowed")
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        size = sum(entry.file_size for entry in archive.infolist())
    if size > largest:
        raise ValueError(f"unpacks to {size} bytes; at most {largest} are allowed")
    with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
        yield arrays
