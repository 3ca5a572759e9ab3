"""Docstrings of components say what the core's schema says."""

import typing

import pytest
from component_docs import attributes_section

from snowshed import Scene
from snowshed.io.field_type import alternatives_of
from snowshed.methods.registry import METHODS
from snowshed.scene.schema import properties, resolve, scene_schema, schema_of_method


def mirrored(record, node, found):
    """Collect every class of records with the schema's node that it mirrors."""
    found[record] = node
    for key, child in properties(scene_schema(), node).items():
        kind = record().record_type(key)
        if kind is not None and kind not in found:
            full = resolve(scene_schema(), child)
            mirrored(kind, resolve(scene_schema(), full.get("items", full)), found)
    return found


def all_nodes():
    """Return the records of every method's scenes; those of the whole scene by the whole schema."""
    found = {}
    for method, settings in METHODS.items():
        schema = schema_of_method(method)
        mirrored(Scene, schema, found)
        found[settings] = resolve(schema, schema["properties"]["numerics"])
    found[Scene] = scene_schema()
    return found


NODES = all_nodes()


@pytest.mark.parametrize("record", NODES, ids=lambda record: record.__name__)
def test_attributes_are_those_of_the_schema(record):
    section = attributes_section(record, scene_schema(), NODES[record])
    assert section in record.__doc__, f"write in the docstring of {record.__name__}:\n{section}"


@pytest.mark.parametrize("record", NODES, ids=lambda record: record.__name__)
def test_enumerations_and_other_names_are_those_of_the_schema(record):
    hints = typing.get_type_hints(record)
    aliases = {}
    for key, child in properties(scene_schema(), NODES[record]).items():
        full = resolve(scene_schema(), child)
        field = record.keys()[key]
        if "enum" in full:
            ((kind,), choices) = alternatives_of(hints[field]), tuple(full["enum"])
            assert typing.get_args(kind) == choices
        aliases.update(dict.fromkeys(full.get("x-aliases", ()), field))
    assert record.aliases() == aliases
