"""Numbers in the texts of options: lists, ranges with a step, and spans."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeVar

from snowshed._core import InputError
from snowshed.base.notes import InputNote, issue_note

Value = TypeVar("Value")

MAX_STEPS = 1000


def numbers(option: str, text: str, *, example: str, steps: bool = False) -> list[float]:
    """Return the numbers in the text of an option, where commas separate them.

    Parameters
    ----------
    option
        Name of the option, which an error repeats.
    text
        The text.
    example
        A list that an error gives as an example.
    steps
        Whether the text may also be FROM:TO:STEP.

    Raises
    ------
    InputError
        If the text is not such a list, or has more than `MAX_STEPS` steps.

    Examples
    --------
    >>> numbers("--tilt", "40,60", example="40,60")
    [40.0, 60.0]
    >>> numbers("--heights", "1:2:0.5", example="2,3", steps=True)
    [1.0, 1.5, 2.0]
    """
    try:
        if steps and ":" in text:
            return _parse_steps(option, text)
        return [float(part) for part in text.split(",")]
    except (ValueError, ZeroDivisionError, OverflowError):
        forms = f"a list of numbers such as {example}"
        forms = f"a number, {forms}, or FROM:TO:STEP" if steps else forms
        raise InputError(f"{option}: {text!r} is not {forms}") from None


def _parse_steps(option: str, text: str) -> list[float]:
    low, high, step = (float(part) for part in text.split(":"))
    count = int((high - low) / step + 1e-9) + 1
    if not (step > 0 and 1 <= count <= MAX_STEPS):
        raise ValueError
    values = [round(low + n * step, 9) for n in range(count)]
    if high - values[-1] > 1e-6 * step:
        issue_note(f"{option}: {text} ends at {values[-1]:g}", InputNote)
    return values


def span(option: str, text: str, *, example: str) -> tuple[float, float]:
    """Return the ends of a span LOW:HIGH.

    Parameters
    ----------
    option
        Name of the option, which an error repeats.
    text
        The text.
    example
        A span that an error gives as an example.

    Raises
    ------
    InputError
        If the text has another form.

    Examples
    --------
    >>> span("--slope", "28:60", example="28:60")
    (28.0, 60.0)
    """
    try:
        return _ends(text)
    except ValueError:
        raise InputError(
            f"{option}: {text!r} is not of the form LOW:HIGH, such as {example}"
        ) from None


def _ends(text: str, *, single: bool = False) -> tuple[float, float]:
    ends = [float(end) for end in text.split(":")]
    if not (1 if single else 2) <= len(ends) <= 2:
        raise ValueError
    return ends[0], ends[-1]


def named_once(option: str, pairs: Iterable[tuple[str, Value]]) -> dict[str, Value]:
    """Return values by their names, from an option that is given once for each name.

    Raises
    ------
    InputError
        If a name comes twice, because one of its values would be ignored.

    Examples
    --------
    >>> named_once("--where", [("panel.tilt", "40"), ("seed", "1")])
    {'panel.tilt': '40', 'seed': '1'}
    """
    values: dict[str, Value] = {}
    for name, value in pairs:
        if name in values:
            raise InputError(f"{option}: the name {name} is given twice")
        values[name] = value
    return values


def named_span(
    option: str, text: str, *, example: str, single: bool = False
) -> tuple[str, tuple[float, float]]:
    """Return the name and the ends of a span NAME=LOW:HIGH.

    Parameters
    ----------
    option
        Name of the option, which an error repeats.
    text
        The text.
    example
        A span that an error gives as an example.
    single
        Whether the text may also be NAME=VALUE, which gives equal ends.

    Raises
    ------
    InputError
        If the text has another form.

    Examples
    --------
    >>> named_span("--range", "friction=0.3:0.6", example="friction=0.3:0.6")
    ('friction', (0.3, 0.6))
    """
    name, _, values = text.partition("=")
    try:
        return name, _ends(values, single=single)
    except ValueError:
        raise InputError(
            f"{option}: {text!r} is not of the form NAME=LOW:HIGH, such as {example}"
        ) from None
