"""The types of arguments of public functions, checked by their annotations."""

from __future__ import annotations

import functools
import inspect
import numbers
import operator
import os
import sys
import types
import typing
from collections.abc import Callable, Collection, Iterable, Mapping
from pathlib import PurePath
from typing import Literal, TypeVar, Union

from snowshed._core import InputError
from snowshed.base.field_type import shown
from snowshed.base.paths import with_home
from snowshed.base.record import Record

Checked = TypeVar("Checked", bound=Callable[..., object])


def checked(public: Checked) -> Checked:
    """Decorate a function, or a class and its public methods: they refuse arguments of wrong types.

    The annotations say which types are allowed. Types that only type checkers import are not
    checked. In file names, ``~`` becomes the user's home.

    Examples
    --------
    >>> @checked
    ... def draw(width: float, *, pictures: bool = True) -> None: ...
    >>> draw(True)
    Traceback (most recent call last):
    snowshed._core.InputError: width: True; needed: a number
    >>> draw(1, pictures="no")
    Traceback (most recent call last):
    snowshed._core.InputError: pictures: 'no'; needed: True or False
    """
    if not isinstance(public, type):
        return typing.cast(Checked, _checking(public))
    for name, member in list(vars(public).items()):
        own = name == "__init__" and not issubclass(public, Record)  # which checks its fields
        if name.startswith("_") and not own:
            continue
        if isinstance(member, (classmethod, staticmethod)):
            setattr(public, name, type(member)(_checking(member.__func__)))
        elif inspect.isfunction(member):
            setattr(public, name, _checking(member))
    return public


def check_type(name: str, value: object, kind: object) -> None:
    """Raise InputError if the argument `name` is not of a type.

    Examples
    --------
    >>> check_type("count", 1.5, int)
    Traceback (most recent call last):
    snowshed._core.InputError: count: 1.5; needed: a whole number
    """
    if not _fits(value, kind):
        needed = " or ".join(dict.fromkeys(_words(each) for each in _alternatives(kind)))
        plain = isinstance(value, (str, int, float, list, tuple, type(None)))
        given = shown(value) if plain else f"a value of type {type(value).__name__}"
        raise InputError(f"{name}: {given}; needed: {needed}{_as_call(value, kind)}")
    if isinstance(value, (list, tuple, dict)):
        _check_items(name, value, kind)


def _check_items(name: str, value: Collection[object], kind: object) -> None:
    """Check the keys and the items of a dictionary, or the items of a list or tuple."""
    keyed = isinstance(value, dict)
    holders = [each for each in _alternatives(kind) if _holds_items(each, keyed=keyed)]
    if not holders:
        return
    keys = tuple(typing.get_args(each)[0] for each in holders)
    every = tuple(kind for each in holders for kind in typing.get_args(each) if kind is not ...)
    items = tuple(typing.get_args(each)[-1] for each in holders) if keyed else every
    for at, item in value.items() if isinstance(value, dict) else enumerate(value):
        if keyed:
            check_type(f"a key of {name}", at, Union[keys])
        if type(item) not in items:
            check_type(f"{name}[{at!r}]", item, Union[items])


def _holds_items(kind: object, *, keyed: bool) -> bool:
    """Return whether a type is that of dictionaries, or else of sequences, with known items."""
    origin = typing.get_origin(kind)
    if not (isinstance(origin, type) and typing.get_args(kind) and _is_plain(origin)):
        return False
    if keyed:
        return issubclass(origin, Mapping)
    return issubclass(origin, Iterable) and not issubclass(origin, Mapping)


def is_flag(value: object) -> bool:
    """Return whether a value is a boolean of Python or NumPy."""
    return type(value).__name__ in ("bool", "bool_")


def is_number(value: object) -> bool:
    """Return whether a value is a real number, not a boolean or a text.

    Examples
    --------
    >>> [is_number(value) for value in (1, 2.5, True, "3", None)]
    [True, True, False, False, False]
    """
    if is_flag(value):
        return False
    kind = getattr(getattr(value, "dtype", None), "kind", "")
    scalar = getattr(value, "ndim", None) == 0 and kind in ("i", "u", "f")
    return scalar or isinstance(value, numbers.Real)


def is_integer(value: object) -> bool:
    """Return whether a value is an integer, not a boolean."""
    try:
        operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        return False
    return not is_flag(value)


def _checking(function: Callable[..., object]) -> Callable[..., object]:
    """Return a function that checks the arguments, and then calls another function."""
    parameters = inspect.signature(function).parameters.values()
    positions = [each.name for each in parameters if each.kind is not each.KEYWORD_ONLY]
    named = {each.name: each for each in parameters if each.kind is not each.VAR_KEYWORD}

    @functools.cache
    def kinds() -> Mapping[str, object]:
        return {name: _kind_of(each, function) for name, each in named.items()}

    def accepted(name: str, value: object) -> object:
        if name not in named or value is named[name].default:
            return value
        kind = kinds()[name]
        if type(value) is kind:
            return value
        check_type(name, value, kind)
        return _with_home(value, kind)

    @functools.wraps(function)
    def call(*values: object, **keywords: object) -> object:
        given = [accepted(name, value) for name, value in zip(positions, values)]
        by_name = {name: accepted(name, value) for name, value in keywords.items()}
        return function(*given, *values[len(given) :], **by_name)

    return call


