"""Labels of settings."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Optional

from snowshed.analysis.accuracy.measurements import Value
from snowshed.base.formatting import MISSING, number
from snowshed.scene.accuracy_settings import ACCURACY


def setting(name: str, value: Optional[Value]) -> str:
    """Return the label of a setting: for a text only its value. `None`: not given.

    Examples
    --------
    >>> [setting("dx", 0.01), setting("transfer", "apic"), setting("sleeping", False)]
    ['dx 0.01', 'apic', 'no sleeping']
    >>> setting("dimension", 2)
    '2D'
    >>> setting("flip_ratio", None)
    'flip ratio default'
    """
    if value is None:
        return f"{name.replace('_', ' ')} {unset(name)}"
    if name == "dimension":
        return f"{value}D"
    name = name.replace("_", " ")
    if isinstance(value, bool):
        return name if value else f"no {name}"
    return value.replace("_", " ") if isinstance(value, str) else f"{name} {number(value, 4)}"


def unset(name: str) -> str:
    """Return the label of a missing setting: a scene's settings have defaults.

    Examples
    --------
    >>> unset("flip_ratio"), unset("aspect") == MISSING
    ('default', True)
    """
    return "default" if name in ACCURACY else MISSING


def settings(chosen: Mapping[str, Optional[Value]], names: Optional[Iterable[str]] = None) -> str:
    """Return settings in a line: all, or those with the given names.

    Examples
    --------
    >>> settings({"dx": 0.01, "transfer": "apic", "seed": 2}, ["transfer", "dx"])
    'apic, dx 0.01'
    """
    labelled = chosen if names is None else [name for name in names if name in chosen]
    return ", ".join(setting(name, chosen[name]) for name in labelled)
