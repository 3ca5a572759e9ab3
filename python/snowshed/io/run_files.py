"""Files of a results folder, checked against the checksums in its run.json.

A table has a checksum of its rows through an event. For any other file, run.json holds the length
and the checksum of the written part, because a growing file may have become longer. Folders of the
previous version have no such checksums.
"""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from snowshed._core import InputError
from snowshed.base.callers import resuming_call
from snowshed.base.json_values import JsonValue
from snowshed.base.notes import InputNote, ResultNote, issue_note
from snowshed.io.csv_table import Table
from snowshed.io.input_file import read_regular
from snowshed.io.json_file import check_seal, read_object

RECORD = "run.json"
UNKNOWN_BUILD = "unknown"  # that of results by earlier versions
#: Files that `snowshed-run` does not update when it resumes a run.
OF_PYTHON = ("curve.csv", "energy_history.csv", "grains.json", "slide.json")


def read_run_record(folder: Path) -> dict[str, Any]:
    """Return the content of run.json in a results folder; empty without the file.

    Raises
    ------
    InputError
        If it is damaged.
    """
    path = folder / RECORD
    return read_object(path) if path.is_file() else {}


def unfinished_note(folder: Path) -> str:
    """Return a sentence about a run that is not finished, or may not be; empty if it is.

    Records of earlier versions have no status, and their runs count as finished.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     _ = (Path(folder) / RECORD).write_text('{"status": "interrupted"}')
    ...     unfinished_note(Path(folder)).replace(folder, "out")
    'out: the run is not finished (interrupted): later events are missing'
    """
    if not (folder / RECORD).is_file():
        return f"{folder}: without {RECORD}, so its run may not be finished"
    status = read_run_record(folder).get("status", "finished")
    if status == "finished":
        return ""
    return f"{folder}: the run is not finished ({status}): later events are missing"


def issue_unfinished_note(folder: Path) -> None:
    """Issue a note if the run in a results folder is not finished."""
    if note := unfinished_note(folder):
        issue_note(note, ResultNote)


def origin_of_record(record: Mapping[str, Any]) -> dict[str, str]:
    """Return the version and build of snowshed that made the results of a run, for `attrs`.

    Builds of earlier versions are unknown.

    Examples
    --------
    >>> origin_of_record({"version": "0.1.0", "build": "e09705a3e90a", "package": "9586848eeb18"})
    {'snowshed_version': '0.1.0', 'snowshed_build': 'e09705a3e90a-9586848eeb18'}
    """
    build = "-".join(str(record[name]) for name in ("build", "package") if name in record)
    return {
        "snowshed_version": str(record.get("version", "")),
        "snowshed_build": build or UNKNOWN_BUILD,
    }


def scene_of_record(document: JsonValue) -> JsonValue:
    """Return the scene in the record of a run (run.json); any other document is one itself.

    Examples
    --------
    >>> scene_of_record({"version": "0.1.0", "scene": {"snowshed": 2}})
    {'snowshed': 2}
    """
    if isinstance(document, dict) and is_record(document):
        return document["scene"]
    return document


def scene_in(document: JsonValue, content: bytes, where: str) -> JsonValue:
    """Return the scene in the content of a file, and note what a recorded run had beside it.

    Raises
    ------
    InputError
        If it is a record whose checksum is wrong.
    """
    if isinstance(document, dict) and is_record(document):
        check_seal(content, where)
        if more := beyond_scene(document):
            issue_note(f"{where}: its run had {more}, which a scene does not hold", InputNote)
    return scene_of_record(document)


def is_record(document: JsonValue) -> bool:
    """Return whether a document is the record of a run (run.json), whatever its file is called.

    Examples
    --------
    >>> is_record({"version": "0.1.0", "scene": {"snowshed": 2}}), is_record({"snowshed": 2})
    (True, False)
    """
    return (
        isinstance(document, dict)
        and "snowshed" not in document
        and isinstance(document.get("scene"), dict)
    )


def beyond_scene(record: Mapping[str, Any]) -> str:
    """Return what shaped a recorded run beside its scene; empty: nothing.

    Examples
    --------
    >>> beyond_scene({"ageing": {"pauses": {}}, "laws": "ice"})
    "ageing and the laws 'ice'"
    """
    parts = ["ageing"] if record.get("ageing") else []
    if laws := record.get("laws"):
        parts.append(f"the laws {laws!r}")
    return " and ".join(parts)


def file_mark(path: Path) -> tuple[int, str]:
    r"""Return the length (bytes) and the checksum (CRC-32) of a file, as run.json holds them.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     path = Path(folder) / "a.csv"
    ...     _ = path.write_text("a\n1\n")
    ...     file_mark(path)
    (4, '89c12400')
    """
    content = read_regular(path)
    return len(content), _checksum(content)


def check_run_file(path: Path) -> None:
    """Raise InputError unless a file matches the run.json beside it.

    Nothing is checked without a run.json, or with a run.json of the previous version.
    """
    record = read_run_record(path.parent)
    tables, files = (record.get(name) for name in ("tables", "files"))
    finished = record.get("status") == "finished"
    if isinstance(tables, dict) and tables.get(path.name):
        _check_table(path, tables[path.name], finished=finished)
    elif isinstance(files, dict) and (path.name in files or path.name in OF_PYTHON):
        _check_file(path, files.get(path.name), finished=finished)


def _check_table(path: Path, sums: Any, *, finished: bool) -> None:
    through = max((int(event) for event in sums if str(event).isdecimal()), default=0)
    table = Table(path)
    if through and table.checksum(through) != sums[str(through)]:
        raise _damaged(path, f"its rows through event {through} differ from those of the run")
    if finished and any(int(row["event"]) > through for row in table.rows):
        raise _damaged(path, f"the run wrote no rows after event {through}")


def _check_file(path: Path, mark: Any, *, finished: bool) -> None:
    if not isinstance(mark, dict):
        raise InputError(
            f"{path}: not complete: {RECORD} holds no checksum of it. Write it again "
            f"with {resuming_call(path.parent / 'scene.json', path.parent)}"
        )
    content = read_regular(path)
    length = mark.get("bytes")
    if (
        not isinstance(length, int)
        or not 0 <= length <= len(content)
        or (finished and length < len(content))
        or _checksum(content[:length]) != mark.get("checksum")
    ):
        raise _damaged(path, "it has changed since the run wrote it")


def _checksum(content: bytes) -> str:
    return f"{zlib.crc32(content):08x}"


def _damaged(path: Path, what: str) -> InputError:
    return InputError(f"{path}: damaged: {what}")
