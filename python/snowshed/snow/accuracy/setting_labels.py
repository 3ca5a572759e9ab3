"""Labels of settings."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Optional

from snowshed.base.formatting import MISSING, number
from snowshed.scene.accuracy_settings import ACCURACY
from snowshed.snow.accuracy.measurements import Value


def setting_label(name: str, value: Optional[Value]) -> str:
    """Return the label of a setting; for a text only its value. None: not given.

    Examples
    --------
    >>> settings = {"dx": 0.01, "transfer": "apic", "sleeping": False}
    >>> [setting_label(name, value) for name, value in settings.items()]
    ['dx 0.01', 'apic', 'no sleeping']
    >>> setting_label("dimension", 2)
    '2D'
    >>> setting_label("flip_ratio", None)
    'flip ratio default'
    """
    if value is None:
        return f"{name.replace('_', ' ')} {missing_label(name)}"
    if name == "dimension":
        return f"{value}D"
    name = name.replace("_", " ")
    if isinstance(value, bool):
        return name if value else f"no {name}"
    return value.replace("_", " ") if isinstance(value, str) else f"{name} {number(value, 4)}"


def missing_label(name: str) -> str:
    """Return the label of a missing setting: a scene's settings have defaults.

    Examples
    --------
    >>> missing_label("flip_ratio"), missing_label("aspect") == MISSING
    ('default', True)
    """
    return "default" if name in ACCURACY else MISSING


def settings_label(
    chosen: Mapping[str, Optional[Value]], names: Optional[Iterable[str]] = None
) -> str:
    """Return settings in a line: all, or those with the given names.

    Examples
    --------
    >>> settings_label({"dx": 0.01, "transfer": "apic", "seed": 2}, ["transfer", "dx"])
    'apic, dx 0.01'
    """
    labelled = chosen if names is None else [name for name in names if name in chosen]
    return ", ".join(setting_label(name, chosen[name]) for name in labelled)
