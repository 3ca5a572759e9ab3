"""Notes: assumptions and changes that a reader made, issued as warnings.

A note is a Python warning, so that scripts can filter it, turn it into an error or record it. Its
class says what it concerns. The command line prints it as "note: …". `record_notes` collects the
notes that results store.
"""

from __future__ import annotations

import re
import sys
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Optional

from snowshed.base.log import LOGGER


class SnowshedNote(UserWarning):
    """A fact that the reader of a result should know; the program has no fault.

    All notes are of this class or of one below it.
    """


class UnusualValueNote(SnowshedNote):
    """A value that is allowed, but so unusual that it may be of another unit or a slip."""


class ResolutionNote(SnowshedNote):
    """Cells or particles are too coarse for what they should resolve."""


class InputNote(SnowshedNote):
    """A reader assumed, converted or left out a part of a file or a table."""


class ResultNote(SnowshedNote):
    """A property of a result, such as snow that stays on the panel, or failed runs of a study."""


#: Words of notes that say what they concern. Notes of the core and of stored runs are texts alone.
_SUBJECTS = (
    (
        UnusualValueNote,
        re.compile(
            r"unusual|another unit|check (its|the) units?\b|units right|\b(is|are) [^.;?]*\?"
        ),
    ),
    (
        ResolutionNote,
        re.compile(r"\bcoarse\b|less than a cell of|that fill no layer|smaller layer_"),
    ),
)


def issue_note(text: str, subject: type[SnowshedNote] = SnowshedNote) -> None:
    """Issue a note; the warning names the calling line outside the package.

    Parameters
    ----------
    text
        A sentence without its full stop.
    subject
        The class of the note, unless its words say that it concerns unusual values or resolution.

    Examples
    --------
    >>> with record_notes() as notes:
    ...     issue_note("the raster is in feet; it was converted to metres")
    >>> notes
    ['the raster is in feet; it was converted to metres']
    """
    LOGGER.info("note: %s", text)
    warnings.warn(text, _subject_of(text) or subject, caller_level())


def _subject_of(text: str) -> Optional[type[SnowshedNote]]:
    return next((subject for subject, words in _SUBJECTS if words.search(text)), None)


def caller_level() -> int:
    """Return the `stacklevel` at which the caller of this function warns its user.

    This is the level of the first frame outside the package, or of the outermost frame.
    """
    level, frame = 1, sys._getframe(1)
    package = __name__.partition(".")[0]
    while frame.f_back is not None and _package(frame) == package:
        level, frame = level + 1, frame.f_back
    return level


def _package(frame: FrameType) -> str:
    return str(frame.f_globals.get("__name__", "")).partition(".")[0]


@contextmanager
def record_notes() -> Iterator[list[str]]:
    """Collect the notes of a block, each once, and issue them again after the block."""
    notes: list[str] = []
    log: list[warnings.WarningMessage] = []
    try:
        with _log() as log:
            yield notes
    finally:
        notes += _texts(log)
        _issue(log)


@contextmanager
def held_notes() -> Iterator[list[str]]:
    """Collect the notes of a block, each once; issue them only if the block fails.

    Examples
    --------
    >>> with held_notes() as notes:
    ...     issue_note("a summary will have this note")
    >>> notes
    ['a summary will have this note']
    """
    notes: list[str] = []
    log: list[warnings.WarningMessage] = []
    try:
        with _log() as log:
            yield notes
    except BaseException:
        _issue(log)
        raise
    _issue([note for note in log if not issubclass(note.category, SnowshedNote)])
    notes += _texts(log)


@contextmanager
def issue_notes_on_failure(notes: Iterable[str]) -> Iterator[None]:
    """Issue notes if the block fails, because no result will show them."""
    try:
        yield
    except BaseException:
        for note in notes:
            issue_note(note)
        raise


@contextmanager
def _log() -> Iterator[list[warnings.WarningMessage]]:
    with warnings.catch_warnings(record=True) as log:
        warnings.simplefilter("always")
        yield log


def _texts(log: Iterable[warnings.WarningMessage]) -> list[str]:
    texts = (str(note.message) for note in log if issubclass(note.category, SnowshedNote))
    return list(dict.fromkeys(texts))


def _issue(log: Iterable[warnings.WarningMessage]) -> None:
    for note in log:
        warnings.warn_explicit(note.message, note.category, note.filename, note.lineno)
