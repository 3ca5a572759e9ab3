"""Texts from files and callers, made harmless for messages, terminals and tables.

Such texts may be long. They may contain commands to a terminal, characters that reverse the
direction of writing, or formulas for a spreadsheet.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable

MAX_LENGTH = 60  # characters
#: Control characters (except tab and end of line), line separators, marks and overrides of the
#: direction of writing, and substitutes for bytes of names that are not UTF-8.
HARMFUL = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]"
)
FORMULA = ("=", "+", "-", "@", "\t", "\r")  # beginnings of cells that spreadsheets compute


def shortened(text: str, longest: int = MAX_LENGTH) -> str:
    """Return a text, truncated after `longest` characters.

    Examples
    --------
    >>> shortened("a, b, c, d", 4)
    'a, b...'
    """
    return text if len(text) <= longest else f"{text[:longest]}..."


def quoted(text: str) -> str:
    """Return a text in quotes, truncated if it is long.

    Examples
    --------
    >>> quoted("lots")
    "'lots'"
    >>> len(quoted("[" * 20_000))
    65
    """
    return repr(text[:MAX_LENGTH]) + ("" if len(text) <= MAX_LENGTH else "...")


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


def printable(text: object) -> str:
    r"""Return a text for a terminal or a page; harmful characters become "?".

    Examples
    --------
    >>> printable("\x1b[31mred.stl")
    '?[31mred.stl'
    """
    return HARMFUL.sub("?", str(text))


def csv_cell(value: object) -> object:
    """Return a cell for a spreadsheet; a text that a spreadsheet would compute is quoted.

    Examples
    --------
    >>> csv_cell("=HYPERLINK(A1)"), csv_cell(-1.5), csv_cell("rest"), csv_cell("-1.5")
    ("'=HYPERLINK(A1)", -1.5, 'rest', '-1.5')
    """
    if not isinstance(value, str):
        return value
    shown = printable(value)
    return f"'{shown}" if shown.startswith(FORMULA) and not _is_number(shown) else shown


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