def _kind_of(parameter: inspect.Parameter, function: Callable[..., object]) -> object:
    """Return the type of a parameter; `object` if only type checkers know it."""
    kind = parameter.annotation
    if parameter.kind is parameter.VAR_POSITIONAL or kind is parameter.empty:
        return object
    names = vars(sys.modules[function.__module__])
    try:
        return eval(kind, {**_LIBRARIES, **names}) if isinstance(kind, str) else kind
    except (NameError, AttributeError, TypeError):
        return object


class _ByName(type):
    """A class of a library that is not imported, in an annotation; it is known by its name."""

    def __getattr__(cls, name: str) -> _ByName:
        if name.startswith("_"):
            raise AttributeError(name)
        return _ByName(name, (), {})

    def __getitem__(cls, item: object) -> _ByName:
        return cls


#: Libraries that only type checkers import, as their modules are called.
_LIBRARIES = {name: _ByName(name, (), {}) for name in ("pd", "xarray", "xr")}


#: The origins of ``Union[A, B]`` and of ``A | B``.
_UNIONS = (Union, getattr(types, "UnionType", Union))


def _alternatives(kind: object) -> tuple[object, ...]:
    kind = _behind_name(kind)
    if typing.get_origin(kind) not in _UNIONS:
        return (kind,)
    return tuple(each for part in typing.get_args(kind) for each in _alternatives(part))


def _behind_name(kind: object) -> object:
    """Return the type behind a name such as that of NumPy 2.5 for what may be an array."""
    behind = getattr(typing.get_origin(kind) or kind, "__value__", None)
    if behind is None:
        return kind
    arguments = typing.get_args(kind)
    return behind[arguments] if arguments else behind


def _fits(value: object, kind: object) -> bool:
    return any(_fits_one(value, each) for each in _alternatives(kind))


def _fits_one(value: object, kind: object) -> bool:
    if kind in _TESTS:
        return _TESTS[kind](value)
    if isinstance(kind, typing.ForwardRef):
        library, _, name = kind.__forward_arg__.partition(".")
        kind = _ByName(name, (), {}) if library in _LIBRARIES else object
    if isinstance(kind, _ByName):
        return any(own.__name__ == kind.__name__ for own in type(value).__mro__)
    origin = typing.get_origin(kind) or kind
    if origin is Literal:
        return isinstance(value, type(typing.get_args(kind)[0]))
    if not isinstance(origin, type) or origin is object or getattr(origin, "_is_protocol", False):
        return True
    if origin.__module__ == "numpy":
        return not isinstance(value, (str, bytes, Mapping)) and value is not None
    if origin.__name__ == "Callable":
        return callable(value)
    if origin is Mapping:
        return hasattr(value, "keys")  # also a DataFrame
    if issubclass(origin, Iterable) and not issubclass(origin, Mapping) and _is_plain(origin):
        return isinstance(value, Iterable) and not isinstance(value, (str, bytes, Mapping))
    return isinstance(value, origin)


def _is_plain(kind: type) -> bool:
    """Return whether a type is a list or another sequence, for which any sequence will do."""
    return kind.__module__ in ("builtins", "collections.abc")


_TESTS: Mapping[object, Callable[[object], bool]] = {
    bool: is_flag,
    int: is_integer,
    float: is_number,
    str: lambda value: isinstance(value, str),
    type(None): lambda value: value is None,
}
_WORDS: Mapping[object, str] = {
    bool: "True or False",
    int: "a whole number",
    float: "a number",
    str: "a text",
    type(None): "None",
    Callable: "a function",
    Mapping: "a dict",
    os.PathLike: "a path",
}


def _words(kind: object) -> str:
    """Return a type as a text."""
    if isinstance(kind, typing.ForwardRef):
        return kind.__forward_arg__.rpartition(".")[2]
    origin = typing.get_origin(kind) or kind
    if kind in _WORDS or origin in _WORDS:
        return _WORDS.get(kind) or _WORDS[origin]
    if origin is Literal:
        return " or ".join(map(repr, typing.get_args(kind)))
    if isinstance(origin, type) and (_is_plain(origin) or origin.__module__ == "numpy"):
        return "a sequence"
    return getattr(kind, "__name__", str(kind))


def _as_call(value: object, kind: object) -> str:
    """Return the call that makes an object of a dictionary's values, as an example."""
    classes = [each for each in _alternatives(kind) if isinstance(each, type)]
    own = [each for each in classes if each.__module__.startswith("snowshed")]
    if not (isinstance(value, Mapping) and own):
        return ""
    values = ", ".join(f"{name}={entry!r}" for name, entry in value.items())
    return f", such as {own[0].__name__}({values[:60]})"


def _with_home(value: object, kind: object) -> object:
    """Return a value, file names (also in a list) with the user's home in place of ``~``."""
    if not any(_is_path(each) or _holds_paths(each) for each in _alternatives(kind)):
        return value
    if isinstance(value, (list, tuple)):
        return type(value)(map(_path_with_home, value)) if type(value) in (list, tuple) else value
    return _path_with_home(value)


def _is_path(kind: object) -> bool:
    return typing.get_origin(kind) is os.PathLike


def _holds_paths(kind: object) -> bool:
    if not _holds_items(kind, keyed=False):
        return False
    return any(_is_path(each) for item in typing.get_args(kind) for each in _alternatives(item))


def _path_with_home(value: object) -> object:
    if isinstance(value, os.PathLike):
        return type(value)(with_home(os.fspath(value))) if isinstance(value, PurePath) else value
    return with_home(value) if isinstance(value, str) else value
