"""Reading a list of snapshots as a series in time (.pvd)."""

from __future__ import annotations

import os
import zlib
from pathlib import Path
from typing import Union
from xml.etree import ElementTree

from snowshed._core import InputError
from snowshed.io.input_file import read_input

#: Beginning of the comment with the list's checksum, as the core writes it.
SEAL = b"<!-- checksum "


def read_series(path: Union[str, os.PathLike[str]]) -> list[tuple[float, Path]]:
    """Return the time and the file of each entry, in the order of the list.

    Parameters
    ----------
    path
        A .pvd file as ParaView opens it.

    Returns
    -------
    list of (float, Path)
        Times, s, and files; the files lie in the folder of the list or below it.

    Raises
    ------
    InputError
        If it is not such a list, names files elsewhere, or has a wrong checksum.
    OSError
        If it cannot be read.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     path = Path(folder) / "a.pvd"
    ...     entry = '<DataSet timestep="0.5" file="a.vtp"/>'
    ...     _ = path.write_text(f"<VTKFile><Collection>{entry}</Collection></VTKFile>")
    ...     [(time, file.name) for time, file in read_series(path)]
    [(0.5, 'a.vtp')]
    """
    path = Path(path)
    content = read_input(path)
    at = content.rfind(SEAL)
    if at >= 0 and content[at:] != SEAL + b"%08x -->\n" % zlib.crc32(content[:at]):
        raise InputError(f"{path}: damaged: its checksum is not that of its content")
    try:
        entries = ElementTree.fromstring(content).iterfind("Collection/DataSet")
        return [
            (float(entry.attrib["timestep"]), _inside(path.parent, entry.attrib["file"]))
            for entry in entries
        ]
    except (ValueError, LookupError, ElementTree.ParseError) as error:
        raise InputError(f"{path}: not a series of files: {error}") from None


def _inside(folder: Path, name: str) -> Path:
    relative = Path(name)
    if relative.is_absolute() or ".." in relative.parts:
        raise ValueError(f"{name!r} does not lie in its folder")
    return folder / relative
