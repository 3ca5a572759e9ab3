"""The descriptions of parameters in numpydoc docstrings, which are the help of options."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from typing import Any

SECTION = re.compile(r"^Parameters\n-+\n(.*?)(?:\n\n\S|\Z)", re.DOTALL | re.MULTILINE)
ENTRY = re.compile(r"^(\w+(?:, \w+)*)(?: :.*)?\n((?:[ ]{4}.*(?:\n|\Z))+)", re.MULTILINE)
#: A unit at the end of the first sentence, or before a semicolon.
UNIT = re.compile(r", (m|s|degrees)(?=[.;])")
REFERENCE = re.compile(r"As for `(\w+)`\.")


def parameter_docs(function: Callable[..., Any]) -> dict[str, str]:
    """Return the descriptions of a function's parameters by their names.

    "As for `other`." stands for the description in another function of the module. Units are in
    brackets, as in the help of all options.

    Examples
    --------
    >>> from snowshed.scene.builders.panels import panel_rows
    >>> parameter_docs(panel_rows)["height"]
    'Height of the lower edge above the ground [m].'
    """
    section = SECTION.search(inspect.getdoc(function) or "")
    docs = {}
    for names, text in ENTRY.findall(section[1] + "\n") if section else ():
        for name in names.split(", "):
            docs[name] = UNIT.sub(r" [\1]", " ".join(text.split()), count=1)
    for name, text in docs.items():
        reference = REFERENCE.fullmatch(text)
        if reference:
            docs[name] = parameter_docs(inspect.unwrap(function).__globals__[reference[1]])[name]
    return docs
