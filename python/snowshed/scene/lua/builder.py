"""A scene under construction that records the script line of each value."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from snowshed._core import InputError
from snowshed.base.messages import quoted
from snowshed.base.paths import PathLike
from snowshed.scene.lua.origins import Origins
from snowshed.scene.lua.sandbox import ScriptLine
from snowshed.scene.scene import ResolvedScene, Scene


@dataclass(frozen=True)
class LuaRun:
    """A run of a scene that scripts request.

    Attributes
    ----------
    name
        Name given to ``run``; empty if the scripts do not call it.
    scene
        The scene, validated and completed by the core.
    """

    name: str
    scene: ResolvedScene


class Builder:
    """Applies settings to a scene, and returns the scene with its present values.

    Parameters
    ----------
    folder
        The folder of the scripts, which must contain all files that they name.
    """

    def __init__(self, folder: PathLike) -> None:
        self.runs: list[LuaRun] = []
        self._folder = Path(folder).resolve()
        self._scene = Scene()
        self._origins = Origins()
        self._names: dict[str, list[str]] = {}  # of list items, by list

    def replace(self, scene: Scene) -> None:
        """Start again from another scene."""
        self._scene = scene
        self._origins = Origins()
        self._names = {}

    def set(self, path: str, value: Any, script_line: ScriptLine) -> None:
        """Set the value at a dotted path."""
        self._scene.set(path, value)
        if isinstance(value, list):
            self._names[path] = [_item_name(item) for item in value]
        else:
            self._names.pop(path, None)
        self._origins.note(_pointer(path), value, script_line)

    def update(self, section: str, values: Mapping[str, Any], script_line: ScriptLine) -> None:
        """Set values of a section of the scene, such as the panel; the others stay."""
        if getattr(self._scene, section) is None:
            self.set(section, {}, script_line)
        for key, value in values.items():
            self.set(f"{section}.{key}", value, script_line)

    def append(self, path: str, value: Any, script_line: ScriptLine) -> None:
        """Append to the list at a dotted path."""
        self._scene.append(path, value)
        names = self._names.setdefault(path, [])
        self._origins.note(f"{_pointer(path)}/{len(names)}", value, script_line)
        names.append(_item_name(value))

    def append_or_change(
        self, path: str, name: str, values: Mapping[str, Any], script_line: ScriptLine
    ) -> None:
        """Append an item to a list, or change the earlier item of the same name."""
        names = self._names.setdefault(path, [])
        if name and name in names:
            for key, value in values.items():
                self.set(f"{path}.{names.index(name)}.{key}", value, script_line)
        else:
            self.append(path, values, script_line)
            names[-1] = name

    def request_run(self, name: str, script_line: ScriptLine) -> None:
        """Request a run of the scene with its present values.

        Parameters
        ----------
        name
            Name of the run.
        script_line
            The line that requests the run, for errors without another line.

        Raises
        ------
        InputError
            If the scene is wrong, with the line that set the wrong value.
        """
        try:
            data = self._scene.to_data()
            for where, file in _files(data, ""):
                self._check_file(where, file)
            scene = ResolvedScene.parse(json.dumps(data), self._folder)
        except InputError as error:
            where = str(error).partition(":")[0]
            raise InputError(f"{self._origins.of(where) or script_line}: {error}") from None
        self.runs.append(LuaRun(name, scene))

    def _check_file(self, where: str, file: Any) -> None:
        """Refuse files that are missing, or outside the folder of the scripts."""
        if "\0" in str(file):
            raise InputError(f"{where}: {quoted(str(file))} is not the name of a file")
        path = (self._folder / str(file)).resolve()
        if self._folder not in path.parents:
            raise InputError(f"{where}: {file!r} is not in the scripts' folder {self._folder}")
        if not path.is_file():
            raise InputError(f"{where}: there is no file {file!r} in {self._folder}")


def _item_name(item: Any) -> str:
    return str(item.get("name", "")) if isinstance(item, Mapping) else ""


def _pointer(path: str) -> str:
    return "/" + path.replace(".", "/")


def _files(data: Any, path: str) -> Iterator[tuple[str, Any]]:
    """Yield the files that JSON data names, with their JSON paths."""
    if isinstance(data, Mapping):
        for key, value in data.items():
            if key == "file":
                yield f"{path}/{key}", value
            yield from _files(value, f"{path}/{key}")
    elif isinstance(data, list):
        for i, value in enumerate(data):
            yield from _files(value, f"{path}/{i}")
