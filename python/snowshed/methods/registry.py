"""The methods that a scene may choose: each has a folder beside this module, and a name here."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Optional

from snowshed._core import InputError
from snowshed.base.json_values import JsonValue
from snowshed.base.messages import suggestion
from snowshed.methods.method import Method
from snowshed.methods.settings import MethodSettings

#: The folders of the methods; the first one is the method of scenes that name none.
FOLDERS = ("mpm", "slide", "grains", "mps")

#: The entry of every method, by its name in a scene.
METHODS: Mapping[str, Method] = {
    entry.name: entry
    for folder in FOLDERS
    for entry in [import_module(f"snowshed.methods.{folder}").METHOD]
}
DEFAULT = next(iter(METHODS))

#: Keys of a scene for the name of the method and for its settings.
NAME_KEY = "method"
SETTINGS_KEY = "numerics"


def method_named(name: Optional[str]) -> Method:
    """Return the method with a name; None stands for the default.

    Raises
    ------
    InputError
        If there is no such method.

    Examples
    --------
    >>> method_named("mpm").settings.__name__
    'MpmSettings'
    """
    name = name or DEFAULT
    if name not in METHODS:
        raise InputError(
            f"/{NAME_KEY}: {name!r} is none of {', '.join(METHODS)}{suggestion(name, METHODS)}"
        )
    return METHODS[name]


def method_of(scene: Mapping[str, JsonValue]) -> Method:
    """Return the method that a scene's data chooses.

    Raises
    ------
    InputError
        If there is no such method.

    Examples
    --------
    >>> method_of({}) is method_named(None)
    True
    """
    name = scene.get(NAME_KEY)
    return method_named(name if isinstance(name, str) else None)


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
    given = scene.get(SETTINGS_KEY)
    kind = method_of(scene).settings
    return kind.from_data(given if isinstance(given, dict) else {}, f"/{SETTINGS_KEY}")


def resolution_of(scene: Mapping[str, JsonValue]) -> float:
    """Return the finest size that a complete scene resolves, m.

    Raises
    ------
    InputError
        If the scene does not state it.

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
