"""Notes: what a reader assumed, filled, left out or changed.

A note is a Python warning of its own class, so that scripts can filter it, turn it into an error or
record it. The command line prints it as "note: …". What is stored with results is recorded by
`recorded`.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager


class SnowshedNote(UserWarning):
    """A fact that the reader of a result should know; the program has no fault."""


def tell(text: str, stacklevel: int = 2) -> None:
    """Issue a note.

    Parameters
    ----------
    text
        A sentence without its full stop.
    stacklevel
        As for `warnings.warn`, seen from the caller.

    Examples
    --------
    >>> with recorded() as notes:
    ...     tell("the raster has feet; they were turned into metres")
    >>> notes
    ['the raster has feet; they were turned into metres']
    """
    warnings.warn(text, SnowshedNote, stacklevel + 1)


@contextmanager
def recorded() -> Iterator[list[str]]:
    """Collect the notes of a block, each once, and issue them after it again."""
    notes: list[str] = []
    said: list[warnings.WarningMessage] = []
    try:
        with warnings.catch_warnings(record=True) as log:
            said = log
            warnings.simplefilter("always")
            yield notes
    finally:
        texts = [str(note.message) for note in said if issubclass(note.category, SnowshedNote)]
        notes += dict.fromkeys(texts)
        for note in said:
            warnings.warn_explicit(note.message, note.category, note.filename, note.lineno)
