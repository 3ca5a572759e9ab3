"""Records: dataclasses that mirror JSON objects, some fields of which are given.

A name that is not a field, and a value that a field does not take, are errors at once. A record
keeps copies of given records, and so do its lists.
"""

from __future__ import annotations

import copy
import typing
from collections.abc import Collection, Mapping
from dataclasses import dataclass, fields
from dataclasses import field as dataclass_field
from functools import cache
from typing import TYPE_CHECKING, ClassVar, Optional, TypeVar

from snowshed._core import InputError
from snowshed.base.field_type import alternatives_of, convert, is_record, shown
from snowshed.base.json_values import JsonObject, JsonValue
from snowshed.base.messages import shortened, suggestion
from snowshed.base.owned_list import OwnedList

MAX_DEPTH = 64  # the same as in the core

RecordType = TypeVar("RecordType", bound="Record")
Value = TypeVar("Value")
#: Names of fields by the name of another field.
FieldsByField = Mapping[str, "tuple[str, ...]"]

#: Key under which the metadata of a field hold its default.
_DEFAULT = "default"


class UnknownFieldError(InputError, AttributeError, TypeError):
    """A name that is not a field of a record, as an attribute, a keyword or a key."""


def default(value: Value) -> Value:
    """Return a record's field that reads as `value` until it is given.

    Examples
    --------
    >>> @dataclass
    ... class Door(Record):
    ...     width: Optional[float] = default(0.9)
    >>> Door(), Door().width, Door(width=0.9)
    (Door(), 0.9, Door(width=0.9))
    """
    return typing.cast(Value, dataclass_field(default=None, metadata={_DEFAULT: value}))


class Alias:
    """Another name of a record's numeric field, declared in the class.

    Parameters
    ----------
    field
        The field's own name.
    """

    def __init__(self, field: str) -> None:
        self.field = field

    def __get__(self, record: object, owner: type) -> Optional[float]:
        """Return the field's value."""
        return self if record is None else getattr(record, self.field)  # type: ignore[return-value]

    def __set__(self, record: object, value: Optional[float]) -> None:
        """Set the field."""
        setattr(record, self.field, value)


class _RecordClass(type):
    """The class of record classes: it checks the keywords with which a record is made."""

    if not TYPE_CHECKING:  # checkers take the signature that `dataclass` makes

        def __call__(cls, *values: object, **keywords: object) -> object:
            names = {**cls.aliases(), **{f.name: f.name for f in fields(cls)}}
            for keyword in keywords:
                if keyword not in names:
                    raise cls._unknown(keyword)
            named = {keyword: names[keyword] for keyword in keywords}
            check_once(named, cls.__name__)
            check_instead(cls, [named[k] for k, v in keywords.items() if v is not None])
            return super().__call__(*values, **{named[key]: keywords[key] for key in keywords})


