"""Scenes: what is to be simulated, set value by value and then resolved by the core.

This takes the place of the thesis's Lua remote controller (A.3.1): values may be set, appended
and overridden, the last one wins, then the scene is resolved.
"""

from __future__ import annotations

import copy
import json
import os
import warnings
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import List, Optional, Union

from snowshed._core import InputError, load_scene, parse_scene
from snowshed._core import preset as preset_text
from snowshed.io.atomic import write_text
from snowshed.io.input_file import read_input
from snowshed.io.json_file import JsonObject, JsonValue
from snowshed.io.paths import PathLike
from snowshed.io.record import DEEPEST, Record, check_instead, check_once
from snowshed.methods.grains.settings import GrainsSettings
from snowshed.methods.mpm import MpmSettings
from snowshed.methods.mps import MpsSettings
from snowshed.methods.registry import NAME_KEY, SETTINGS_KEY, MethodName, settings_class
from snowshed.methods.slide import SlideSettings
from snowshed.scene.components import (
    Body,
    Domain,
    Events,
    Ground,
    MisplacedSnow,
    Obstacle,
    Panel,
    Seeding,
    Slab,
    Snow,
    Terrain,
)
from snowshed.scene.loading import Cone, LoadingStage, Sample
from snowshed.scene.output import Output

__all__ = ["PathLike", "ResolvedScene", "Scene", "SceneLike", "resolve_scene"]

Holder = Union[Record, List[Record]]

SLIP_CHANGED = (
    'condition "slip" lets no snow leave the surface but over its edge; '
    'what it did up to version 1 of scenes is "separate" now'
)


