"""The script line of each value of a scene, for the errors of the core."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Optional

from snowshed.scene.lua.sandbox import ScriptLine


class Origins:
    """The lines that set values, by JSON path.

    Examples
    --------
    >>> origins = Origins()
    >>> origins.note("/panel", {"tilt": 40}, ScriptLine("init.lua", 3))
    >>> origins.note("/panel/tilt", 95, ScriptLine("update.lua", 1))
    >>> str(origins.of("/panel/tilt")), str(origins.of("/panel/height"))
    ('update.lua:1', 'init.lua:3')
    """

    def __init__(self) -> None:
        self._lines: dict[str, ScriptLine] = {}

    def note(self, path: str, value: Any, script_line: ScriptLine) -> None:
        """Store `script_line` as the origin of `value` at `path`, and of all values inside."""
        self._lines.pop(path, None)  # moves the path to the end of the order
        self._lines[path] = script_line
        if isinstance(value, Mapping):
            for key, inner in value.items():
                self.note(f"{path}/{key}", inner, script_line)
        elif isinstance(value, list):
            for i, inner in enumerate(value):
                self.note(f"{path}/{i}", inner, script_line)

    def of(self, path: str) -> Optional[ScriptLine]:
        """Return the line that set the value at `path`, an object around it, or a part of it."""
        around = path
        while around:
            if around in self._lines:
                return self._lines[around]
            around = around.rpartition("/")[0]
        inside = [
            script_line
            for set_path, script_line in self._lines.items()
            if set_path.startswith(f"{path}/")
        ]
        return inside[-1] if inside and path else None