@dataclass
class Record(metaclass=_RecordClass):
    """A JSON object. A trailing underscore in a field's name is not part of its JSON key.

    A field that was not given reads as its default, or as None if it has no default or another
    field replaces it. Writing None takes a value back. Texts, comparisons, copies and JSON contain
    only the fields that were given.

    Examples
    --------
    >>> from snowshed.scene.components import Panel
    >>> panel = Panel(tilt=40)
    >>> panel
    Panel(tilt=40)
    >>> panel.tlit = 50
    Traceback (most recent call last):
    snowshed.base.record.UnknownFieldError: Panel.tlit: Panel has no such field; did you mean tilt?
    """

    #: Fields that take the place of another field. Only one of the two is given; setting one
    #: unsets the other.
    INSTEAD_OF: ClassVar[Mapping[str, str]] = {}
    #: Fields that name a choice of several others. A new choice unsets these other
    #: fields, because it decides them; values that are set with it or after it stay.
    ADOPTS: ClassVar[FieldsByField] = {}
    #: Fields whose values follow from another field unless they are given. If the other one is
    #: given, they read as None, because the core computes them.
    FOLLOWS: ClassVar[FieldsByField] = {}
    #: Fields with records whose missing values come from another part of the scene. These values
    #: read as None, because the defaults do not hold.
    INHERITS: ClassVar[tuple[str, ...]] = ()

    _has_defaults = True  # not a field

    def __init_subclass__(cls) -> None:
        """Give subclasses the methods of records that `dataclass` would replace by its own."""
        for name in ("__repr__", "__eq__"):
            if name not in vars(cls):
                setattr(cls, name, getattr(Record, name))

    def __repr__(self) -> str:
        """Return the fields that were given, as the call that makes the record."""
        return call_text(type(self), {name: repr(value) for name, value in self.given().items()})

    def __eq__(self, other: object) -> bool:
        """Return whether the same fields were given, with equal values."""
        if not isinstance(other, Record) or type(other) is not type(self):
            return NotImplemented
        return self.given() == other.given()

    def given(self) -> dict[str, object]:
        """Return the fields that were given, by name.

        Examples
        --------
        >>> from snowshed.scene.components import Snow
        >>> snow = Snow(cohesion=0.1)
        >>> snow.density, snow.given()
        (210.0, {'cohesion': 0.1})
        """
        held = vars(self)
        return {n: held[n] for n in self.keys().values() if held.get(n) is not None}

    @classmethod
    def keys(cls) -> dict[str, str]:
        """Return the JSON key of every field, as ``{key: field name}``."""
        return {f.name.rstrip("_"): f.name for f in fields(cls)}

    @classmethod
    def aliases(cls) -> dict[str, str]:
        """Return the other names of fields, as ``{name: field name}``."""
        return {
            name: attribute.field
            for name, attribute in vars(cls).items()
            if isinstance(attribute, Alias)
        }

    @classmethod
    def from_data(cls: type[RecordType], data: Mapping[str, object], path: str = "") -> RecordType:
        """Build the record from a JSON object that stands at `path` in its document.

        Raises
        ------
        InputError
            At a key the record does not have, or a value its field does not take.
        """
        if not isinstance(data, Mapping):
            raise InputError(f"{path or '/'}: {shown(data)} is not an object")
        if path.count("/") > 2 * MAX_DEPTH:
            raise InputError(f"{path[:100]}...: nested more than {MAX_DEPTH} deep")
        record = cls()
        check_once({key: cls.field_of(key, path) for key in data}, path)
        check_instead(cls, [cls.field_of(k, path) for k in data if data[k] is not None], path)
        for key, value in sorted(data.items(), key=lambda item: not cls.adopts(item[0])):
            record.assign(key, value, path)
        return record

    @classmethod
    def adopts(cls, key: str) -> bool:
        """Return whether a JSON key names a choice of several other fields."""
        return {**cls.keys(), **cls.aliases()}.get(key) in cls.ADOPTS

    def to_data(self, path: str = "", depth: int = 0) -> JsonObject:
        """Return the fields that were given, as a JSON object that stands `depth` deep at `path`.

        Raises
        ------
        InputError
            At a value that its field does not take: lists may have changed after they were set.
        """
        data: JsonObject = {}
        for key, name in self.keys().items():
            value = convert(vars(self)[name], _hints(type(self))[name], f"{path}/{key}")
            if value is not None:
                data[key] = _to_json(value, f"{path}/{key}", depth + 1)
        return data

    def assign(self, key: str, value: object, path: str = "") -> None:
        """Set one field by its JSON key; objects and lists of them become records.

        Raises
        ------
        InputError
            If the record has no such key, or its field does not take the value.
        """
        self._keep(self.field_of(key, path), value, f"{path}/{key}")

    @classmethod
    def field_of(cls, key: str, path: str = "") -> str:
        """Return the field that a JSON key stands for; an error names an unknown key."""
        keys = {**cls.keys(), **cls.aliases()}
        if key not in keys:
            allowed = ", ".join(cls.keys())
            near = suggestion(str(key), keys)
            raise InputError(
                f"{path}/{shortened(str(key), 100)}: unknown key; allowed: {allowed}{near}"
            )
        return keys[key]

    def record_type(self, key: str) -> Optional[type[Record]]:
        """Return the class of the record, or of the list of records, under `key`, if any."""
        return _record_type(_hints(type(self))[self.field_of(key)])

    def _keep(self, name: str, value: object, where: str) -> None:
        converted = _own(convert(value, _hints(type(self))[name], where))
        has_defaults = name not in self.INHERITS
        if isinstance(converted, Record) and converted._has_defaults != has_defaults:
            converted._has_defaults = has_defaults
        is_new = converted != vars(self).get(name)
        object.__setattr__(self, name, converted)
        if converted is not None:
            for decided in self.ADOPTS.get(name, ()) if is_new else ():
                object.__setattr__(self, decided, None)
            for pair in self.INSTEAD_OF.items():
                if name in pair:
                    object.__setattr__(self, pair[1 - pair.index(name)], None)

    @classmethod
    def _unknown(cls, name: str) -> UnknownFieldError:
        near = suggestion(name, [*cls.keys(), *cls.aliases()])
        has = near or f"; it has {', '.join(cls.keys())}"
        return UnknownFieldError(f"{cls.__name__}.{name}: {cls.__name__} has no such field{has}")

    def _default(self, name: str) -> object:
        """Return the default of a field; None if it has none, or another field replaces it."""
        held, defaults = vars(self), _defaults(type(self))
        if name not in defaults or not self._has_defaults:
            return None
        for pair in self.INSTEAD_OF.items():
            if name in pair and held.get(pair[1 - pair.index(name)]) is not None:
                return None
        for choice, decided in {**self.ADOPTS, **self.FOLLOWS}.items():
            if name in decided and held.get(choice) not in (None, defaults.get(choice)):
                return None
        return defaults[name]

    if not TYPE_CHECKING:  # otherwise type checkers would accept any attribute

        def __getattribute__(self, name: str) -> object:
            value = super().__getattribute__(name)
            if value is None:
                return self._default(name)
            if name == "__dataclass_fields__":  # `dataclasses.replace` and `asdict` read these
                held = vars(self)
                return {key: value[key] for key in value if held.get(key) is not None}
            return value

        def __getattr__(self, name: str) -> object:
            if name.startswith("_"):
                raise AttributeError(name)
            raise self._unknown(name)

        def __setattr__(self, name: str, value: object) -> None:
            if name in _hints(type(self)):
                self._keep(name, value, f"{type(self).__name__}.{name}")
            elif name in self.aliases() or (name.startswith("_") and hasattr(type(self), name)):
                object.__setattr__(self, name, value)
            else:
                raise self._unknown(name)


