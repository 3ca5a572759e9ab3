"""Records of what was computed from many inputs: from such a file alone it is computed again.

A study, a season and an answer on clearance each have a record: a JSON object with the inputs under
a key of its own (`KINDS`), the facts of the program and the machine, checksums of the files that
the inputs name, notes, and a checksum of itself. A single run has its run.json.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Optional

from snowshed._core import InputError
from snowshed.base.machine import present_facts
from snowshed.base.notes import InputNote, issue_note
from snowshed.io.input_file import read_input
from snowshed.io.json_file import parse_object
from snowshed.io.json_text import loads
from snowshed.io.run_files import file_mark

STUDY, SEASON, CLEARANCE = "study", "season", "clearance"
KINDS = (STUDY, SEASON, CLEARANCE)
FORMAT = 1  # of the inputs; another one is refused


def record_data(kind: str, inputs: Mapping[str, Any], files: Iterable[str]) -> dict[str, Any]:
    """Return the record of a computation as JSON data; `files` are those that its inputs name."""
    marks = {}
    for name in dict.fromkeys(files):
        if Path(name).is_file():
            length, checksum = file_mark(Path(name))
            marks[name] = {"bytes": length, "checksum": checksum}
    return {**present_facts(), "format": FORMAT, kind: dict(inputs), "inputs": marks}


def record_kind(content: bytes) -> Optional[str]:
    """Return the kind of the record that a file holds; None: it is a scene or a study file, say.

    Examples
    --------
    >>> record_kind(b'{"study": {}, "format": 1}'), record_kind(b'name = "a"')
    ('study', None)
    """
    if content.lstrip()[:1] != b"{" or b'"format"' not in content:  # without parsing it
        return None
    try:
        return _kind(loads(content))
    except (ValueError, RecursionError):
        return None


def _kind(record: Any) -> Optional[str]:
    """Return the kind of a record; None: it is none."""
    if not isinstance(record, dict) or "format" not in record:
        return None
    kinds = [kind for kind in KINDS if isinstance(record.get(kind), dict)]
    return kinds[0] if len(kinds) == 1 else None


@contextmanager
def recorded_inputs(file: Path, kind: str) -> Iterator[Mapping[str, Any]]:
    """Yield the inputs in a record; note another build, and files that have changed.

    Raises
    ------
    InputError
        If the file is no record of this kind, or of another version of the format, or damaged: also
        if its inputs cannot be read in the block.
    """
    record = parse_object(read_input(file), os.fspath(file))
    given = _kind(record)
    if given is None:
        raise InputError(f"{file}: no record of a study, a season or a clearance")
    if given != kind:
        raise InputError(f"{file}: the record of a {given}, not of a {kind}")
    if record["format"] != FORMAT:
        raise InputError(f"{file}: made by another version of snowshed")
    for note in _differences(record, file):
        issue_note(note, InputNote)
    try:
        yield record[kind]
    except (AttributeError, KeyError, TypeError) as error:
        raise InputError(f"{file}: damaged: {error}") from None


def _differences(record: Mapping[str, Any], file: Path) -> list[str]:
    """Return notes on what has changed since the record: the build, and the files it names."""
    notes, facts = [], present_facts()
    if any(record.get(name) != facts[name] for name in ("version", "build", "package")):
        notes.append(f"{file} is of another build of snowshed")
    marks = record.get("inputs")
    for name, mark in marks.items() if isinstance(marks, dict) else ():
        known = (mark.get("bytes"), mark.get("checksum")) if isinstance(mark, dict) else None
        if Path(name).is_file() and file_mark(Path(name)) != known:
            notes.append(f"{name} has changed since {file} was written")
    return notes
