"""A scene that the core has validated and completed, as text and as data."""

from __future__ import annotations

import copy
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import snowshed._core as _core
from snowshed._core import ParsedScene
from snowshed.base.arguments import checked
from snowshed.base.json_values import JsonObject, JsonValue, read_only
from snowshed.base.notes import issue_note
from snowshed.base.paths import PathLike
from snowshed.io.array_files import FOLDER_PREFIX
from snowshed.io.atomic import write_text


@checked
@dataclass(frozen=True)
class ResolvedScene:
    """A scene that the core has validated and completed.

    The scene is text only where it enters or leaves the process; `data` and `core` are made once.

    Attributes
    ----------
    json
        The complete scene as JSON text.
    base_dir
        The folder in which the files that the scene names are found.
    """

    json: str
    base_dir: str = "."

    @classmethod
    def parse(cls, text: str, base_dir: PathLike = ".") -> ResolvedScene:
        """Validate JSON text; raises InputError."""
        folder = os.fspath(base_dir)
        return cls._from_core(ParsedScene.parse(text, folder), folder)

    @classmethod
    def from_data(cls, data: Mapping[str, JsonValue], base_dir: PathLike = ".") -> ResolvedScene:
        """Validate JSON data; raises InputError."""
        return cls.parse(json.dumps(data), base_dir)

    @classmethod
    def load(cls, path: PathLike) -> ResolvedScene:
        """Read and validate a scene file; raises InputError."""
        return cls._from_core(ParsedScene.load(os.fspath(path)), os.fspath(Path(path).parent))

    @classmethod
    def _from_core(cls, parsed: ParsedScene, folder: str) -> ResolvedScene:
        scene = cls(parsed.json, folder)
        vars(scene)["core"] = parsed
        return scene

    @cached_property
    def core(self) -> ParsedScene:
        """The scene in the core's form, without parsing it again."""
        return ParsedScene.parse(self.json, self.base_dir)

    @cached_property
    def data(self) -> Mapping[str, Any]:
        """The complete scene as JSON data, which cannot be changed; `copied_data` can."""
        data: Mapping[str, Any] = read_only(json.loads(self.json))
        return data

    def copied_data(self) -> JsonObject:
        """Return a copy of the data, which callers may change."""
        return copy.deepcopy(dict(self.data))

    def with_threads(self, threads: int) -> ResolvedScene:
        """Return the scene with another number of threads, which does not change its results."""
        data: dict[str, Any] = self.copied_data()
        data["numerics"]["threads"] = threads
        return ResolvedScene.from_data(data, self.base_dir)

    def __getstate__(self) -> dict[str, str]:
        """Return the pickled state: the text without its parsed forms."""
        return {"json": self.json, "base_dir": self.base_dir}

    def save(self, path: PathLike) -> None:
        """Write the scene to a file; a note names arrays in memory, which the file cannot hold."""
        if FOLDER_PREFIX in self.json:
            issue_note(
                f"{path}: the scene was made from arrays in memory, whose files end with this "
                "process; a run keeps them beside its results"
            )
        write_text(path, self.json.rstrip() + "\n")


def scene_data(text: str) -> dict[str, Any]:
    """Return the data of a complete scene's text, as a study stores it."""
    data: dict[str, Any] = json.loads(text)
    return data


def snows_of(simulation: _core.Simulation) -> list[dict[str, Any]]:
    """Return the data of the different snows of a simulation, by their material ids."""
    return [json.loads(snow) for snow in simulation.snows]
