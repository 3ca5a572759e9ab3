"""The parameters of a scene, listed from the core's JSON Schema."""

from __future__ import annotations

import functools
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Optional, cast

from snowshed._core import scene_schema as schema_text
from snowshed._core import update_version
from snowshed.base.json_values import JsonObject, JsonValue
from snowshed.methods.registry import DEFAULT, METHODS, SETTINGS_KEY

Node = Mapping[str, JsonValue]


@dataclass(frozen=True)
class Parameter:
    """A value that can be set in a scene.

    Attributes
    ----------
    path
        Dotted path, such as "snow.density".
    kind
        number, integer, boolean, string, vector (of numbers) or list (of objects).
    description, unit, default
        As in the schema; if missing there, the unit is empty and the default None.
    choices
        Allowed values of an enumeration; None for other parameters.
    aliases
        Other dotted paths of the value.
    accuracy
        Whether it trades accuracy for computing time.
    """

    path: str
    kind: str
    description: str = ""
    unit: str = ""
    default: JsonValue = None
    choices: Optional[tuple[str, ...]] = None
    aliases: tuple[str, ...] = ()
    accuracy: bool = False


@functools.cache
def scene_schema() -> JsonObject:
    """Return the JSON Schema of a scene; it is shared, so do not change it."""
    return cast(JsonObject, json.loads(schema_text()))


@functools.cache
def scene_parameters(method: str = DEFAULT) -> tuple[Parameter, ...]:
    """Return the parameters of a scene with a method, in the order of the schema.

    Examples
    --------
    >>> [p.kind for p in scene_parameters() if p.path == "snow.density"]
    ['number']
    """
    schema = schema_of_method(method)
    return tuple(_parameters(schema, schema, ""))


@functools.cache
def parameter_units() -> Mapping[str, str]:
    """Return the unit of every parameter that has one, by its dotted path, of all methods.

    Examples
    --------
    >>> parameter_units()["snow.density"]
    'kg/m3'
    """
    listed = (parameter for method in METHODS for parameter in scene_parameters(method))
    return {parameter.path: parameter.unit for parameter in listed if parameter.unit}


@functools.cache
def schema_of_method(method: str) -> JsonObject:
    """Return the schema with the settings of one method, and only the parts that it takes.

    The result is shared, so do not change it.
    """
    schema = scene_schema()
    parts = {
        name: part
        for name, part in _object(schema["properties"]).items()
        if method in _list(_object(part).get("x-methods", [method]))
    }
    settings = _object(parts[SETTINGS_KEY])
    own = [
        alternative
        for alternative in _list(settings["anyOf"])
        if _object(alternative).get("title") == method
    ]
    parts[SETTINGS_KEY] = {**settings, "anyOf": own}
    return {**schema, "properties": parts}


def current_path(path: str) -> str:
    """Return the current dotted path of a parameter; an alias is replaced.

    Examples
    --------
    >>> current_path("numerics.step_factor"), current_path("panel.tilt")
    ('numerics.courant_factor', 'panel.tilt')
    """
    return _path_of_alias().get(path, path)


def with_current_names(scene: Mapping[str, JsonValue]) -> JsonObject:
    """Return a scene's data from an earlier version, with the current names of parameters.

    Examples
    --------
    >>> with_current_names({"numerics": {"step_factor": 0.5}})
    {'numerics': {'courant_factor': 0.5}}
    """
    renamed: JsonObject = dict(scene)
    if "snowshed" in scene:
        renamed = json.loads(update_version(json.dumps(scene)))
    for alias, path in _path_of_alias().items():
        section, _, name = alias.rpartition(".")
        held = renamed.get(section)
        if isinstance(held, dict) and name in held:
            current = path.rpartition(".")[2]
            renamed[section] = {current if k == name else k: v for k, v in held.items()}
    return renamed


def properties(schema: Node, node: Node) -> dict[str, JsonObject]:
    """Return the properties of an object, including those of its alternatives.

    Parameters
    ----------
    schema
        The whole schema, in which references are looked up.
    node
        The object's part of it.
    """
    variants: dict[str, JsonObject] = {}
    for part in _parts(schema, node):
        for name, inner in _object(part.get("properties")).items():
            variants.setdefault(name, _object(inner))
    return variants


def resolve(schema: Node, node: Node) -> JsonObject:
    """Return a node with its references and alternatives merged; its own keywords win."""
    merged: JsonObject = {}
    for part in _parts(schema, node):
        if part.get("type") != "null":
            merged = {**part, **merged}
    return merged


@functools.cache
def _path_of_alias() -> dict[str, str]:
    return {
        alias: p.path for method in METHODS for p in scene_parameters(method) for alias in p.aliases
    }


def _object(value: JsonValue) -> JsonObject:
    return value if isinstance(value, dict) else {}


def _list(value: JsonValue) -> list[JsonValue]:
    return value if isinstance(value, list) else []


def _string(value: JsonValue) -> str:
    return value if isinstance(value, str) else ""


def _parts(schema: Node, node: Node) -> Iterator[Node]:
    yield node
    if "$ref" in node:
        target: Node = schema
        for name in _string(node["$ref"]).lstrip("#/").split("/"):
            target = _object(target[name]) if name else target
        yield from _parts(schema, target)
    for keyword in ("allOf", "oneOf", "anyOf"):
        for part in _list(node.get(keyword)):
            yield from _parts(schema, _object(part))


def _parameters(schema: Node, node: Node, path: str) -> Iterator[Parameter]:
    for name, inner in properties(schema, node).items():
        inner_path = f"{path}.{name}".lstrip(".")
        if name.startswith("$") or inner_path == "snowshed":
            continue
        if properties(schema, inner):
            yield from _parameters(schema, inner, inner_path)
        else:
            yield _parameter(schema, inner, inner_path)


def _parameter(schema: Node, node: Node, path: str) -> Parameter:
    full = resolve(schema, node)
    section = path.rpartition(".")[0]
    return Parameter(
        path,
        _kind(schema, full),
        _string(full.get("description")),
        _string(full.get("x-unit")),
        full.get("default"),
        tuple(_string(choice) for choice in _list(full["enum"])) if "enum" in full else None,
        tuple(f"{section}.{_string(alias)}" for alias in _list(full.get("x-aliases"))),
        bool(full.get("x-accuracy")),
    )


def _kind(schema: Node, node: Node) -> str:
    kind = node.get("type", "string")
    if isinstance(kind, list):
        kind = next(name for name in kind if name != "null")
    if kind == "array":
        return "list" if properties(schema, _object(node.get("items"))) else "vector"
    return str(kind)
