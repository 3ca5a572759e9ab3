"""Text from files in error messages, shortened to a readable line."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

LONGEST = 60  # characters


def shortened(text: str, longest: int = LONGEST) -> str:
    """Return text without its end where it is long.

    Examples
    --------
    >>> shortened("a, b, c, d", 4)
    'a, b...'
    """
    return text if len(text) <= longest else f"{text[:longest]}..."


def quoted(text: str) -> str:
    """Return text in quotes, without its end where it is long.

    Examples
    --------
    >>> quoted("lots")
    "'lots'"
    >>> len(quoted("[" * 20_000))
    65
    """
    return repr(text[:LONGEST]) + ("" if len(text) <= LONGEST else "...")


def suggestion(given: str, allowed: Iterable[str]) -> str:
    """Return "; did you mean ...?" with the word nearest to `given`, or nothing if none is near.

    Examples
    --------
    >>> suggestion("tlit", ["tilt", "length"]), suggestion("DX", ["dx"]), suggestion("x", ["tilt"])
    ('; did you mean tilt?', '; did you mean dx?', '')
    """
    by_lower = {word.lower(): word for word in allowed}
    near = difflib.get_close_matches(given.lower(), by_lower, n=1)
    return f"; did you mean {by_lower[near[0]]}?" if near else ""
