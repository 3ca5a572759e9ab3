"""Types of a record's fields: accepted values, and their stored form.

A type is an annotation such as ``Optional[float]``; None means "not given" and is always allowed.
"""

from __future__ import annotations

import os
import sys
import typing
from collections.abc import Callable, Mapping, Sequence
from typing import Literal, Union

from snowshed._core import InputError
from snowshed.base.messages import shortened, suggestion

#: Result of `convert` for a value of another type.
MISMATCH = object()


def convert(value: object, hint: object, where: str) -> object:
    """Return a value in the form in which a field of type `hint` keeps it.

    NumPy's scalars and arrays become Python's, lists of numbers become tuples, paths become texts,
    and mappings become records where the field holds records.

    Parameters
    ----------
    value
        The value to store.
    hint
        The field's annotation, evaluated.
    where
        Name of the field in messages.

    Raises
    ------
    InputError
        If the field does not take such a value.

    Examples
    --------
    >>> convert([1, 2.5], typing.Optional[Sequence[float]], "/panel/center")
    (1, 2.5)
    >>> convert("slp", Literal["sticky", "slip"], "/panel/condition")
    Traceback (most recent call last):
    snowshed._core.InputError: /panel/condition: 'slp' is none of sticky, slip; did you mean slip?
    """
    if value is None:
        return None
    if hasattr(value, "tolist"):  # a scalar or an array of NumPy
        value = value.tolist()
    alternatives = alternatives_of(hint)
    for kind in alternatives:
        converted = _as(kind, value, where)
        if converted is not MISMATCH:
            return converted
    raise InputError(f"{where}: {shown(value)} is {_expected(alternatives, value)}")


def alternatives_of(hint: object) -> tuple[object, ...]:
    """Return the types that a field may hold, without None.

    Examples
    --------
    >>> alternatives_of(typing.Optional[float])
    (<class 'float'>,)
    """
    if typing.get_origin(hint) is Union:
        return tuple(kind for kind in typing.get_args(hint) if kind is not type(None))
    return (hint,)


def is_record(kind: object) -> bool:
    """Return whether a type is a class of records."""
    return hasattr(kind, "from_data")


def shown(value: object) -> str:
    """Return a value for a message, in one line and not long."""
    if isinstance(value, int) and not isinstance(value, bool) and value.bit_length() > 1000:
        return f"an integer of {value.bit_length()} bits"
    try:
        return shortened(repr(value))
    except (RecursionError, ValueError):
        return f"a {type(value).__name__}"


def _as(kind: object, value: object, where: str) -> object:
    """Return the value as a field of one type keeps it, or `MISMATCH`."""
    if is_record(kind):
        return _as_record(kind, value, where)
    origin = typing.get_origin(kind)
    if origin is Literal:
        return value if value in typing.get_args(kind) else MISMATCH
    if origin is not None and issubclass(origin, Sequence):
        return _as_sequence(origin, typing.get_args(kind)[0], value, where)
    return _SCALARS[kind](value, where)


def _as_record(kind: typing.Any, value: object, where: str) -> object:
    if isinstance(value, Mapping):
        return kind.from_data(value, where)
    return value if isinstance(value, kind) else MISMATCH


def _as_sequence(origin: type, item: object, value: object, where: str) -> object:
    """Return a list of records, which callers may change, or a tuple of numbers."""
    if not isinstance(value, (list, tuple)):
        return MISMATCH
    items = []
    for i, entry in enumerate(value):
        if entry is None:
            raise InputError(f"{where}/{i}: None is {_expected((item,), entry)}")
        items.append(convert(entry, item, f"{where}/{i}"))
    return items if origin is list else tuple(items)


def _as_number(value: object, where: str) -> object:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return MISMATCH
    if not abs(value) <= sys.float_info.max:
        raise InputError(f"{where}: {shown(value)} is not a finite number")
    return value


def _as_integer(value: object, where: str) -> object:
    """Return a whole number; 5.0 counts as one, as in JSON Schema."""
    number = _as_number(value, where)
    if isinstance(number, float):
        return int(number) if number.is_integer() else MISMATCH
    return number


def _as_flag(value: object, where: str) -> object:
    return value if isinstance(value, bool) else MISMATCH


def _as_text(value: object, where: str) -> object:
    if not isinstance(value, str):
        return MISMATCH
    if any("\ud800" <= c <= "\udfff" for c in value):
        raise InputError(f"{where}: {shown(value)} is not text: it has half a surrogate pair")
    return value


def _as_path(value: object, where: str) -> object:
    if not isinstance(value, os.PathLike):
        return MISMATCH
    return _as_text(os.fspath(value), where)


_SCALARS: Mapping[object, Callable[[object, str], object]] = {
    float: _as_number,
    int: _as_integer,
    bool: _as_flag,
    str: _as_text,
    os.PathLike[str]: _as_path,
}
_WORDS: Mapping[object, str] = {
    float: "a number",
    int: "a whole number",
    bool: "true or false",
    str: "a text",
    os.PathLike[str]: "a path",
}


def _expected(alternatives: Sequence[object], value: object) -> str:
    """Return the end of the message for a value of a wrong type."""
    choices = [name for kind in alternatives for name in _choices(kind)]
    if choices:
        near = suggestion(value, choices) if isinstance(value, str) else ""
        return f"none of {', '.join(choices)}{near}"
    return "not " + " or ".join(_word(kind) for kind in alternatives)


def _choices(kind: object) -> tuple[str, ...]:
    return typing.get_args(kind) if typing.get_origin(kind) is Literal else ()


def _word(kind: object) -> str:
    if is_record(kind):
        return f"an object such as {getattr(kind, '__name__', kind)}(...)"
    arguments = typing.get_args(kind)
    if kind in _WORDS or not arguments:
        return _WORDS[kind]
    return "a list" if is_record(arguments[0]) else "a vector such as (1.0, 0.0, 0.0)"
