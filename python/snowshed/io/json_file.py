"""JSON objects in files that may be damaged."""

from __future__ import annotations

import json
import sys
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from snowshed._core import InputError
from snowshed.base.messages import shortened
from snowshed.io.input_file import read_input
from snowshed.io.json_text import loads

#: Beginning of an object's last value, its checksum, as the core writes it.
SEAL = b',\n  "checksum": "'

MAX_LINES = 200  # lines of a value in a sealed object

#: Names of the required types of JSON values.
KINDS = {dict: "an object", list: "a list", str: "a text", float: "a finite number"}


def parse_object(text: str | bytes, where: str) -> dict[str, Any]:
    """Return the JSON object in a text.

    Raises
    ------
    InputError
        If the text is not an object, a key occurs twice, or the checksum is wrong; the message
        names `where`, the source of the text.

    Examples
    --------
    >>> parse_object('{"wall_s": 2.5}', "run.json")
    {'wall_s': 2.5}
    """
    try:
        data = loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{where}: damaged: {shortened(str(error), 200)}") from None
    if not isinstance(data, dict):
        raise InputError(f"{where}: damaged: not a JSON object")
    check_seal(text if isinstance(text, bytes) else text.encode(), where)
    return data


def sealed(data: Mapping[str, Any]) -> str:
    """Return the text of an object with its checksum; a long value stands in one line.

    A checksum that the object has from a file is replaced.

    Examples
    --------
    >>> print(sealed({"wall_s": 2.5}), end="")
    {
      "wall_s": 2.5,
      "checksum": "e0ffe2c4"
    }
    """
    values = (
        f"  {json.dumps(key)}: {_value_text(value)}"
        for key, value in data.items()
        if key != "checksum"
    )
    text = "{\n" + ",\n".join(values) + SEAL.decode()
    content = text.encode()[: -len(SEAL)]
    return f'{text}{zlib.crc32(content):08x}"\n}}\n'


def _value_text(value: Any) -> str:
    text = json.dumps(value, indent=2, allow_nan=False, default=plain_value)
    if text.count("\n") < MAX_LINES:
        return text.replace("\n", "\n  ")
    return json.dumps(value, default=plain_value)


def plain_value(value: Any) -> Any:
    """Return an array, a path or a part of a scene as JSON data, for `json.dumps`.

    Examples
    --------
    >>> import numpy as np
    >>> json.dumps([np.float32(0.5), np.arange(2)], default=plain_value)
    '[0.5, [0, 1]]'
    """
    for name in ("to_data", "tolist", "__fspath__"):
        if hasattr(value, name):
            return getattr(value, name)()
    raise TypeError(f"JSON has no value of the type {type(value).__name__}")


def check_seal(text: bytes, where: str) -> None:
    """Raise InputError if a text's checksum is wrong."""
    at = text.rfind(SEAL)
    if at >= 0 and text[at:] != SEAL + b'%08x"\n}\n' % zlib.crc32(text[:at]):
        raise InputError(f"{where}: damaged: its checksum is not that of its content")


def read_object(path: Path) -> dict[str, Any]:
    """Return the JSON object in a file; see `parse_object`."""
    return parse_object(read_input(path), str(path))


def check_values(data: Any, kinds: Mapping[str, type], where: str) -> None:
    """Raise InputError unless JSON data is an object with these keys and kinds of values.

    Parameters
    ----------
    data
        The data.
    kinds
        For every key one of `KINDS`.
    where
        Position of the data, for the message.

    Examples
    --------
    >>> check_values({"wall_s": 2.5, "machine": "a"}, {"wall_s": float}, "run.json")
    """
    if not isinstance(data, dict):
        raise InputError(f"{where}: damaged: not a JSON object")
    for key, kind in kinds.items():
        if key not in data:
            raise InputError(f"{where}: damaged: /{key} is missing")
        if not (is_number(data[key]) if kind is float else isinstance(data[key], kind)):
            shown = shortened(json.dumps(data[key]))
            raise InputError(f"{where}: damaged: /{key}: {shown} is not {KINDS[kind]}")


def is_number(value: Any) -> bool:
    """Return whether JSON data is a number that a float can hold.

    Examples
    --------
    >>> [is_number(value) for value in (1, 2.5, True, "1", float("nan"), 10**400)]
    [True, True, False, False, False, False]
    """
    numeric = isinstance(value, (int, float)) and not isinstance(value, bool)
    return numeric and abs(value) <= sys.float_info.max
