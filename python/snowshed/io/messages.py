"""Text from files in error messages, which stay one line to read whatever a file holds."""

from __future__ import annotations

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
