"""Texts from files and callers, made safe for display.

Texts may hold commands to a terminal, marks that change the writing direction, or formulas of a
spreadsheet.
"""

from __future__ import annotations

import re

#: Control characters (but tab and end of line), line separators, marks and overrides of the
#: direction, and what stands for bytes of names that are no UTF-8.
HARMFUL = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069\ud800-\udfff]"
)
FORMULA = ("=", "+", "-", "@", "\t", "\r")  # what a cell begins with that spreadsheets compute


def printable(text: object) -> str:
    r"""Return a text as a terminal or a page may show it; what would do harm becomes "?".

    Examples
    --------
    >>> printable("\x1b[31mred.stl")
    '?[31mred.stl'
    """
    return HARMFUL.sub("?", str(text))


def csv_cell(value: object) -> object:
    """Return a cell as a spreadsheet may open it; a text that it would compute is quoted.

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
