"""Records: dataclasses that mirror JSON objects. A field that is None was not given."""

from __future__ import annotations

import os
import sys
import typing
from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass
from functools import cache
from typing import Any, TypeVar

from snowshed._core import InputError

DEEPEST = 64  # as the core has it

RecordType = TypeVar("RecordType", bound="Record")


@dataclass
class Record:
    """A JSON object. A trailing underscore in a field's name is not part of its JSON key."""

    @classmethod
    def keys(cls) -> dict[str, str]:
        """Return the JSON key of every field, as ``{key: field name}``."""
        return {f.name.rstrip("_"): f.name for f in fields(cls)}

    @classmethod
    def from_data(cls: type[RecordType], data: Mapping[str, Any], path: str = "") -> RecordType:
        """Build the record from a JSON object that stands at `path` in its document."""
        if not isinstance(data, Mapping):
            raise InputError(f"{path or '/'}: {data!r} is not an object")
        record = cls()
        for key, value in data.items():
            record.assign(key, value, path)
        return record

    def to_data(self, path: str = "", depth: int = 0) -> dict[str, Any]:
        """Return the fields that were given, as a JSON object that stands `depth` deep at `path`.

        Raises
        ------
        InputError
            At a value that JSON does not have.
        """
        given = {key: getattr(self, name) for key, name in self.keys().items()}
        return {
            key: _to_json(value, f"{path}/{key}", depth + 1)
            for key, value in given.items()
            if value is not None
        }

    def assign(self, key: str, value: Any, path: str = "") -> None:
        """Set one field by its JSON key; objects and lists of them become records."""
        name = self.field_of(key, path)
        setattr(self, name, _from_json(self.record_type(key), value, f"{path}/{key}"))

    def field_of(self, key: str, path: str = "") -> str:
        """Return the field a JSON key stands for; unknown keys are refused by name."""
        keys = self.keys()
        if key not in keys:
            raise InputError(f"{path}/{key}: unknown key; allowed: {', '.join(keys)}")
        return keys[key]

    @classmethod
    def record_type(cls, key: str) -> type[Record] | None:
        """Return the record class held, singly or in a list, under `key`, if any."""
        # mypy takes the class for one of its instances, which have no hash.
        return _record_types(cls)[cls.keys()[key]]  # type: ignore[arg-type]


@cache
def _record_types(record: type[Record]) -> dict[str, type[Record] | None]:
    """Return the record class of every field; the hints are evaluated once, which is slow."""
    return {name: _find_record(hint) for name, hint in typing.get_type_hints(record).items()}


def _find_record(hint: Any) -> type[Record] | None:
    if isinstance(hint, type) and is_dataclass(hint) and issubclass(hint, Record):
        return hint
    found = (_find_record(inner) for inner in typing.get_args(hint))
    return next((record for record in found if record), None)


def _from_json(record: type[Record] | None, value: Any, path: str) -> Any:
    if path.count("/") > 2 * DEEPEST:
        raise InputError(f"{path[:100]}...: nested more than {DEEPEST} deep")
    if record is None or value is None or isinstance(value, Record):
        return value
    if isinstance(value, (list, tuple)):
        return [_from_json(record, item, f"{path}/{i}") for i, item in enumerate(value)]
    return record.from_data(value, path)


def _to_json(value: Any, path: str, depth: int = 0) -> Any:
    if depth > DEEPEST:
        raise InputError(f"{path}: nested more than {DEEPEST} deep")
    if isinstance(value, Record):
        return value.to_data(path, depth)
    if hasattr(value, "tolist"):  # NumPy scalars and arrays
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [_to_json(item, f"{path}/{i}", depth + 1) for i, item in enumerate(value)]
    if isinstance(value, Mapping):
        return {str(key): _to_json(value[key], f"{path}/{key}", depth + 1) for key in value}
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if not (value is None or isinstance(value, (bool, int, float, str))):
        raise InputError(f"{path}: {value!r} is not a number, text, list or object")
    if isinstance(value, (int, float)) and not abs(value) <= sys.float_info.max:
        shown = value if isinstance(value, float) else f"an integer of {value.bit_length()} bits"
        raise InputError(f"{path}: {shown} is not a finite number")
    if isinstance(value, str) and any("\ud800" <= c <= "\udfff" for c in value):
        raise InputError(f"{path}: {value!a} is not text: it has half a surrogate pair")
    return value
