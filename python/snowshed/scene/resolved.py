"""A scene that the core has validated and completed, as text and as data."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from pathlib import Path

from snowshed._core import load_scene, parse_scene
from snowshed.base.json_values import JsonValue
from snowshed.base.paths import PathLike
from snowshed.io.atomic import write_text


@dataclass(frozen=True)
class ResolvedScene:
    """A scene the core has validated and completed.

    Attributes
    ----------
    json
        The complete scene as JSON text.
    base_dir
        The folder from which the files it names are found.
    """

    json: str
    base_dir: str = "."

    @classmethod
    def parse(cls, text: str, base_dir: PathLike = ".") -> ResolvedScene:
        """Validate JSON text; raises InputError."""
        return cls(parse_scene(text, os.fspath(base_dir)), os.fspath(base_dir))

    @classmethod
    def load(cls, path: PathLike) -> ResolvedScene:
        """Read and validate a scene file; raises InputError."""
        return cls(load_scene(os.fspath(path)), os.fspath(Path(path).parent))

    @property
    def data(self) -> dict[str, JsonValue]:
        """The complete scene as JSON data (a fresh copy)."""
        data: dict[str, JsonValue] = json.loads(self.json)
        return data

    def save(self, path: PathLike) -> None:
        """Write the scene to a file."""
        write_text(path, self.json.rstrip() + "\n")
