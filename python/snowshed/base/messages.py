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
#: An argument of a function in a message, such as `max_thickness=`.
_ARGUMENT = re.compile(r"`([a-z]\w*(?:\['\w+'\])?)=([^`\s]*)`")
#: Arguments whose options have another name.
_OPTIONS = {
    "same_version": "same-version-is-enough",
    "layers['release']": "layer",
    "layers['entrainment']": "entrainment-layer",
    "layers['resistance']": "resistance-layer",
    "slope_length": "slope-length",
    "ranges": "range",
    "voxel_size": "voxel",
}
#: Calls in messages, and the commands that do the same.
_RESUMING = re.compile(r"`snowshed\.run\('([^'`]*)', '([^'`]*)', resume=True\)`")
#: A clause that commands leave out, because they have no such option.
_OVERWRITING = re.compile(r",( [^,]*), or replace its results with `overwrite=True`")
_COMMANDS = {
    "`Study.run`": "`snowshed study run`",
    "`snowshed.study.resume`": "`snowshed study resume`",
}
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


def as_options(text: str) -> str:
    """Return a message for the command line: arguments of functions become its options.

    Messages name an argument with an equals sign and in backticks, as in Python.

    Examples
    --------
    >>> as_options("give `max_thickness=`, or resume it with `resume=True`")
    'give --max-thickness, or resume it with --resume'
    >>> as_options("`threshold=0.5` takes all numbers above 0 for ice")
    '--threshold 0.5 takes all numbers above 0 for ice'
    >>> as_options("take another, resume it with `resume=True`, or replace its results with "
    ...            "`overwrite=True`")
    'take another, or resume it with --resume'
    >>> as_options("resume it with " + resuming_call("out/scene.json", "out"))
    'resume it with: snowshed run out/scene.json -o out --resume'
    """
    text = _OVERWRITING.sub(r", or\1", text)
    text = _RESUMING.sub(r": snowshed run \1 -o \2 --resume", text).replace(" : ", ": ")
    for call, command in _COMMANDS.items():
        text = text.replace(call, command)
    return _ARGUMENT.sub(_option, text)


def resuming_call(scene: object, folder: object) -> str:
    """Return the call that resumes a run, for messages.

    Examples
    --------
    >>> resuming_call("out/scene.json", "out")
    "`snowshed.run('out/scene.json', 'out', resume=True)`"
    """
    return f"`snowshed.run({str(scene)!r}, {str(folder)!r}, resume=True)`"


def _option(argument: re.Match[str]) -> str:
    name, value = argument.groups()
    option = "--" + _OPTIONS.get(name, name).replace("_", "-")
    return option if value in ("", "True") else f"{option} {value}"


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