def call_text(kind: type, arguments: Mapping[str, str]) -> str:
    """Return the text of a call with keywords.

    Examples
    --------
    >>> call_text(dict, {"tilt": "40"})
    'dict(tilt=40)'
    """
    return f"{kind.__name__}({', '.join(f'{name}={text}' for name, text in arguments.items())})"


def check_once(fields_of: Mapping[str, str], where: str) -> None:
    """Raise InputError if two names, given at `where`, stand for the same field.

    Examples
    --------
    >>> check_once({"tilt": "tilt", "height": "height"}, "/panel")
    """
    name_of: dict[str, str] = {}
    for name, field in fields_of.items():
        if field in name_of:
            raise InputError(
                f"{where}/{name}: means the same as {name_of[field]}; give one of the two"
            )
        name_of[field] = name


def check_instead(record: type[Record], given: Collection[str], where: str = "") -> None:
    """Raise InputError if a field and the field whose place it takes are both given.

    Examples
    --------
    >>> from snowshed.methods.mpm.settings import MpmSettings
    >>> check_instead(MpmSettings, ["dx", "damping_rate"], "/numerics")
    """
    for field, other in record.INSTEAD_OF.items():
        if field in given and other in given:
            raise InputError(
                f"{where or record.__name__}/{field}: takes the place of {other}; "
                "give one of the two"
            )


@cache
def _hints(record: type[Record]) -> dict[str, object]:
    """Return the type of every field; the annotations are evaluated once, which is slow."""
    hints = typing.get_type_hints(record)
    return {f.name: hints[f.name] for f in fields(record)}


@cache
def _defaults(record: type[Record]) -> Mapping[str, object]:
    return {f.name: f.metadata[_DEFAULT] for f in fields(record) if _DEFAULT in f.metadata}


def _own(value: object) -> object:
    """Return a copy if the value is a record or a list, because the caller may change it later."""
    if isinstance(value, list):
        return OwnedList(value)
    return copy.deepcopy(value) if isinstance(value, Record) else value


def _record_type(hint: object) -> Optional[type[Record]]:
    for kind in alternatives_of(hint):
        for inner in (kind, *typing.get_args(kind)):
            if is_record(inner):
                return typing.cast("type[Record]", inner)
    return None


def _to_json(value: object, path: str, depth: int) -> JsonValue:
    if depth > MAX_DEPTH:
        raise InputError(f"{path}: nested more than {MAX_DEPTH} deep")
    if isinstance(value, Record):
        return value.to_data(path, depth)
    if isinstance(value, (list, tuple)):
        return [_to_json(item, f"{path}/{i}", depth + 1) for i, item in enumerate(value)]
    return typing.cast("JsonValue", value)  # a scalar, checked
