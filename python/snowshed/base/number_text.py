"""Numbers in text files: a cell must be a number, and nothing else."""

from __future__ import annotations

import math
import re

NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
LONGEST = 400  # characters


def number_in(text: str) -> float:
    """Return the number in a text; NaN if the text is not a finite number.

    Unlike ``float``, it accepts no digits of other scripts, no underscores and no words.

    Examples
    --------
    >>> number_in("-1.5e3"), number_in(" 2 "), number_in("1_000"), number_in("1e999")
    (-1500.0, 2.0, nan, nan)
    """
    text = text.strip(" \t")
    if len(text) > LONGEST or not NUMBER.fullmatch(text):
        return math.nan
    value = float(text)
    return value if math.isfinite(value) else math.nan
