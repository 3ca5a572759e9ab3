"""Write the fields of the scene's components, and their descriptions in docstrings.

The core describes every field of a scene once (cpp/snowshed/scene/describe.hpp), with its type,
unit, range, default and meaning. This program changes the dataclasses in python/snowshed so that
they agree with the description: it adds, removes and orders fields, writes their defaults, and the
section "Attributes" of each docstring. Methods, other sections and the first line of a docstring
are written by hand. The package exports the settings of every method in the registry; this program
writes those lines, too.

    python -m tools.components            # after a change of the description and `make build`
    python -m tools.components --check    # say which files differ; exit code 1
"""

from __future__ import annotations

import argparse
import ast
import inspect
import json
import re
import sys
from collections.abc import Mapping
from pathlib import Path

from tools.component_docs import attributes_section

import snowshed
from snowshed import Scene
from snowshed.base.record import Record
from snowshed.methods.registry import METHODS, NAME_KEY
from snowshed.scene.schema import properties, resolve, scene_schema, schema_of_method

EXPORTS = Path(snowshed.__file__).with_suffix(".pyi")
SECTION = "    Attributes\n    ----------\n"
TYPES = {"number": "float", "integer": "int", "boolean": "bool", "string": "str"}


def components() -> dict[type[Record], dict]:
    """Return every class of a scene's components with the schema node that describes it.

    A part that several methods take appears once per method. The scene's node is the whole schema.
    """
    nodes: dict[type[Record], dict] = {}
    for name, method in METHODS.items():
        schema = schema_of_method(name)
        _collect(Scene, schema, nodes)
        nodes[method.settings] = resolve(schema, schema["properties"]["numerics"])
    nodes[Scene] = scene_schema()
    return nodes


def _collect(record: type[Record], node: Mapping, nodes: dict[type[Record], dict]) -> None:
    nodes[record], fields = node, record.keys()
    for key, child in properties(scene_schema(), node).items():
        kind = record().record_type(key) if key in fields else None
        if kind is not None and kind not in nodes:
            full = resolve(scene_schema(), child)
            _collect(kind, resolve(scene_schema(), full.get("items", full)), nodes)


def with_described_fields(source: str, classes: Mapping[str, tuple[type[Record], dict]]) -> str:
    """Return a module's source with the fields and docstrings that the schema describes."""
    tree = ast.parse(source)
    lines = source.split("\n")
    for node in reversed(tree.body):
        if isinstance(node, ast.ClassDef) and node.name in classes:
            record, described = classes[node.name]
            lines[node.lineno - 1 : node.end_lineno] = _class_lines(lines, node, record, described)
    return "\n".join(lines)


def _class_lines(lines: list[str], node: ast.ClassDef, record: type[Record], described: dict):
    """Return the lines of a class; its fields follow its docstring."""
    inside = lines[node.lineno - 1 : node.end_lineno]
    start = node.lineno - 1
    doc = node.body[0]
    fields = [item for item in node.body if isinstance(item, ast.AnnAssign) and _is_field(item)]
    held = {item.target.id: item for item in fields}
    head = "\n".join(inside[: doc.end_lineno - start])
    body_start = fields[-1].end_lineno - start if fields else doc.end_lineno - start
    new = []
    for key, child in properties(scene_schema(), described).items():
        item = held.get(key, held.get(f"{key}_"))
        value = "None" if "oneOf" in described else _default_text(key, child)
        if item is None:
            new.append(f"    {key}: {_annotation(key, child)} = {value}")
        elif _is_generated(item.value):
            line = lines[item.lineno - 1]
            new.append(f"{line[: item.annotation.end_col_offset]} = {value}")
        else:
            new += lines[item.lineno - 1 : item.end_lineno]
    return [*_with_section(head, record, described).split("\n"), "", *new, *inside[body_start:]]


def _is_generated(value: ast.expr) -> bool:
    """Return whether the value of a field is None or a default of the description."""
    text = ast.unparse(value)
    return text == "None" or text.startswith("default(")


def _default_text(key: str, child: Mapping) -> str:
    """Return the value of a field in its class; a type of shape has defaults of its own."""
    value = resolve(scene_schema(), child).get("default")
    if value is None:
        return "None"
    return f"default({'DEFAULT' if key == NAME_KEY else _literal(value)})"


def _literal(value: object) -> str:
    if isinstance(value, list):
        return f"({', '.join(map(_literal, value))})"
    if isinstance(value, str):
        return json.dumps(value)
    if not isinstance(value, float):
        return repr(value)
    text = re.sub(r"e\+?(-?)0*", r"e\1", f"{value:g}")
    return text if "e" in text or "." in text else f"{text}.0"


def _is_field(node: ast.AnnAssign) -> bool:
    return "ClassVar" not in ast.dump(node.annotation)


def _with_section(head: str, record: type[Record], described: dict) -> str:
    section = attributes_section(record, scene_schema(), described)
    before, heading, rest = head.partition(SECTION)
    if not heading:
        raise SystemExit(f"{record.__name__}: its docstring has no section Attributes")
    after = rest.find("\n\n")
    tail = rest[after:] if after >= 0 else '\n    """'
    return before + section + tail


def _annotation(key: str, child: Mapping) -> str:
    """Return the Python type of a new field in the description."""
    full = resolve(scene_schema(), child)
    if "enum" in full:
        return f"Optional[Literal[{', '.join(repr(value) for value in full['enum'])}]]".replace(
            "'", '"'
        )
    if full.get("type") in TYPES:
        return f"Optional[{TYPES[full['type']]}]"
    raise SystemExit(f"{key}: write this field by hand; it holds {full.get('type')}")


def with_settings_exports(stub: str) -> str:
    """Return a stub that exports the settings of exactly the methods in the registry."""
    begin = "from .methods."
    others = [
        line
        for line in stub.split("\n")
        if not (line.startswith(begin) and ".settings import" in line)
    ]
    names = [(name, method.settings.__name__) for name, method in METHODS.items()]
    own = [f"{begin}{name}.settings import {kind} as {kind}" for name, kind in sorted(names)]
    after = [line.startswith("from .") and line > begin for line in others].index(True)
    return "\n".join([*others[:after], *own, *others[after:]])


def main() -> int:
    """Write all modules, or print which modules differ from the description."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument(
        "--check", action="store_true", help="Change nothing; fail on a difference."
    )
    check = parser.parse_args().check
    modules: dict[Path, dict[str, tuple[type[Record], dict]]] = {}
    for record, node in components().items():
        file = Path(inspect.getsourcefile(record) or "")
        modules.setdefault(file, {})[record.__name__] = (record, node)
    different = []
    for file in [*modules, EXPORTS]:
        source = file.read_text(encoding="utf-8")
        new = (
            with_settings_exports(source)
            if file == EXPORTS
            else with_described_fields(source, modules[file])
        )
        if new != source:
            different.append(file)
            if not check:
                file.write_text(new, encoding="utf-8")
    outcome = "differs from the description; run `make components`" if check else "written"
    for file in different:
        print(f"{file}: {outcome}")
    return int(check and bool(different))


if __name__ == "__main__":
    sys.exit(main())
