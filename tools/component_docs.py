"""Attributes section of a component's docstring, from the schema."""

import re
import textwrap

from snowshed.scene.schema import properties, resolve

LIMITS = (
    ("minimum", "{} <= value"),
    ("exclusiveMinimum", "{} < value"),
    ("maximum", "value <= {}"),
    ("exclusiveMaximum", "value < {}"),
)
TYPES = {"number": "float", "integer": "int", "boolean": "bool", "string": "str"}


def attributes_section(record, schema, node):
    """Return the section for a record of a schema node, indented as in the source."""
    lines = ["Attributes", "----------"]
    fields = record.keys()
    for key, described in properties(schema, node).items():
        child, field = resolve(schema, described), fields.get(key, key)
        meaning = _in_shapes(schema, node, key) if "oneOf" in node else child["description"]
        unit = f" [{child['x-unit']}]" if child.get("x-unit") else ""
        notes = "" if "oneOf" in node else _notes(child, key in node.get("required", ()))
        text = re.sub(r"\|.+?\|", r"``\g<0>``", f"{meaning}{unit}.{notes}")  # no substitution
        indented = {"initial_indent": "    ", "subsequent_indent": "    "}
        lines += [f"{field} : {_type(record, key, child)}", *textwrap.wrap(text, 95, **indented)]
    return textwrap.indent("\n".join(lines), "    ")


def _type(record, key, child):
    held = record().record_type(key) if key in record.aliases() | record.keys() else None
    if held is not None:
        return f"list of {held.__name__}" if child.get("type") == "array" else held.__name__
    if "enum" in child:
        return "{" + ", ".join(f'"{choice}"' for choice in child["enum"]) + "}"
    if key == "type":
        return "str"
    if key == "file":
        return "str or path"
    if "anyOf" in child:
        return "float or sequence of float"
    if child.get("type") == "array":
        is_points = child["items"].get("type") == "array"
        return "sequence of (x, y)" if is_points else "sequence of float"
    return TYPES.get(child.get("type"), "int")


def _notes(child, required):
    """Return a sentence on range, default and other names."""
    limited = child["anyOf"][0] if "anyOf" in child else child.get("items", child)
    low = [text.format(f"{limited[k]:g}") for k, text in LIMITS[:2] if k in limited]
    high = [text.format(f"{limited[k]:g}") for k, text in LIMITS[2:] if k in limited]
    if low:
        high = [part.replace("value ", "") for part in high]
    notes = [" ".join([*low, *high])] if low or high else []
    if child.get("default") not in (None, ""):
        notes.append(f"default {_shown(child['default'])}")
    if required:
        notes.append("required")
    if "x-aliases" in child:
        notes.append(f"also {', '.join(child['x-aliases'])}")
    return f" {_capital('; '.join(notes))}." if notes else ""


def _capital(text):
    return text[0].upper() + text[1:]


def _shown(default):
    if isinstance(default, bool):
        return str(default)
    if isinstance(default, (int, float)):
        return f"{default:g}"
    if isinstance(default, list):
        return f"({', '.join(f'{value:g}' for value in default)})"
    return f'"{default}"'


def _in_shapes(schema, node, key):
    """Return the meanings of a key in all types of shapes that have the key."""
    kinds = {}
    for variant in node["oneOf"]:
        if key in variant["properties"]:
            meaning = resolve(schema, variant["properties"][key])["description"]
            kinds.setdefault(meaning, []).append(variant["title"])
    if len(kinds) == 1:
        ((meaning, titles),) = kinds.items()
        return meaning if key == "type" else f"{meaning} ({', '.join(titles)})"
    return "; ".join(f"{meaning} ({', '.join(titles)})" for meaning, titles in kinds.items())
