"""A scene as text: the values that differ from the defaults, as calls that make them."""

from __future__ import annotations

from collections.abc import Collection

from snowshed.base.json_values import JsonObject
from snowshed.base.record import Record, call_text
from snowshed.methods.registry import DEFAULT, NAME_KEY
from snowshed.scene.schema import properties, resolve, scene_schema, schema_of_method


def scene_repr(scene: Record, always: Collection[str]) -> str:
    """Return the differences from the defaults, a line for each part of the scene.

    Parameters
    ----------
    scene
        The scene.
    always
        Parts that every scene has; they are left out if they are empty. Other parts are shown even
        then.
    """
    schema = schema_of_method(getattr(scene, NAME_KEY) or DEFAULT)
    nodes = properties(schema, schema)
    given, lines = scene.given(), []
    for key, name in scene.keys().items():
        value = given.get(name)
        if (
            key in always
            and isinstance(value, Record)
            and not _changed_fields(value, nodes.get(key, {}))
        ):
            continue
        if key != "snowshed" and not _is_default(value, nodes.get(key, {})):
            lines.append(f"    {name}={_literal(value, nodes.get(key, {}))},\n")
    return f"Scene(\n{''.join(lines)})" if lines else "Scene()"


def _literal(value: object, node: JsonObject) -> str:
    if isinstance(value, Record):
        return call_text(type(value), _changed_fields(value, node))
    if isinstance(value, (list, tuple)):
        items = resolve(scene_schema(), node).get("items")
        of_items = items if isinstance(items, dict) else {}
        inner = ", ".join(_literal(item, of_items) for item in value)
        return f"[{inner}]" if isinstance(value, list) else f"({inner})"
    return f"{value:g}" if isinstance(value, float) else repr(value)


def _changed_fields(record: Record, node: JsonObject) -> dict[str, str]:
    """Return the fields that differ from the defaults, as texts."""
    nodes, given = properties(scene_schema(), node), record.given()
    return {
        name: _literal(given[name], nodes.get(key, {}))
        for key, name in record.keys().items()
        if not _is_default(given.get(name), nodes.get(key, {}))
    }


def _is_default(value: object, node: JsonObject) -> bool:
    if value is None or value == []:
        return True
    return not isinstance(value, Record) and value == resolve(scene_schema(), node).get("default")
