"""Scenes: values that are set one by one, and resolved by the core.

This replaces the thesis's Lua remote controller (A.3.1): values may be set, appended and
overridden; the last one wins, then the scene is resolved.
"""

from __future__ import annotations

import copy
import json
import os
import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, List, Optional, Union, cast

from snowshed._core import InputError
from snowshed._core import preset as preset_text
from snowshed.base.arguments import checked
from snowshed.base.json_values import JsonObject, JsonValue
from snowshed.base.paths import PathLike
from snowshed.base.record import MAX_DEPTH, Record, check_instead, check_once, default
from snowshed.io.input_file import read_input
from snowshed.io.json_text import loads
from snowshed.io.run_files import scene_in
from snowshed.methods.registry import DEFAULT, NAME_KEY, SETTINGS_KEY, method_named
from snowshed.methods.settings import MethodSettings
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
)
from snowshed.scene.loading import Cone, LoadingStage, Sample
from snowshed.scene.output import Output
from snowshed.scene.resolved import ResolvedScene
from snowshed.scene.scene_html import scene_html
from snowshed.scene.scene_paths import locate
from snowshed.scene.scene_repr import scene_repr
from snowshed.scene.terrain_components import Terrain

__all__ = ["ResolvedScene", "Scene", "SceneLike", "resolve_scene"]

#: Parts that every scene has; a part without values is empty.
REQUIRED_PARTS = ("snow", "seeding", SETTINGS_KEY, "events", "output")
UNSET: Any = None

SLIP_CHANGED = (
    '"slip" now holds snow on the surface except at its edge; '
    'use "separate" for the behaviour of version 1'
)