@dataclass
class Scene(Record):
    """A scene in the making; fields that are None take the core's defaults. SI units.

    Attributes
    ----------
    snowshed : int
        Version of this form. Required.
    dimension : int
        2: the plane (x, z); 3: space. 2 <= value <= 3; default 3.
    title : str
        What this scene is.
    gravity : float
        Gravity, along -z [m/s2]. 0 <= value <= 1000; default 9.81.
    misplaced_snow : {"refuse", "allow"}
        What becomes of a scene that seeds more than 1 % of a body of snow inside an obstacle,
        below the ground, outside the domain, or within other snow. Default "refuse".
    snow : Snow
        The material.
    panel : Panel
        The panel; its centre is the origin of x, which points down the slide direction.
    slab : Slab
        The slab laid on the panel, centred, at the start of every event.
    ground : Ground
        An inclined plane through the origin.
    terrain : Terrain
        Ground from a raster of elevations, and where snow lies on it.
    sample : Sample
        Segmented snow to be loaded.
    loading : list of LoadingStage
        How the sample is loaded, stage by stage.
    cone : Cone
        The tip that stages "penetrate" push in.
    obstacles : list of Obstacle
        Further solids that snow collides with.
    bodies : list of Body
        Further bodies of snow.
    domain : Domain
        A box with sticky sides; unbounded without it.
    seeding : Seeding
        How snow is filled with particles.
    method : {"mpm", "slide", "grains", "mps"}
        The numerical method. Default "mpm".
    numerics : MpmSettings
        The method's settings.
    events : Events
        How many events, and when one ends.
    output : Output
        What is written during a run.

    Examples
    --------
    >>> scene = Scene.preset("lab-50").set("snow.density", 250).set("events.count", 3)
    >>> scene.update({"panel": {"friction": 0.4}, "numerics.dx": 0.02}).panel.friction
    0.4
    >>> scene.resolve().data["snow"]["density"]
    250.0
    """

    snowshed: Optional[int] = 2
    dimension: Optional[int] = None
    title: Optional[str] = None
    gravity: Optional[float] = None
    misplaced_snow: Optional[MisplacedSnow] = None
    snow: Optional[Snow] = None
    panel: Optional[Panel] = None
    slab: Optional[Slab] = None
    ground: Optional[Ground] = None
    terrain: Optional[Terrain] = None
    sample: Optional[Sample] = None
    loading: Optional[List[LoadingStage]] = None
    cone: Optional[Cone] = None
    obstacles: Optional[List[Obstacle]] = None
    bodies: Optional[List[Body]] = None
    domain: Optional[Domain] = None
    seeding: Optional[Seeding] = None
    method: Optional[MethodName] = None
    numerics: Optional[Union[MpmSettings, SlideSettings, GrainsSettings, MpsSettings]] = None
    events: Optional[Events] = None
    output: Optional[Output] = None

    _base_dir = "."  # no field: where the files a scene names are found

    @classmethod
    def load(cls, path: PathLike) -> Scene:
        """Read a scene file; it may be incomplete until it is resolved.

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
            raise InputError(f"{path}: not JSON: {error}") from None
        try:
            _refuse_null(data, "")
            scene = cls.from_data(data)
            scene.to_data()
        except InputError as error:
            raise InputError(f"{path}: {error}") from None
        scene._base_dir = os.fspath(Path(path).parent)
        return scene

    @classmethod
    def from_data(cls, data: Mapping[str, object], path: str = "") -> Scene:
        """Build a scene from its JSON data; the method decides which settings it takes.

        Raises
        ------
        InputError
            At a key that a scene does not have, or a value that its field does not take.
        """
        if isinstance(data, Mapping) and NAME_KEY in data:
            data = {NAME_KEY: data[NAME_KEY], **data}
        return super().from_data(data, path)

    def assign(self, key: str, value: object, path: str = "") -> None:
        """Set one field by its JSON key; settings become those of the scene's method.

        Raises
        ------
        InputError
            If a scene has no such key, or its field does not take the value.
        """
        if key == SETTINGS_KEY and isinstance(value, Mapping):
            value = settings_class(self.method).from_data(value, f"{path}/{key}")
        if key == NAME_KEY and isinstance(value, str) and self.numerics is not None:
            kind = settings_class(value)
            if not isinstance(self.numerics, kind):
                raise InputError(
                    f"{path}/{key}: {value!r} takes {kind.__name__}, and the scene has "
                    f"{type(self.numerics).__name__}; set {SETTINGS_KEY} to None first"
                )
        super().assign(key, value, path)

    @classmethod
    def preset(cls, name: str) -> Scene:
        """Return a scene of the thesis: lab-40, lab-50, sensitivity or geometry.

        Raises
        ------
        InputError
            If there is no such preset.
        """
        return cls.from_data(json.loads(preset_text(name)))

    def set(self, path: str, value: object) -> Scene:
        """Set the value at a dotted path such as ``"snow.density"`` or ``"obstacles.0.friction"``.

        Objects on the way that were not given are created. Returns the scene itself.

        Raises
        ------
        InputError
            If the path names nothing a scene has, or what is there takes no such value. The scene
            is then as it was.
        """
        with self._locate(path) as (record, key, where):
            record.assign(key, value, where)
        return self

    def append(self, path: str, value: object) -> Scene:
        """Append a value to the list at a dotted path, such as ``"obstacles"``.

        Raises
        ------
        InputError
            If the path names nothing a scene has, or something that is no list, or if the list
            takes no such value. The scene is then as it was.
        """
        with self._locate(path) as (record, key, where):
            held = getattr(record, record.field_of(key, where))
            if not isinstance(held, (list, tuple, type(None))):
                raise InputError(f"{where}/{key}: nothing can be appended to what is no list")
            record.assign(key, [*(held or []), value], where)
        return self

    def update(self, values: Mapping[str, object]) -> Scene:
        """Set several values; keys are dotted paths, and nested mappings go into what they name.

        Raises
        ------
        InputError
            As of `set`, or if the same is given by two names. The scene is then as it was.
        """
        copy.deepcopy(self)._update(values, {})  # fails, if it must, before anything is changed
        self._update(values, {})
        return self

    def _update(
        self, values: Mapping[str, object], names: dict[int, dict[str, str]], prefix: str = ""
    ) -> None:
        """Set values; `names` collects the fields that were set, by record and name."""
        for path, value in values.items():
            with self._locate(prefix + path) as (record, key, where):
                field = record.field_of(key, where)
                if isinstance(value, Mapping) and record.record_type(key):
                    self._update(value, names, f"{prefix}{path}.")
                else:
                    if value is not None:
                        set_so_far = names.setdefault(id(record), {})
                        set_so_far[key] = field
                        check_once(set_so_far, where)
                        check_instead(type(record), list(set_so_far.values()), where)
                    record.assign(key, value, where)

    def resolve(self) -> ResolvedScene:
        """Have the core validate the scene and fill its defaults.

        Raises
        ------
        InputError
            Naming the JSON path, what is wrong with it, and what is allowed.
        """
        self._warn_of_slip()
        return ResolvedScene.parse(json.dumps(self.to_data()), self._base_dir)

    def _warn_of_slip(self) -> None:
        """Say, for one version, that slip has another meaning; files tell it by their version."""
        parts = [self.panel, self.ground, *(self.obstacles or ())]
        if self.snowshed != 1 and any(part and part.condition == "slip" for part in parts):
            warnings.warn(SLIP_CHANGED, FutureWarning, stacklevel=3)

    def initialise(self) -> ResolvedScene:
        """Do what `resolve` does, which is the name to use.

        .. deprecated:: 0.1
        """
        warnings.warn("Scene.initialise is now Scene.resolve", DeprecationWarning, stacklevel=2)
        return self.resolve()

    def record_type(self, key: str) -> Optional[type[Record]]:
        """Return the class of records under a key; that of the settings depends on the method."""
        if key == SETTINGS_KEY:
            return settings_class(self.method)
        return super().record_type(key)

    @contextmanager
    def _locate(self, path: str) -> Iterator[tuple[Record, str, str]]:
        """Yield the record that holds the last part of `path`, that part, and where it is.

        A record on the way that was not given is created, and dropped again on an error.
        """
        *parents, key = path.split(".")
        holder: Holder = self
        where = ""
        created: list[tuple[Record, str]] = []
        try:
            for parent in parents:
                holder = _enter(holder, parent, where, created)
                where = f"{where}/{parent}"
            if isinstance(holder, list):
                raise InputError(f"{where}/{key}: set a key of the item, or the whole list")
            yield holder, key, where
        except BaseException:
            for record, name in created:
                setattr(record, name, None)
            raise


def _without_duplicates(pairs: list[tuple[str, JsonValue]]) -> JsonObject:
    """Return a JSON object; as in the core, a key that is given twice is an error."""
    found: JsonObject = {}
    for key, value in pairs:
        if key in found:
            raise ValueError(f"the key {key!r} appears twice")
        found[key] = value
    return found


def _refuse_null(data: JsonValue, where: str) -> None:
    """Refuse null: in a file, as for the core, a key that is not given is left out."""
    if data is None:
        raise InputError(f"{where or '/'}: null is no value; leave the key out")
    if where.count("/") > 2 * DEEPEST:
        raise InputError(f"{where[:100]}...: nested more than {DEEPEST} deep")
    items = enumerate(data) if isinstance(data, list) else ()
    inner: Iterable[tuple[object, JsonValue]] = data.items() if isinstance(data, dict) else items
    for key, value in inner:
        _refuse_null(value, f"{where}/{key}")


def _enter(holder: Holder, key: str, where: str, created: list[tuple[Record, str]]) -> Holder:
    """Return the record or list under `key`; a record that was not given is created."""
    if isinstance(holder, list):
        return _item(holder, key, where)
    name = holder.field_of(key, where)
    kind = holder.record_type(key)
    if kind is None:
        raise InputError(f"{where}/{key}: a value, not an object")
    if getattr(holder, name) is None:
        setattr(holder, name, kind())
        created.append((holder, name))
    held: Holder = getattr(holder, name)
    return held


def _item(items: list[Record], key: str, where: str) -> Record:
    try:
        item = items[int(key)]
    except (ValueError, IndexError):
        raise InputError(f"{where}/{key}: no such item; the list has {len(items)}") from None
    if not isinstance(item, Record):
        raise InputError(f"{where}/{key}: {item!r} is not an object")
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
        return cls(parse_scene(text, os.fspath(base_dir)), os.fspath(base_dir))

    @classmethod
    def load(cls, path: PathLike) -> ResolvedScene:
        """Read and validate a scene file; raises InputError."""
        return cls(load_scene(os.fspath(path)), os.fspath(Path(path).parent))

    @property
    def data(self) -> JsonObject:
        """The complete scene as JSON data (a fresh copy)."""
        data: JsonObject = json.loads(self.json)
        return data

    def save(self, path: PathLike) -> None:
        """Write the scene to a file."""
        write_text(path, self.json.rstrip() + "\n")


SceneLike = Union[Scene, ResolvedScene, Mapping[str, JsonValue], PathLike]


def resolve_scene(scene: SceneLike) -> ResolvedScene:
    """Return the complete scene of whatever stands for one.

    Parameters
    ----------
    scene
        A scene, resolved or not; its JSON data; or the path of a scene file.

    Raises
    ------
    InputError
        If the scene is wrong, or `scene` is none of these.
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> ball = {"type": "sphere", "center": [0, 1], "radius": 0.1}
    >>> resolve_scene({"dimension": 2, "bodies": [{"shape": ball}]}).data["gravity"]
    9.81
    """
    if isinstance(scene, ResolvedScene):
        return scene
    if isinstance(scene, Scene):
        return scene.resolve()
    if isinstance(scene, Mapping):
        return Scene.from_data(scene).resolve()
    if isinstance(scene, (str, os.PathLike)):
        return ResolvedScene.load(scene)
    raise InputError(
        f"scene: a value of type {type(scene).__name__}; allowed: Scene, ResolvedScene, dict, path"
    )
