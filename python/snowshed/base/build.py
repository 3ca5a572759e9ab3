"""The build of snowshed: what the compiled core and the package were made of."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

import snowshed._core as _core

DIGITS = 12  # hexadecimal: 48 bits


@cache
def package_digest() -> str:
    """Return a digest of the package's Python modules, 12 hexadecimal digits."""
    package = Path(__file__).parents[1]
    content = hashlib.sha256()
    for name in sorted(path.relative_to(package).as_posix() for path in package.rglob("*.py")):
        content.update(name.encode() + b"\0" + (package / name).read_bytes() + b"\0")
    return content.hexdigest()[:DIGITS]


def build_id() -> str:
    """Return the build: digests of the core's sources and of the package's modules.

    Examples
    --------
    >>> core, package = build_id().split("-")
    >>> core == _core.build_id, len(package)
    (True, 12)
    """
    return f"{_core.build_id}-{package_digest()}"
