"""Laws of one's own in studies: named, so that every process that computes runs can make them.

The JSON object of a run has the additional key ``laws``: the name of the function that makes them,
and the files of their source. The identity of the run covers the contents of these files, and the
code of the functions where it can be known (`snowshed.running.law_digest`).
"""

from __future__ import annotations

import importlib
import inspect
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any, Optional

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.messages import quoted
from snowshed.base.paths import PathLike, utf8_path
from snowshed.io.input_file import read_regular
from snowshed.running.laws import Laws

NAME = re.compile(r"([A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*):([A-Za-z_]\w*)", re.ASCII)
MAX_FILES = 100


@checked
@dataclass(frozen=True)
class NamedLaws:
    """Laws of one's own, by the name of the function that makes them.

    Attributes
    ----------
    make
        ``"module:name"``: a function without arguments that returns `Laws`, or the laws themselves.
        Python finds the module on its path in every process that computes runs.
    files
        Further files of the source, such as C code that the module compiles. A change in them, or
        in the module's own file, makes other runs.

    Raises
    ------
    InputError
        If the name is not of this form, or of a script or a notebook, which cannot be imported.

    Examples
    --------
    >>> NamedLaws("my_laws:sand").make
    'my_laws:sand'
    """

    make: str
    files: Sequence[PathLike] = ()

    def __post_init__(self) -> None:
        match = NAME.fullmatch(self.make)
        if match is None:
            raise InputError(f'laws: {quoted(self.make)} is not of the form "module:name"')
        if match[1] == "__main__":
            raise InputError(
                "laws: __main__ is a script or a notebook, which other processes cannot import; "
                "put the function into a module"
            )
        if len(self.files) > MAX_FILES:
            raise InputError(f"laws: {len(self.files)} files; at most {MAX_FILES} are allowed")
        object.__setattr__(self, "files", tuple(utf8_path(Path(f).absolute()) for f in self.files))

    def laws(self) -> Laws:
        """Import the module and make the laws.

        Raises
        ------
        InputError
            If there is no such module or function, or it does not return `Laws`.
        """
        module, name = self._module(), self.make.partition(":")[2]
        member = getattr(module, name, None)
        if member is None:
            raise InputError(f"laws: the module {module.__name__} has no {name}")
        laws = member() if callable(member) else member
        if not isinstance(laws, Laws):
            raise InputError(f"laws: {self.make} gives a {type(laws).__name__}; needed: Laws")
        return laws

    def data(self, precision: str = "double") -> dict[str, object]:
        """Return the laws as JSON data of a run; raises InputError as `laws` does.

        `precision` is that of the run's scene.
        """
        sources = [_source(self._module()), *map(str, self.files)]
        data: dict[str, object] = {
            "make": self.make,
            "sources": [{"file": file} for file in sources],
        }
        digest = _digest(self, precision, tuple(map(_state, sources)))
        return data if digest is None else {**data, "digest": digest}

    def _module(self) -> ModuleType:
        name = self.make.partition(":")[0]
        try:
            return importlib.import_module(name)
        except ModuleNotFoundError as error:
            raise InputError(
                f"laws: no module {error.name} on Python's path; set PYTHONPATH to its folder"
            ) from None


@lru_cache(maxsize=16)
def _digest(named: NamedLaws, precision: str, sources: tuple[object, ...]) -> Optional[str]:
    """Return the digest of the laws' code; made again when a source changes."""
    return named.laws().digest(precision)


def _state(file: str) -> tuple[int, int]:
    facts = Path(file).stat()
    return facts.st_mtime_ns, facts.st_size


def laws_of_run(scene: Mapping[str, Any]) -> Optional[Laws]:
    """Make the laws of a run; None if it has none.

    Parameters
    ----------
    scene
        JSON data of a run.

    Raises
    ------
    InputError
        If the data are damaged, the laws cannot be made, or the module has another source here than
        where the study was made.
    """
    data = scene.get("laws")
    if data is None:
        return None
    try:
        named = NamedLaws(data["make"])
        source = data["sources"][0]["file"]
    except (KeyError, IndexError, TypeError):
        raise InputError("scene: laws: damaged") from None
    here = _source(named._module())
    if read_regular(Path(here)) != read_regular(Path(source)):
        raise InputError(f"laws: {here} differs from {source}, with which the study was made")
    return named.laws()


def _source(module: ModuleType) -> str:
    """Return the path of a module's source, or of its compiled file."""
    try:
        file = inspect.getsourcefile(module) or module.__file__
    except TypeError:
        file = None
    if not file:
        raise InputError(f"laws: the module {module.__name__} has no file")
    return utf8_path(Path(file).absolute())
