"""Notes: what a reader assumed, filled, left out or changed.

A note is a Python warning of its own class, so that scripts can filter it, turn it into an error or
record it. The command line prints it as "note: …". What is stored with results is recorded by
`recorded`.
"""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType


class SnowshedNote(UserWarning):
    """A fact that the reader of a result should know; the program has no fault."""


def tell(text: str) -> None:
    """Say a note; the warning names the line outside the package that led to it.

    Parameters
    ----------
    text
        A sentence without its full stop.

    Examples
    --------
    >>> with recorded() as notes:
    ...     tell("the raster has feet; they were turned into metres")
    >>> notes
    ['the raster has feet; they were turned into metres']
    """
    warnings.warn(text, SnowshedNote, caller_level())


def caller_level() -> int:
    """Return the `stacklevel` at which the caller of this function warns its user.

    It is that of the first frame outside the package, or of the outermost one.
    """
    level, frame = 1, sys._getframe(1)
    package = __name__.partition(".")[0]
    while frame.f_back is not None and _package_of(frame) == package:
        level, frame = level + 1, frame.f_back
    return level


def _package_of(frame: FrameType) -> str:
    return str(frame.f_globals.get("__name__", "")).partition(".")[0]


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
