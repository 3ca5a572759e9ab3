"""The script line of each value of a scene, for the errors of the core."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Optional

from snowshed.scene.lua.sandbox import Place


class Origins:
    """The places that set values, by JSON path.

    Examples
    --------
    >>> origins = Origins()
    >>> origins.note("/panel", {"tilt": 40}, Place("init.lua", 3))
    >>> origins.note("/panel/tilt", 95, Place("update.lua", 1))
    >>> str(origins.of("/panel/tilt")), str(origins.of("/panel/height"))
    ('update.lua:1', 'init.lua:3')
    """

    def __init__(self) -> None:
        self._places: dict[str, Place] = {}

    def note(self, path: str, value: Any, place: Place) -> None:
        """Note that `place` set `value` at `path`, and all values inside it."""
        self._places.pop(path, None)  # so that the order is that of the last setting
        self._places[path] = place
        if isinstance(value, Mapping):
            for key, inner in value.items():
                self.note(f"{path}/{key}", inner, place)
        elif isinstance(value, list):
            for i, inner in enumerate(value):
                self.note(f"{path}/{i}", inner, place)

    def of(self, path: str) -> Optional[Place]:
        """Return the place that set the value at `path`, or what contains it, or its last part."""
        around = path
        while around:
            if around in self._places:
                return self._places[around]
            around = around.rpartition("/")[0]
        inside = [
            place for set_path, place in self._places.items() if set_path.startswith(f"{path}/")
        ]
        return inside[-1] if inside and path else None