@checked
@dataclass
class Scene(Record):
    """A scene under construction; fields that are not given have the core's defaults. SI units.

    Attributes
    ----------
    snowshed : int
        Version of the scene format. Required.
    dimension : int
        2: the plane (x, z); 3: space. 2 <= value <= 3; default 3.
    title : str
        Title of the scene.
    gravity : float
        Gravity, along -z [m/s2]. 0 <= value <= 1000; default 9.81.
    misplaced_snow : {"refuse", "allow"}
        Treatment of a scene that seeds more than 1 % of a body of snow inside an obstacle, below
        the ground, outside the domain, or within other snow. Default "refuse".
    snow : Snow
        The material.
    panel : Panel
        The panel; its centre is the origin of x, which points down the slide direction.
    slab : Slab
        The slab laid on the panel, centred, at the start of every event.
    ground : Ground
        An inclined plane through the origin.
    terrain : Terrain
        Ground from a raster of elevations, with the areas of its snow.
    sample : Sample
        Segmented snow for a loading test.
    loading : list of LoadingStage
        Stages of the loading test.
    cone : Cone
        Cone that the stages "penetrate" push in.
    obstacles : list of Obstacle
        Further solids that snow collides with.
    bodies : list of Body
        Further bodies of snow.
    domain : Domain
        A box with sticky sides; unbounded without it.
    seeding : Seeding
        Seeding of the snow with particles.
    method : {"mpm", "slide", "grains", "mps"}
        The numerical method. Default "mpm".
    numerics : MpmSettings
        The method's settings.
    events : Events
        Number of events, and their end.
    output : Output
        Output during a run.

    Examples
    --------
    >>> scene = Scene.preset("lab-50").set("snow.density", 250).set("events.count", 3)
    >>> scene.update({"panel": {"friction": 0.4}, "numerics.dx": 0.02}).panel.friction
    0.4
    >>> scene.resolve().data["snow"]["density"]
    250.0

    `set`, `update` and `append` change the scene; `with_` and `copy` return another one.

    >>> weak = scene.with_({"snow.cohesion": 0.05})
    >>> scene.snow.cohesion, weak.snow.cohesion
    (0.2, 0.05)
    >>> scene
    Scene(
        title='Laboratory experiment, Tables 2.3.1 and 4.1.1, calibrated snow',
        snow=Snow(density=250),
        panel=Panel(height=0.33, length=0.245, width=0.213, tilt=50, friction=0.4),
        slab=Slab(thickness=0.02, width=0.142),
        ground=Ground(),
        numerics=MpmSettings(dx=0.02),
        events=Events(count=3),
    )
    """

    snowshed: Optional[int] = 2
    dimension: Optional[int] = default(3)
    title: Optional[str] = default("")
    gravity: Optional[float] = default(9.81)
    misplaced_snow: Optional[MisplacedSnow] = default("refuse")
    snow: Snow = UNSET
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
    seeding: Seeding = UNSET
    method: Optional[str] = default(DEFAULT)
    numerics: MethodSettings = UNSET
    events: Events = UNSET
    output: Output = UNSET

    _base_dir = "."  # not a field: the folder of the files that the scene names

    @classmethod
    def load(cls, path: PathLike) -> Scene:
        """Read a scene file, or the scene in a run.json; it may be incomplete until it is resolved.

        The meshes and grids that the file names are found beside it.

        Raises
        ------
        InputError
            If the file is not JSON, too long, has unknown keys or numbers that are not finite.
        OSError
            If it cannot be read.
        """
        content = read_input(Path(path))
        try:
            data = loads(content)
        except (ValueError, RecursionError) as error:
            raise InputError(f"{path}: not JSON: {error}") from None
        data = scene_in(data, content, os.fspath(path))
        try:
            _refuse_null(data, "")
            scene = cls.from_data(cast("JsonObject", data))
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

    def to_data(self, path: str = "", depth: int = 0) -> JsonObject:
        """Return the values that were given, as the JSON object of a scene file.

        Raises
        ------
        InputError
            At a value that its field does not take.
        """
        data = super().to_data(path, depth)
        return {
            key: value for key, value in data.items() if key not in REQUIRED_PARTS or value != {}
        }

    def assign(self, key: str, value: object, path: str = "") -> None:
        """Set one field by its JSON key; settings become those of the scene's method.

        Raises
        ------
        InputError
            If a scene has no such key, or its field does not take the value.
        """
        if key == SETTINGS_KEY and isinstance(value, Mapping):
            value = method_named(self.method).settings.from_data(value, f"{path}/{key}")
        super().assign(key, value, path)

    def _keep(self, name: str, value: object, where: str) -> None:
        """Set a field; a part that every scene has becomes empty, and settings fit the method."""
        if name in REQUIRED_PARTS and value is None:
            kind = self.record_type(name)
            value = kind() if kind is not None else None
        if name == SETTINGS_KEY:
            self._require_settings(value, self.method, where)
        if name == NAME_KEY and (value is None or isinstance(value, str)):
            held = vars(self).get(SETTINGS_KEY)  # missing while a scene is made
            if isinstance(held, MethodSettings) and held.to_data():
                self._require_settings(held, value, where)
            else:
                object.__setattr__(self, SETTINGS_KEY, method_named(value).settings())
        super()._keep(name, value, where)

    def _require_settings(self, settings: object, method: Optional[str], where: str) -> None:
        kind = method_named(method).settings
        if isinstance(settings, MethodSettings) and not isinstance(settings, kind):
            raise InputError(
                f"{where}: the method {method or DEFAULT!r} takes {kind.__name__}, not "
                f"{type(settings).__name__}; set {SETTINGS_KEY} to None first, then {NAME_KEY}"
            )

    @classmethod
    def preset(cls, name: str) -> Scene:
        """Return a scene of the thesis: lab-40, lab-50, sensitivity or geometry.

        Raises
        ------
        InputError
            If there is no such preset.
        """
        return cls.from_data(json.loads(preset_text(name)))

    def copy(self) -> Scene:
        """Return a scene with the same values, which shares nothing with this one.

        Examples
        --------
        >>> scene = Scene.preset("lab-50")
        >>> scene.copy().set("panel.tilt", 30) == scene
        False
        """
        return copy.deepcopy(self)

    def with_(self, values: Optional[Mapping[str, object]] = None, **parts: object) -> Scene:
        """Return a copy with other values; this scene stays as it is.

        Parameters
        ----------
        values
            As for `update`: dotted paths, and nested mappings.
        **parts
            The same for names without a dot, such as ``panel={"tilt": 30}``.

        Raises
        ------
        InputError
            As for `update`.

        Examples
        --------
        >>> base = Scene.preset("lab-50")
        >>> [base.with_({"panel.tilt": tilt}).panel.tilt for tilt in (30, 40)], base.panel.tilt
        ([30, 40], 50.0)
        """
        return self.copy().update({**(values or {}), **parts})

    def __repr__(self) -> str:
        """Return the values that differ from the defaults, as calls that make them."""
        return scene_repr(self, REQUIRED_PARTS)

    def _repr_html_(self) -> str:
        """Return a drawing and the text for notebooks; an incomplete scene has no drawing."""
        try:
            data: Mapping[str, Any] = self.resolve().data
        except (InputError, OSError):
            data = {}
        return scene_html(data, repr(self))

    def set(self, path: str, value: object) -> Scene:
        """Set the value at a dotted path such as ``"snow.density"`` or ``"obstacles.0.friction"``.

        Missing objects along the path are created. Returns this scene, which is changed; `with_`
        returns a changed copy.

        Raises
        ------
        InputError
            If the path does not exist, or the value is of a wrong type. The scene is then
            unchanged.
        """
        with locate(self, path) as (record, key, where):
            record.assign(key, value, where)
        return self

    def append(self, path: str, value: object) -> Scene:
        """Append a value to the list at a dotted path, such as ``"obstacles"``.

        Raises
        ------
        InputError
            If the path does not exist, or is not a list, or the list does not accept the value. The
            scene is then unchanged.
        """
        with locate(self, path) as (record, key, where):
            held = vars(record)[record.field_of(key, where)]
            if not isinstance(held, (list, tuple, type(None))):
                raise InputError(f"{where}/{key}: is not a list; cannot append")
            record.assign(key, [*(held or []), value], where)
        return self

    def update(self, values: Mapping[str, object]) -> Scene:
        """Set several values; keys are dotted paths, values may be nested mappings.

        Raises
        ------
        InputError
            As for `set`, or if a value is given by two names. The scene is then unchanged.
        """
        copy.deepcopy(self)._update(values, {})  # an error comes before any change
        self._update(values, {})
        return self

    def _update(
        self, values: Mapping[str, object], names: dict[int, dict[str, str]], prefix: str = ""
    ) -> None:
        """Set values; `names` collects the fields that were set, by record and name."""
        settings = any(path.partition(".")[0] == SETTINGS_KEY for path in values)
        if not prefix and settings and values.get(NAME_KEY, self.method) != self.method:
            self.assign(SETTINGS_KEY, None)  # those of the other method, which new ones replace
        for path in sorted(values, key=lambda at: (at != NAME_KEY, not self._adopts(prefix + at))):
            value = values[path]
            with locate(self, prefix + path) as (record, key, where):
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

    def _adopts(self, path: str) -> bool:
        """Return whether the value at a path sets others, too; it must be set before them."""
        with locate(self, path) as (record, key, _):
            return record.adopts(key)

    def resolve(self) -> ResolvedScene:
        """Validate the scene and fill its defaults, in the core.

        Raises
        ------
        InputError
            Naming the JSON path, the error, and the allowed values.
        """
        self._warn_of_slip()
        return ResolvedScene.parse(json.dumps(self.to_data()), self._base_dir)

    def _warn_of_slip(self) -> None:
        """Warn of the new meaning of "slip" for one release, except in scenes of version 1."""
        parts = [self.panel, self.ground, *(self.obstacles or ())]
        if self.snowshed != 1 and any(part and part.condition == "slip" for part in parts):
            warnings.warn(SLIP_CHANGED, FutureWarning, stacklevel=3)

    def record_type(self, key: str) -> Optional[type[Record]]:
        """Return the class of records under a key; that of the settings depends on the method."""
        if key == SETTINGS_KEY:
            return method_named(self.method).settings
        return super().record_type(key)


def _refuse_null(data: JsonValue, where: str) -> None:
    """Refuse null: a key without a value must be left out, as in the core."""
    if data is None:
        raise InputError(f"{where or '/'}: null is not a value; leave the key out")
    if where.count("/") > 2 * MAX_DEPTH:
        raise InputError(f"{where[:100]}...: nested more than {MAX_DEPTH} deep")
    items = enumerate(data) if isinstance(data, list) else ()
    inner: Iterable[tuple[object, JsonValue]] = data.items() if isinstance(data, dict) else items
    for key, value in inner:
        _refuse_null(value, f"{where}/{key}")


SceneLike = Union[Scene, ResolvedScene, Mapping[str, JsonValue], PathLike]


def resolve_scene(scene: SceneLike) -> ResolvedScene:
    """Return the complete scene of a `Scene`, JSON data, or a file.

    Parameters
    ----------
    scene
        A scene, resolved or not; its JSON data; or the path of a scene file.

    Raises
    ------
    InputError
        If the scene is wrong, or `scene` is of another type.
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
