"""The types of JSON data, and JSON data that cannot be changed."""

from __future__ import annotations

import copy
from typing import Any, Dict, List, NoReturn, Union

#: A result of `json.loads`.
JsonValue = Union[None, bool, int, float, str, List["JsonValue"], Dict[str, "JsonValue"]]
JsonObject = Dict[str, JsonValue]


def read_only(data: Any) -> Any:
    """Return JSON data that refuses every change; a deep copy of it may be changed.

    Examples
    --------
    >>> scene = read_only({"panel": {"tilt": 40.0}})
    >>> scene["panel"]["tilt"] = 50.0
    Traceback (most recent call last):
    TypeError: read-only data; copy.deepcopy gives data that may be changed
    >>> copy.deepcopy(scene)
    {'panel': {'tilt': 40.0}}
    """
    if isinstance(data, dict):
        return _ReadOnlyObject((key, read_only(value)) for key, value in data.items())
    if isinstance(data, list):
        return _ReadOnlyList(read_only(value) for value in data)
    return data


def _refuse(*_: object, **__: object) -> NoReturn:
    raise TypeError("read-only data; copy.deepcopy gives data that may be changed")


class _ReadOnlyObject(dict):  # type: ignore[type-arg]
    """A read-only JSON object. It is a dict, so that `json` writes it and type checks accept it."""

    __setitem__ = __delitem__ = __ior__ = _refuse
    clear = pop = popitem = setdefault = update = _refuse

    def __deepcopy__(self, memo: object) -> dict[str, Any]:
        return {key: copy.deepcopy(value) for key, value in self.items()}

    def __reduce__(self) -> Any:
        return read_only, (dict(self),)


class _ReadOnlyList(list):  # type: ignore[type-arg]
    """A read-only JSON array; it is a list for the same reasons."""

    __setitem__ = __delitem__ = __iadd__ = __imul__ = _refuse
    append = extend = insert = remove = pop = clear = sort = reverse = _refuse

    def __deepcopy__(self, memo: object) -> list[Any]:
        return [copy.deepcopy(value) for value in self]

    def __reduce__(self) -> Any:
        return read_only, (list(self),)
