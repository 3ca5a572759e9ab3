"""The text of JSON, with a check that `json.loads` omits: repeated keys."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any, Union

#: A string, a number or word, or a sign, in a text that `json.loads` takes.
_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|[{}\[\]:,]|[^\s{}\[\]:,"]+')


class _RepeatedKeyError(ValueError):
    """Error of an object in which a key occurs twice."""


def loads(text: Union[str, bytes]) -> Any:
    r"""Return the data in a JSON text.

    Raises
    ------
    ValueError
        If it is not JSON, or a key occurs twice in an object; the message names the line.
    RecursionError
        If it is nested too deep.

    Examples
    --------
    >>> loads('{"a": [1, 2]}')
    {'a': [1, 2]}
    >>> loads('{"a": {"b": 1,\n"b": 2}}')
    Traceback (most recent call last):
    ...
    ValueError: /a/b: this key appears twice, the second time in line 2
    """
    try:
        return json.loads(text, object_pairs_hook=_object)
    except _RepeatedKeyError:
        decoded = text if isinstance(text, str) else text.decode(json.detect_encoding(text))
        path, line = next(_repeated_keys(decoded))
        message = f"{path}: this key appears twice, the second time in line {line}"
    raise ValueError(message)


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    mapping = dict(pairs)
    if len(mapping) < len(pairs):
        raise _RepeatedKeyError
    return mapping


def _repeated_keys(text: str) -> Iterator[tuple[str, int]]:
    """Yield path and line of repeated keys in a valid text."""
    names: list[Union[str, int]] = []  # path from the root to the current position
    seen: list[set[str]] = []  # keys of the enclosing objects, and indices of the lists
    before = ""
    for token in _TOKEN.finditer(text):
        sign = token.group()
        if sign in "{[":
            seen.append(set())
            names.append(0 if sign == "[" else "")
        elif sign in "}]":
            seen.pop()
            names.pop()
        elif sign == "," and isinstance(names[-1], int):
            names[-1] += 1
        elif sign == ":":
            key = str(json.loads(before))
            names[-1] = key
            if key in seen[-1]:
                steps = (str(name).replace("~", "~0").replace("/", "~1") for name in names)
                yield "/" + "/".join(steps), text.count("\n", 0, token.start()) + 1
            seen[-1].add(key)
        before = sign
