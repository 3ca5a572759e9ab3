"""The files of an AvaFrame project that may be read and copied.

Projects are exchanged between people. A link in a project could lead to any file of the user, whose
content would then be among the results.
"""

from __future__ import annotations

import os
import shutil
import stat
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from snowshed._core import InputError
from snowshed.base.limits import GB, MAX_PROJECT_BYTES, MAX_PROJECT_DEPTH, MAX_PROJECT_FILES
from snowshed.base.messages import printable, quoted
from snowshed.base.notes import InputNote, issue_note
from snowshed.io.atomic import replacing

#: Endings of a project's files: rasters, polygons and lines, settings, tables.
SUPPORTED_SUFFIXES = (
    *(".asc", ".tif", ".tiff", ".tfw", ".prj", ".xml"),
    *(".shp", ".shx", ".dbf", ".cpg", ".qpj", ".qix", ".sbn", ".sbx", ".gpkg", ".geojson"),
    *(".ini", ".csv"),
)
#: Entries of Inputs for AvaFrame's own use.
OWN_COPIES = "remeshedRasters"


@dataclass(frozen=True)
class InputFile:
    """A file of a project.

    Attributes
    ----------
    file
        Folder of the project.
    place
        Its path from the project's folder Inputs.
    """

    file: Path
    place: Path


def project_inputs(root: Path) -> list[InputFile]:
    """Return the files in the folder Inputs of a project that may be read and copied.

    Files with other suffixes are left out, with a note.

    Raises
    ------
    InputError
        If a file is unsafe: a link that leads out of the project, to a folder or to nothing, a
        device, a pipe; if a name has forbidden characters; or if files are too many or too large.
    """
    inputs = root / "Inputs"
    _check_own(inputs, root, folder=True)
    files = [InputFile(file, file.relative_to(inputs)) for file in _files(inputs, root, 0)]
    if len(files) > MAX_PROJECT_FILES:
        raise InputError(f"{inputs}: more than {MAX_PROJECT_FILES} files")
    size = sum(each.file.stat().st_size for each in files)
    if size > MAX_PROJECT_BYTES:
        raise InputError(
            f"{inputs}: {size / GB:.3g} GB of files; at most {MAX_PROJECT_BYTES // GB} GB are "
            "copied to the results"
        )
    supported = [each for each in files if each.file.suffix.lower() in SUPPORTED_SUFFIXES]
    others = [
        str(each.place) for each in files if each.file.suffix.lower() not in SUPPORTED_SUFFIXES
    ]
    if others:
        more = f" and {len(others) - 5} others" if len(others) > 5 else ""
        issue_note(f"{inputs}: not copied to the results: {', '.join(others[:5])}{more}", InputNote)
    return supported


def copy_inputs(inputs: Sequence[InputFile], folder: Path) -> None:
    """Copy the files of a project to the folder Inputs of its results."""
    for each in inputs:
        target = folder / "Inputs" / each.place
        if target.exists() and target.samefile(each.file):
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        with open(each.file, "rb", opener=_open_at_once) as source:
            if not stat.S_ISREG(os.fstat(source.fileno()).st_mode):
                raise OSError(None, "not a regular file any more", str(each.file))
            target.unlink(missing_ok=True)  # the target may be a link to another file
            with replacing(target) as beside, beside.open("wb") as copy:
                shutil.copyfileobj(source, copy)


def check_own_file(file: Path, root: Path) -> None:
    """Refuse a file that is not the project's own; see `project_inputs`."""
    _check_own(file, root, folder=False)


def _files(folder: Path, root: Path, depth: int) -> Iterator[Path]:
    if depth > MAX_PROJECT_DEPTH:
        raise InputError(f"{folder}: folders are nested more than {MAX_PROJECT_DEPTH} deep")
    for entry in sorted(_entries(folder), key=lambda each: each.name):
        path = folder / entry.name
        if not entry.name.isprintable() or printable(entry.name) != entry.name:
            raise InputError(f"{folder}: the name {quoted(entry.name)} holds control characters")
        if entry.is_dir(follow_symlinks=False):
            if entry.name != OWN_COPIES:
                yield from _files(path, root, depth + 1)
            continue
        _check_own(path, root, folder=False)
        yield path


def _entries(folder: Path) -> list[os.DirEntry[str]]:
    with os.scandir(folder) as entries:
        files = []
        for entry in entries:
            files.append(entry)
            if len(files) > MAX_PROJECT_FILES:
                raise InputError(f"{folder}: more than {MAX_PROJECT_FILES} files")
        return files


def _check_own(path: Path, root: Path, *, folder: bool) -> None:
    """Refuse files outside the project, and everything except regular files and folders."""
    try:
        inside = path.resolve(strict=True).is_relative_to(root.resolve())
    except (OSError, RuntimeError):  # the target is missing, or links form a circle
        raise InputError(f"{path}: a link that leads to no file") from None
    if not inside:
        raise InputError(
            f"{path}: a link that leads out of the project; copy the file into the project"
        )
    mode = path.stat().st_mode
    if not (stat.S_ISDIR(mode) if folder else stat.S_ISREG(mode)):
        raise InputError(f"{path}: not a regular file")


def _open_at_once(path: str, flags: int) -> int:
    """Open a file without waiting, for example for the writer of a pipe."""
    return os.open(path, flags | os.O_NONBLOCK)
