"""The entry of a method: all that the rest of the package needs of the method."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any

import snowshed._core as _core
from snowshed.base.missing_result import MissingResultError
from snowshed.methods.settings import MethodSettings


@dataclass(frozen=True)
class Method:
    """A method, as its folder declares it in ``METHOD``.

    Scenes need the settings. The code that runs a scene and reads its results belongs to a higher
    layer than scenes; it is therefore named as ``package.module:name``, and imported when used.

    Attributes
    ----------
    name
        Name of the method in a scene.
    title
        Heading of pages that show its runs.
    settings
        Class of its settings.
    run
        Name of the subclass of `snowshed.running.method_run.MethodRun` that runs its scenes.
    results
        Results that other methods do not have: for each attribute of `snowshed.Results`, the name
        of the function that reads it from a results folder.
    in_memory
        Results that a simulation in memory has already: for each attribute of
        `snowshed.Simulation`, the name of the function that returns it from the core's simulation
        and the data of the scene.
    ages
        Whether its snow can settle and sinter between events.
    has_grid
        Whether its particles give their mass and momentum to the nodes of a grid.
    """

    name: str
    title: str
    settings: type[MethodSettings]
    run: str
    results: Mapping[str, str] = field(default_factory=dict)
    in_memory: Mapping[str, str] = field(default_factory=dict)
    ages: bool = False
    has_grid: bool = False

    def run_class(self) -> Any:
        """Return the class that runs its scenes."""
        return imported(self.run)

    def read(self, result: str, folder: Any) -> Any:
        """Return one of its `results` from a folder.

        Raises
        ------
        MissingResultError
            If the method has no such result, or the folder does not contain it.
        InputError
            If it is damaged.
        """
        if result not in self.results:
            raise self.missing(result, folder)
        return imported(self.results[result])(folder)

    def compute(self, result: str, core: _core.Simulation, scene: Mapping[str, Any]) -> Any:
        """Return one of the results `in_memory` of a simulation, whose scene has the data `scene`.

        Raises
        ------
        MissingResultError
            If the method has no such result.
        """
        if result not in self.in_memory:
            raise MissingResultError(f'/method: the method "{self.name}" has no {result}')
        return imported(self.in_memory[result])(core, scene)

    def missing(self, result: str, folder: Any) -> MissingResultError:
        """Return the error for a result of a folder that the method does not have.

        Examples
        --------
        >>> print(Method("none", "", MethodSettings, "").missing("maps", "out"))
        out: the method "none" has no maps; it has particles, film
        """
        known = ", ".join((*self.results, "particles", "film"))
        return MissingResultError(
            f'{folder}: the method "{self.name}" has no {result}; it has {known}'
        )


def imported(name: str) -> Any:
    """Return the object with the name ``package.module:name``.

    Examples
    --------
    >>> imported("math:pi") > 3
    True
    """
    module, _, attribute = name.partition(":")
    return attrgetter(attribute)(importlib.import_module(module))
