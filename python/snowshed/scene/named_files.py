"""The files that a scene names: meshes, terrains, maps of thickness and samples."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

#: Keys of a scene whose values are paths of files.
FILES = ("file", "thickness_file")


def named_files(scene: Mapping[str, Any]) -> Iterator[str]:
    """Yield the path of every file that a scene names, in the scene's order.

    Parameters
    ----------
    scene
        JSON data of a scene.

    Examples
    --------
    >>> list(named_files({"obstacles": [{"file": "mast.stl"}], "title": "mast"}))
    ['mast.stl']
    """
    for key, value in scene.items():
        if key in FILES and value:
            yield value
        else:
            yield from _inner_files(value)


def _inner_files(value: Any) -> Iterator[str]:
    if isinstance(value, Mapping):
        yield from named_files(value)
    elif isinstance(value, (list, tuple)):
        for item in value:
            yield from _inner_files(item)


def with_named_files(scene: Mapping[str, Any], change: Callable[[str], str]) -> dict[str, Any]:
    """Return a scene with another text in place of the path of every file.

    Parameters
    ----------
    scene
        JSON data of a scene, of dictionaries and lists.
    change
        Returns the other text, from the path.

    Examples
    --------
    >>> with_named_files({"terrain": {"file": "slope.asc", "notes": []}}, str.upper)
    {'terrain': {'file': 'SLOPE.ASC', 'notes': []}}
    """
    return {
        key: change(value) if key in FILES and value else _changed(value, change)
        for key, value in scene.items()
    }


def _changed(value: Any, change: Callable[[str], str]) -> Any:
    if isinstance(value, list):
        return [_changed(item, change) for item in value]
    if isinstance(value, dict):
        return with_named_files(value, change)
    return value
