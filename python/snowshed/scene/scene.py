"""Scenes: what is to be simulated, set value by value and then initialised by the core.

This takes the place of the thesis's Lua remote controller (A.3.1): values may be set, appended
and overridden, the last one wins, then the scene is initialised.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, List, Optional, Union

from snowshed import _core
from snowshed.io.atomic import write_text
from snowshed.io.input_file import read_input
from snowshed.io.record import Record
from snowshed.scene.components import (
    Body,
    Domain,
    Events,
    Ground,
    Numerics,
    Obstacle,
    Output,
    Panel,
    Seeding,
    Slab,
    Snow,
)

PathLike = Union[str, "os.PathLike[str]"]
Holder = Union[Record, List[Record]]


@dataclass
class Scene(Record):
    """A scene in the making; fields that are None take the core's defaults. SI units.

    Examples
    --------
    >>> scene = Scene.preset("lab-50").set("snow.density", 250).set("events.count", 3)
    >>> scene.update({"panel": {"friction": 0.4}, "numerics.dx": 0.02}).panel.friction
    0.4
    >>> scene.resolve().data["snow"]["density"]
    250.0
    """

    snowshed: Optional[int] = 1  # version of the form that these classes mirror
    dimension: Optional[int] = None  # 2 or 3
    title: Optional[str] = None
    gravity: Optional[float] = None  # m/s2, along -z
    snow: Optional[Snow] = None
    panel: Optional[Panel] = None
    slab: Optional[Slab] = None
    ground: Optional[Ground] = None
    obstacles: Optional[List[Obstacle]] = None
    bodies: Optional[List[Body]] = None
    domain: Optional[Domain] = None
    seeding: Optional[Seeding] = None
    numerics: Optional[Numerics] = None
    events: Optional[Events] = None
    output: Optional[Output] = None

    _base_dir = "."  # no field: where the files a scene names are found

    @classmethod
    def load(cls, path: PathLike) -> Scene:
        """Read a scene file; it may be incomplete until it is initialised.

        Meshes and grids it names are found beside it.

        Raises
        ------
        InputError
            If the file is not JSON, too long, has unknown keys or numbers that are not finite.
        OSError
            If it cannot be read.
        """
        content = read_input(Path(path))
        try:
            data = json.loads(content, object_pairs_hook=_without_duplicates)
        except (ValueError, RecursionError) as error:
            raise _core.InputError(f"{path}: not JSON: {error}") from None
        try:
            scene = cls.from_data(data)
            scene.to_data()
        except _core.InputError as error:
            raise _core.InputError(f"{path}: {error}") from None
        scene._base_dir = os.fspath(Path(path).parent)
        return scene

    @classmethod
    def preset(cls, name: str) -> Scene:
        """Return a scene of the thesis: lab-40, lab-50, sensitivity or geometry.

        Raises
        ------
        InputError
            If there is no such preset.
        """
        return cls.from_data(json.loads(_core.preset(name)))

    def set(self, path: str, value: Any) -> Scene:
        """Set the value at a dotted path such as ``"snow.density"`` or ``"obstacles.0.friction"``.

        Objects on the way that were not given are created. Returns the scene itself.

        Raises
        ------
        InputError
            If the path names nothing a scene has.
        """
        record, key, where = self._locate(path)
        record.assign(key, value, where)
        return self

    def append(self, path: str, value: Any) -> Scene:
        """Append a value to the list at a dotted path, such as ``"obstacles"``.

        Raises
        ------
        InputError
            If the path names nothing a scene has, or something that is no list.
        """
        record, key, where = self._locate(path)
        held = getattr(record, record.field_of(key, where))
        if not isinstance(held, (list, tuple, type(None))):
            raise _core.InputError(f"{where}/{key}: nothing can be appended to what is no list")
        record.assign(key, [*(held or []), value], where)
        return self

    def update(self, values: Mapping[str, Any]) -> Scene:
        """Set several values; keys are dotted paths, and nested mappings go into what they name."""
        for path, value in values.items():
            record, key, where = self._locate(path)
            record.field_of(key, where)
            if isinstance(value, Mapping) and record.record_type(key):
                self.update({f"{path}.{inner}": item for inner, item in value.items()})
            else:
                record.assign(key, value, where)
        return self

    def resolve(self) -> ResolvedScene:
        """Have the core validate the scene and fill its defaults.

        Raises
        ------
        InputError
            Naming the JSON path, what is wrong with it, and what is allowed.
        """
        return ResolvedScene.parse(json.dumps(self.to_data()), self._base_dir)

    def _locate(self, path: str) -> tuple[Record, str, str]:
        """Return the record that holds the last part of `path`, that part, and where it is."""
        *parents, key = path.split(".")
        holder: Holder = self
        where = ""
        for parent in parents:
            holder = _enter(holder, parent, where)
            where = f"{where}/{parent}"
        if isinstance(holder, list):
            raise _core.InputError(f"{where}/{key}: set a key of the item, or the whole list")
        return holder, key, where


def _without_duplicates(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return a JSON object; as in the core, a key that is given twice is an error."""
    found: dict[str, Any] = {}
    for key, value in pairs:
        if key in found:
            raise ValueError(f"the key {key!r} appears twice")
        found[key] = value
    return found


def _enter(holder: Holder, key: str, where: str) -> Holder:
    """Return the record or list under `key`; a record that was not given is created."""
    if isinstance(holder, list):
        return _item(holder, key, where)
    name = holder.field_of(key, where)
    kind = holder.record_type(key)
    if kind is None:
        raise _core.InputError(f"{where}/{key}: a value, not an object")
    if getattr(holder, name) is None:
        setattr(holder, name, kind())
    held: Holder = getattr(holder, name)
    return held


def _item(items: list[Record], key: str, where: str) -> Record:
    try:
        item = items[int(key)]
    except (ValueError, IndexError):
        raise _core.InputError(f"{where}/{key}: no such item; the list has {len(items)}") from None
    if not isinstance(item, Record):
        raise _core.InputError(f"{where}/{key}: {item!r} is not an object")
    return item


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
        return cls(_core.parse_scene(text, os.fspath(base_dir)), os.fspath(base_dir))

    @classmethod
    def load(cls, path: PathLike) -> ResolvedScene:
        """Read and validate a scene file; raises InputError."""
        return cls(_core.load_scene(os.fspath(path)), os.fspath(Path(path).parent))

    @property
    def data(self) -> dict[str, Any]:
        """The complete scene as JSON data (a fresh copy)."""
        data: dict[str, Any] = json.loads(self.json)
        return data

    def save(self, path: PathLike) -> None:
        """Write the scene to a file."""
        write_text(path, self.json.rstrip() + "\n")
