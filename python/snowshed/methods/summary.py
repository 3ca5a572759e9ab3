"""The summary of a run with a single event: its figures, in a JSON file of the results folder."""

from __future__ import annotations

import json
import typing
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any, ClassVar, TypeVar

from snowshed._core import InputError
from snowshed.base.missing_result import MissingResultError
from snowshed.base.paths import PathLike
from snowshed.io.atomic import write_text
from snowshed.io.json_file import read_object
from snowshed.io.run_files import check_run_file

Summarised = TypeVar("Summarised", bound="Summary")

#: Names that figures had in files of earlier versions.
FORMER_NAMES = {
    "duration_s": "sim_time_s",
    "particles": "final_particles",
    "grains": "final_particles",
}


@dataclass(frozen=True)
class Summary(ABC):
    """The figures of a run; a method's summary is a subclass whose fields are the figures."""

    #: File in the results folder.
    FILE: ClassVar[str]
    #: Heading of the figures on pages and in the terminal.
    TITLE: ClassVar[str]
    #: Other files in the folder that people open.
    OPENED: ClassVar[str]
    #: Fields with remarks, which are not columns of a table.
    REMARKS: ClassVar[tuple[str, ...]] = ("notes",)

    @classmethod
    def columns(cls) -> Mapping[str, type]:
        """Return the columns in a table of many runs, each with its type: int, float or str."""
        hints = typing.get_type_hints(cls)
        names = [field.name for field in fields(cls) if field.name not in cls.REMARKS]
        return {name: (typing.get_args(hints[name]) or (hints[name],))[0] for name in names}

    @classmethod
    def read(cls: type[Summarised], folder: PathLike) -> Summarised:
        """Read the summary of a results folder, also one of an earlier version.

        Raises
        ------
        MissingResultError
            If the file is missing.
        InputError
            If it is not the file that the run wrote.
        """
        file = Path(folder) / cls.FILE
        if not file.is_file():
            raise MissingResultError(f"{file}: missing; a run writes it at its end")
        check_run_file(file)
        figures = {FORMER_NAMES.get(name, name): value for name, value in read_object(file).items()}
        given = {
            field.name: _in_tuples(figures.get(field.name))
            for field in fields(cls)
            if field.name in figures or _may_be_none(cls, field.name)
        }
        try:
            return cls(**given)
        except TypeError as error:
            raise InputError(f"{file}: damaged: {error}") from None

    def write(self, folder: Path) -> None:
        """Write the summary into a results folder."""
        write_text(folder / self.FILE, json.dumps(asdict(self), indent=2) + "\n")

    @abstractmethod
    def lines(self) -> Mapping[str, str]:
        """Return the lines that people read, by name."""


def _may_be_none(summary: type[Summary], name: str) -> bool:
    return type(None) in typing.get_args(typing.get_type_hints(summary)[name])


def _in_tuples(value: object) -> Any:
    return tuple(value) if isinstance(value, list) else value
