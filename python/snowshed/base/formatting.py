"""Numbers, shares and durations as text."""

from __future__ import annotations

import math
import re
from math import inf, isnan
from typing import Optional

#: Text for a missing number.
MISSING = "\N{EN DASH}"
TIMES = "\N{MULTIPLICATION SIGN}"
SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
#: Smaller shares are written as plain numbers, not in percent.
MIN_PERCENT_SHARE = 1e-5
#: Units of an estimate: used below this number of seconds; seconds per unit; name; decimals.
UNITS_OF_TIME = (
    (100, 1, "s", 0),
    (6000, 60, "min", 1),
    (172800, 3600, "h", 1),
    (inf, 86400, "days", 1),
)
NUMBER = re.compile(r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?")
MAX_NUMBER = 400  # characters
#: Numbers that programs write for a missing value; none of them is weather.
MARKS_OF_MISSING = (
    *(-99.0, -99.9, -777.0, -999.0, -999.9, -6999.0, -7999.0, -9999.0, -99999.0, -32768.0),
    *(99.9, 999.0, 999.9, 9999.0, 9999.9, 99999.0, 32767.0),
)


def exact(value: float) -> str:
    """Return a number for a file: short, and the same number when it is read.

    Examples
    --------
    >>> exact(40.0), exact(0.025), exact(38.65980825)
    ('40', '0.025', '38.65980825')
    """
    short = f"{value:g}"
    return short if float(short) == value else repr(float(value))


def number(value: Optional[float], digits: int = 3) -> str:
    """Return a number with a few significant digits, very large and small ones with powers of ten.

    Examples
    --------
    >>> [number(x) for x in (0.123456, 12.0, 0.0, 123456.0)]
    ['0.123', '12', '0', '123,000']
    """
    if value is None or isnan(value):
        return MISSING
    text = f"{value:.{digits}g}"
    if "e" in text and 1.0 <= abs(float(text)) < 1e6:
        return f"{float(text):,.0f}"
    if "e" in text:
        mantissa, _, exponent = text.partition("e")
        power = f"10{str(int(exponent)).translate(SUPERSCRIPTS)}"
        return power if mantissa == "1" else f"{mantissa}{TIMES}{power}"
    return text


def percent(value: Optional[float], digits: int = 3) -> str:
    """Return a share in percent; very small ones as plain numbers.

    Examples
    --------
    >>> [percent(x) for x in (0.05, 0.012345, 0.0)], percent(1.0, 2)
    (['5 %', '1.23 %', '0 %'], '100 %')
    """
    if value is None or isnan(value):
        return MISSING
    if 0 < abs(value) < MIN_PERCENT_SHARE:
        return number(value, digits)
    return f"{number(100 * value, digits)} %"


def number_span(low: float, high: float) -> str:
    """Return two numbers as whole ones, or a single one if they are equal then.

    Examples
    --------
    >>> number_span(3.8, 25.1), number_span(3.8, 4.1)
    ('4 to 25', '4')
    """
    return f"{low:.0f}" if round(low) == round(high) else f"{low:.0f} to {high:.0f}"


def percent_span(low: float, high: float, more: str, less: str) -> str:
    """Return a span of changes in percent, with words for positive and for negative ones.

    Examples
    --------
    >>> percent_span(4, 25, "higher", "lower"), percent_span(-6, 13, "too high", "too low")
    ('4 to 25 % higher', 'from 6 % too low to 13 % too high')
    """
    if low >= 0:
        return f"{number_span(low, high)} % {more}"
    if high <= 0:
        return f"{number_span(-high, -low)} % {less}"
    return f"from {-low:.0f} % {less} to {high:.0f} % {more}"


def duration(seconds: Optional[float]) -> str:
    """Return a time.

    Examples
    --------
    >>> [duration(t) for t in (0.00123, 0.5, 75.3, 100.2, 400.0, 8000.0)]
    ['1.2 ms', '0.5 s', '75 s', '100 s', '6 min 40 s', '2 h 13 min']
    """
    if seconds is None or isnan(seconds):
        return MISSING
    if seconds < 0.1:
        return f"{number(1e3 * seconds, 2)} ms"
    if seconds < 120:
        return f"{number(seconds, 2 if seconds < 99.5 else 3)} s"
    minutes, rest = divmod(round(seconds), 60)
    if minutes < 120:
        return f"{minutes} min {rest} s"
    return f"{minutes // 60} h {minutes % 60} min"


def count(value: Optional[float]) -> str:
    """Return a count as text.

    Examples
    --------
    >>> [count(n) for n in (950, 12345)]
    ['950', '12,345']
    """
    if value is None or isnan(value) or value >= 1e6:
        return number(value)
    return f"{value:,.0f}"


def plural(number: int, noun: str) -> str:
    """Return a number of things.

    Examples
    --------
    >>> plural(1, "winter"), plural(3, "winter")
    ('1 winter', '3 winters')
    """
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def about(seconds: float) -> str:
    """Return an estimated time.

    Examples
    --------
    >>> [about(t) for t in (0.4, 42.3, 200, 8000)]
    ['under 1 s', 'about 42 s', 'about 3.3 min', 'about 2.2 h']
    """
    if seconds < 1:
        return "under 1 s"
    unit, name, digits = next(
        (unit, name, digits) for limit, unit, name, digits in UNITS_OF_TIME if seconds < limit
    )
    return f"about {seconds / unit:.{digits}f} {name}"


def missing_mark_hint(number: float) -> str:
    """Return advice if a number is one that programs write for a missing value; else nothing.

    Examples
    --------
    >>> missing_mark_hint(-999.0), missing_mark_hint(31.0)
    ('; if it stands for a missing value, leave such cells empty', '')
    """
    if number not in MARKS_OF_MISSING:
        return ""
    return "; if it stands for a missing value, leave such cells empty"


def number_in(text: str) -> float:
    """Return the number in a text; NaN if the text is not a finite number.

    Unlike ``float``, it accepts no digits of other scripts, no underscores and no words.

    Examples
    --------
    >>> number_in("-1.5e3"), number_in(" 2 "), number_in("1_000"), number_in("1e999")
    (-1500.0, 2.0, nan, nan)
    """
    text = text.strip(" \t")
    if len(text) > MAX_NUMBER or not NUMBER.fullmatch(text):
        return math.nan
    value = float(text)
    return value if math.isfinite(value) else math.nan
