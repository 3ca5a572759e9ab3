"""Digests of compiled functions: whether two laws of one name have the same code.

A function of numba is known by its source, with the values that it takes from outside; a function
of a shared library by the content of the library and its place in it. Other functions, such as
Python's behind `ctypes`, have no digest.
"""

from __future__ import annotations

import hashlib
import inspect
import textwrap
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import CodeType
from typing import Any, Optional

MAPS = Path("/proc/self/maps")


def code_digest(function: object, address: int) -> Optional[str]:
    """Return a digest of a function's code; None if its code is unknown.

    Parameters
    ----------
    function
        The function, of numba or of ctypes, or its address.
    address
        Its address in this process.

    Examples
    --------
    >>> import ctypes
    >>> sine, cosine = ctypes.CDLL("libm.so.6").sin, ctypes.CDLL("libm.so.6").cos
    >>> places = [ctypes.cast(f, ctypes.c_void_p).value for f in (sine, sine, cosine)]
    >>> same, again, other = (code_digest(place, place) for place in places)
    >>> same == again, same == other
    (True, False)
    """
    source = getattr(function, "__wrapped__", None)
    if inspect.isfunction(source):
        return _digest(_facts_of_python(source, set()))
    return _digest_of_library(address)


def joint_digest(digests: Mapping[str, Optional[str]]) -> Optional[str]:
    """Return a digest of several functions by their names; None if one is unknown."""
    if None in digests.values():
        return None
    return _digest(f"{name} {digest}" for name, digest in sorted(digests.items()))


def _digest(parts: Iterator[str]) -> str:
    hashed = hashlib.sha256()
    for part in parts:
        hashed.update(part.encode() + b"\0")
    return hashed.hexdigest()[:16]


def _facts_of_python(function: Any, seen: set[int]) -> Iterator[str]:
    """Yield the source of a function, and the values and functions that it takes from outside."""
    if id(function) in seen:
        return
    seen.add(id(function))
    code: CodeType = function.__code__
    try:
        yield textwrap.dedent(inspect.getsource(function))
    except (OSError, TypeError):  # typed into an interpreter
        yield f"{code.co_code.hex()} {code.co_consts!r}"
    closure = inspect.getclosurevars(function)
    for name, value in sorted({**closure.globals, **closure.nonlocals}.items()):
        yield name
        inner = getattr(value, "py_func", value)  # of numba's dispatchers
        if inspect.isfunction(inner):
            yield from _facts_of_python(inner, seen)
        elif hasattr(value, "tobytes"):
            yield f"{value!r} {value.tobytes().hex()}"
        else:
            yield _text_of(value)


def _text_of(value: object) -> str:
    """Return the value of a number or a text; of other things their type."""
    if isinstance(value, (bool, int, float, complex, str, tuple)):
        return repr(value)
    return str(getattr(value, "__name__", type(value).__name__))


def _digest_of_library(address: int) -> Optional[str]:
    """Return a digest of the library that has a function, and of its place in it."""
    for line in MAPS.read_text(encoding="utf-8", errors="surrogateescape").splitlines():
        span, _, offset, _, _, *name = line.split(maxsplit=5)
        first, last = (int(limit, 16) for limit in span.split("-"))
        if not first <= address < last:
            continue
        file = Path(name[0]) if name else None
        if file is None or not file.is_file():
            return None
        content = hashlib.sha256(file.read_bytes()).hexdigest()
        return _digest(iter((content, str(address - first + int(offset, 16)))))
    return None
