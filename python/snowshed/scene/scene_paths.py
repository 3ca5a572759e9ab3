"""Dotted paths into a scene, such as "obstacles.0.friction"."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import List, Union

from snowshed._core import InputError
from snowshed.base.record import Record

Holder = Union[Record, List[Record]]


@contextmanager
def locate(scene: Record, path: str) -> Iterator[tuple[Record, str, str]]:
    """Yield the record that holds the last part of `path`, that part, and the record's position.

    A missing record along the path is created; after an error it is removed again.
    """
    *parents, key = path.split(".")
    holder: Holder = scene
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
