"""Folders for results: new, empty, or already used by the same work."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Optional

from snowshed._core import InputError
from snowshed.base.callers import argument
from snowshed.base.paths import PathLike
from snowshed.io.atomic import LEFTOVER, write_text
from snowshed.io.json_file import read_object


def check_empty(folder: PathLike, otherwise: Optional[str] = None) -> None:
    """Raise InputError unless results may be written to `folder`: it is new, or empty.

    Leftovers of killed processes do not count. `otherwise` ends the message of a folder that is
    not empty.
    """
    if otherwise is None:
        otherwise = f"; choose a new folder, or resume the run with {argument('resume', True)}"
    folder = Path(folder)
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder}: not a folder")
    if folder.is_dir() and any(not LEFTOVER.match(path.name) for path in folder.iterdir()):
        raise InputError(f"{folder}: not empty{otherwise}")


def claim_folder(
    folder: PathLike, file: str, identity: Mapping[str, Any], what: str, others: str
) -> None:
    """Claim a folder for some work, or continue in the folder of the same work.

    Parameters
    ----------
    folder
        The folder; new or empty, unless it holds `file`.
    file
        Name of the file in it that holds the identity of the work.
    identity
        JSON data that decides the content of the folder.
    what, others
        Name of the work, and the difference of work with another identity, for messages.

    Raises
    ------
    InputError
        If the folder holds the identity of other work, or other files.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     claim_folder(folder, "work.json", {"size": 1}, "work", "of another size")
    ...     claim_folder(folder, "work.json", {"size": 1}, "work", "of another size")
    """
    folder = Path(folder)
    path = folder / file
    if path.is_file():
        if read_object(path) != identity:
            raise InputError(f"{folder}: holds a {what} {others}; take a new folder")
        return
    check_empty(folder, f", and holds no {what}")
    folder.mkdir(parents=True, exist_ok=True)
    write_text(path, json.dumps(identity, indent=1) + "\n")
