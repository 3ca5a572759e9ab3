"""The parameters of a scene, listed from the core's JSON Schema."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Optional

from snowshed import _core

Node = Mapping[str, Any]


@dataclass(frozen=True)
class Parameter:
    """One value of a scene that can be set.

    Attributes
    ----------
    path
        Dotted path, such as "snow.density".
    kind
        number, integer, boolean, string, vector (of numbers) or list (of objects).
    """

    path: str
    kind: str
    description: str = ""
    unit: str = ""
    default: Any = None
    choices: Optional[tuple[Any, ...]] = None


def scene_parameters() -> list[Parameter]:
    """Return the parameters of a scene in the order of the schema.

    Examples
    --------
    >>> [p.kind for p in scene_parameters() if p.path == "snow.density"]
    ['number']
    """
    schema = json.loads(_core.scene_schema())
    return list(_parameters(schema, schema, ""))


def properties(schema: Node, node: Node) -> dict[str, Node]:
    """Return the properties of an object, those of its alternatives included.

    Parameters
    ----------
    schema
        The whole schema, in which references are looked up.
    node
        The object's part of it.
    """
    found: dict[str, Node] = {}
    for part in _parts(schema, node):
        for name, inner in part.get("properties", {}).items():
            found.setdefault(name, inner)
    return found


def resolve(schema: Node, node: Node) -> dict[str, Any]:
    """Return a node with its references and alternatives merged; its own keywords win."""
    merged: dict[str, Any] = {}
    for part in _parts(schema, node):
        if part.get("type") != "null":
            merged = {**part, **merged}
    return merged


def _parts(schema: Node, node: Node) -> Iterator[Node]:
    yield node
    if "$ref" in node:
        target: Node = schema
        for name in node["$ref"].lstrip("#/").split("/"):
            target = target[name] if name else target
        yield from _parts(schema, target)
    for keyword in ("allOf", "oneOf", "anyOf"):
        for part in node.get(keyword, ()):
            yield from _parts(schema, part)


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
    return Parameter(
        path,
        _kind(schema, full),
        full.get("description", ""),
        full.get("x-unit", ""),
        full.get("default"),
        tuple(full["enum"]) if "enum" in full else None,
    )


def _kind(schema: Node, node: Node) -> str:
    kind = node.get("type", "string")
    if isinstance(kind, list):
        kind = next(name for name in kind if name != "null")
    if kind == "array":
        return "list" if properties(schema, node.get("items", {})) else "vector"
    return str(kind)
