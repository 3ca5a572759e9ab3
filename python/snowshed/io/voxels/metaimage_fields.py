"""The fields of the header of a MetaImage file."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Optional

from snowshed._core import InputError
from snowshed.base.messages import quoted
from snowshed.io.input_file import open_regular

MAX_HEADER = 1 << 16
LAST = "ElementDataFile"


@dataclass(frozen=True)
class HeaderFields:
    """Fields of a header; every error names the field and its content.

    Attributes
    ----------
    path
        The file.
    values
        Texts by the names of the fields.
    end
        End of the header, bytes.
    """

    path: Path
    values: Mapping[str, str]
    end: int

    @classmethod
    def read(cls, path: Path) -> HeaderFields:
        """Return the fields up to `LAST`, which ends a header.

        Raises
        ------
        InputError
            If it has no such end, or names a field twice.
        OSError
            If the file cannot be read.
        """
        with open_regular(path) as file:
            head = file.read(MAX_HEADER)
        fields: dict[str, str] = {}
        position = 0
        while LAST not in fields:
            end = head.find(b"\n", position)
            line = head[position : end if end >= 0 else len(head)].decode("utf-8", "replace")
            if not line.strip() and end >= 0:
                position = end + 1
                continue
            name, separator, value = _split_field(line)
            if not separator or (end < 0 and len(head) == MAX_HEADER):
                raise InputError(f"{path}: damaged: no line {LAST} = ... in its header")
            if name in fields:
                raise InputError(f"{path}: {quoted(name)} occurs twice in its header")
            fields[name] = value
            position = end + 1 if end >= 0 else len(head)
            if position >= len(head) and LAST not in fields:
                raise InputError(f"{path}: damaged: its header ends before {LAST}")
        return cls(path, fields, position)

    def has(self, name: str) -> bool:
        """Return whether the header has a field."""
        return name in self.values

    def given(self, *names: str) -> Optional[str]:
        """Return the first of several names of one field that the header has, if any."""
        return next((name for name in names if name in self.values), None)

    def text(self, name: str, default: str) -> str:
        """Return the text of a field."""
        return self.values.get(name, default)

    def flag(self, name: str, default: bool) -> bool:
        """Return a field that is True or False."""
        if name not in self.values:
            return default
        truths = {"true": True, "t": True, "1": True, "false": False, "f": False, "0": False}
        truth = truths.get(self.values[name].lower())
        if truth is None:
            raise self.wrong(name, "True or False is needed")
        return truth

    def whole_number(self, name: str, default: int) -> int:
        """Return a field that is a whole number from 0."""
        if name not in self.values:
            return default
        if not re.fullmatch(r"[0-9]{1,18}", self.values[name]):
            raise self.wrong(name, "a whole number is needed")
        return int(self.values[name])

    def numbers(self, name: str, count: int, default: Optional[list[float]] = None) -> list[float]:
        """Return a field of some finite numbers."""
        if default is not None and name not in self.values:
            return default
        many = {1: "a number is", 3: "three numbers are", 9: "nine numbers are"}[count]
        try:
            numbers = [float(word) for word in self.values[name].split()]
        except (KeyError, ValueError):
            raise self.wrong(name, f"{many} needed") from None
        if len(numbers) != count or not all(math.isfinite(number) for number in numbers):
            raise self.wrong(name, f"{many} needed")
        return numbers

    def wrong(self, name: str, needed: str) -> InputError:
        """Return the error for a field with a wrong value."""
        return InputError(f"{self.path}: {name} {quoted(self.values.get(name, ''))}: {needed}")


def _split_field(line: str) -> tuple[str, str, str]:
    """Return name, separator and value of a line; both = and : separate, as in MetaIO."""
    match = re.match(r"([^=:]*)([=:])(.*)", line, re.DOTALL)
    return (match[1].strip(), match[2], match[3].strip()) if match else (line, "", "")
