"""The methods that a scene may choose.

A further method is a class of settings in a module of its own, its line in `METHODS`, and its name
in `MethodName`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, Optional

from snowshed._core import InputError
from snowshed.base.json_values import JsonValue
from snowshed.base.messages import suggestion
from snowshed.methods.grains.settings import GrainsSettings
from snowshed.methods.mpm.settings import MpmSettings
from snowshed.methods.mps.settings import MpsSettings
from snowshed.methods.settings import MethodSettings
from snowshed.methods.slide.settings import SlideSettings

MethodName = Literal["mpm", "slide", "grains", "mps"]
DEFAULT: MethodName = "mpm"

#: The class of the settings of every method, by its name in a scene.
METHODS: Mapping[str, type[MethodSettings]] = {
    "mpm": MpmSettings,
    "slide": SlideSettings,
    "grains": GrainsSettings,
    "mps": MpsSettings,
}

#: Where in a scene the name of the method and its settings stand.
NAME_KEY = "method"
SETTINGS_KEY = "numerics"


def settings_class(method: Optional[str]) -> type[MethodSettings]:
    """Return the class of a method's settings; None is the default method.

    Raises
    ------
    InputError
        If there is no such method.

    Examples
    --------
    >>> settings_class("mpm").__name__
    'MpmSettings'
    """
    name = method or DEFAULT
    if name not in METHODS:
        raise InputError(
            f"/{NAME_KEY}: {name!r} is none of {', '.join(METHODS)}{suggestion(name, METHODS)}"
        )
    return METHODS[name]


def settings_of(scene: Mapping[str, JsonValue]) -> MethodSettings:
    """Return the settings of the method that a scene's data chooses.

    Raises
    ------
    InputError
        If there is no such method, or it has no such settings.

    Examples
    --------
    >>> settings_of({"numerics": {"dx": 0.02}}).resolution
    0.02
    """
    name = scene.get(NAME_KEY)
    given = scene.get(SETTINGS_KEY)
    kind = settings_class(name if isinstance(name, str) else None)
    return kind.from_data(given if isinstance(given, dict) else {}, f"/{SETTINGS_KEY}")


def resolution_of(scene: Mapping[str, JsonValue]) -> float:
    """Return the size of the smallest thing that a complete scene resolves, m.

    Raises
    ------
    InputError
        If the scene does not say it.

    Examples
    --------
    >>> resolution_of({"numerics": {"dx": 0.02}})
    0.02
    """
    settings = settings_of(scene)
    if not settings.RESOLUTION:
        raise InputError(f"/{NAME_KEY}: the files that such a scene names decide its resolution")
    if settings.resolution is None:
        raise InputError(f"/{SETTINGS_KEY}/{settings.RESOLUTION}: missing")
    return float(settings.resolution)


def resolution_path(scene: Mapping[str, JsonValue]) -> str:
    """Return the dotted path of the setting that `resolution_of` returns.

    Raises
    ------
    InputError
        If the method has no such setting.

    Examples
    --------
    >>> resolution_path({})
    'numerics.dx'
    """
    name = settings_of(scene).RESOLUTION
    if not name:
        raise InputError(f"/{NAME_KEY}: the files that such a scene names decide its resolution")
    return f"{SETTINGS_KEY}.{name}"
