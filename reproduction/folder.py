"""The folder of a reproduction says what it is for, so that no other writes into it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Optional

from snowshed._core import InputError
from snowshed.io.atomic import write_text
from snowshed.io.json_file import read_object

IDENTITY = "reproduction.json"


def claim_folder(
    path: Path, identity: Mapping[str, str], former: Optional[Mapping[str, str]] = None
) -> None:
    """Take a folder, old or new, for a reproduction.

    Parameters
    ----------
    path
        The folder.
    identity
        Names and values of the options that decide what is in it.
    former
        Values of those that older folders do not name.

    Raises
    ------
    InputError
        If it holds a reproduction with other options, or something else.
    """
    file = path / IDENTITY
    if file.is_file():
        there = {**(former or {}), **read_object(file)}
        for name, value in identity.items():
            found = there.get(name)
            if found != value:
                options = [option(name, str(one)) for one in (found, value)]
                raise InputError(
                    f"{path}: holds a reproduction with {options[0]}; "
                    f"take a new folder for {options[1]}"
                )
    elif path.exists() and (not path.is_dir() or any(path.iterdir())):
        raise InputError(f"{path}: not empty, and holds no reproduction")
    else:
        path.mkdir(parents=True, exist_ok=True)
        write_text(file, json.dumps(dict(identity)) + "\n")


def option(name: str, value: str) -> str:
    """Return an option as it is given; sizes and publications are words of their own.

    Examples
    --------
    >>> option("size", "full"), option("condition", "slip")
    ('--full', '--condition slip')
    """
    if name == "publication":
        return value
    return f"--{value}" if name == "size" else f"--{name} {value}"
