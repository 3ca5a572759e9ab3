"""JSON objects in files that somebody may have damaged."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from snowshed._core import InputError
from snowshed.quoting import shortened


def parse_object(text: str | bytes, where: str) -> dict[str, Any]:
    """Return the JSON object in a text.

    Raises
    ------
    InputError
        If it holds anything else, naming `where` it is.

    Examples
    --------
    >>> parse_object('{"wall_s": 2.5}', "run.json")
    {'wall_s': 2.5}
    """
    try:
        found = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{where}: damaged: {shortened(str(error), 200)}") from None
    if not isinstance(found, dict):
        raise InputError(f"{where}: damaged: not a JSON object")
    return found


def read_object(path: Path) -> dict[str, Any]:
    """Return the JSON object in a file; see `parse_object`."""
    return parse_object(path.read_bytes(), str(path))
