"""TOML: read by the standard library, within limits, and written one value a line."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator, Mapping
from typing import Any

from snowshed._core import InputError
from snowshed.base.messages import shortened

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

# The library's time and memory grow with the square of these.
MAX_PARTS = 50  # parts of a dotted key
MAX_TABLES = 10_000
PART = r"""(?:[A-Za-z0-9_-]+|"[^"\n]*"|'[^'\n]*')"""
LONG_KEY = re.compile(rf"{PART}(?:[ \t]*\.[ \t]*{PART}){{{MAX_PARTS}}}")
BARE = re.compile(r"[A-Za-z0-9_-]+")


def parse_toml(content: bytes) -> dict[str, Any]:
    """Return the data of a TOML text.

    Raises
    ------
    InputError
        If the text is not TOML, has keys with too many parts, or too many tables.

    Examples
    --------
    >>> parse_toml(b"panel.tilt = 40")
    {'panel': {'tilt': 40}}
    """
    try:
        text = content.decode("utf-8-sig")  # programs of Windows begin files with a mark
        if long := LONG_KEY.search(text):
            line = text.count("\n", 0, long.start()) + 1
            raise InputError(f"not TOML: a key of more than {MAX_PARTS} parts (at line {line})")
        if text.count("\n[") > MAX_TABLES:
            raise InputError(f"not TOML: more than {MAX_TABLES} tables")
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:  # all errors of tomllib are ValueErrors
        if isinstance(error, InputError):
            raise
        raise InputError(f"not TOML: {shortened(str(error), 200)}") from None


def toml_value(value: object) -> str:
    """Return a value as TOML, in one line.

    Parameters
    ----------
    value
        Text, number, truth value, or a list or mapping of these; NumPy's scalars and arrays too.

    Raises
    ------
    InputError
        If TOML has no such value.

    Examples
    --------
    >>> print(toml_value([1, 2.5, "a", {"thickness": 0.1, "at": [True]}]))
    [1, 2.5, "a", {thickness = 0.1, at = [true]}]
    """
    if hasattr(value, "tolist"):  # a scalar or an array of NumPy
        value = value.tolist()
    if hasattr(value, "__fspath__"):
        value = value.__fspath__()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        # TOML has the escapes of JSON, and one more.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, Mapping):
        inner = ", ".join(f"{_key(str(key))} = {toml_value(item)}" for key, item in value.items())
        return f"{{{inner}}}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(toml_value, value))}]"
    raise InputError(f"{value!r} cannot be written as TOML")


def toml_lines(values: Mapping[str, object], prefix: str = "") -> Iterator[str]:
    """Yield a line for each value, nested mappings under dotted keys.

    Parameters
    ----------
    values
        Values by their keys, which may be dotted.
    prefix
        Text before every key.

    Examples
    --------
    >>> list(toml_lines({"panel": {"tilt": 40.0, "friction": 0.3}, "title": "a"}))
    ['panel.tilt = 40.0', 'panel.friction = 0.3', 'title = "a"']
    """
    for key, value in values.items():
        path = f"{prefix}{_key(key)}"
        if isinstance(value, Mapping) and value:
            yield from toml_lines(value, f"{path}.")
        else:
            yield f"{path} = {toml_value(value)}"


def _key(key: str) -> str:
    """Return a dotted key, with its parts quoted if TOML requires it."""
    return ".".join(part if BARE.fullmatch(part) else toml_value(part) for part in key.split("."))
