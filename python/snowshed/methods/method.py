"""The entry of a method: all that the rest of the package needs of the method."""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from operator import attrgetter
from typing import Any

from snowshed._core import InputError
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
    ages: bool = False
    has_grid: bool = False

    def run_class(self) -> Any:
        """Return the class that runs its scenes."""
        return imported(self.run)

    def read(self, result: str, folder: Any) -> Any:
        """Return one of its `results` from a folder.

        Raises
        ------
        InputError
            If the method has no such result, or the folder does not contain it.

        Examples
        --------
        >>> Method("none", "", MethodSettings, "").read("maps", "out")
        Traceback (most recent call last):
        snowshed._core.InputError: out: the method "none" has no maps; it has particles, film
        """
        if result not in self.results:
            known = ", ".join((*self.results, "particles", "film"))
            raise InputError(f'{folder}: the method "{self.name}" has no {result}; it has {known}')
        return imported(self.results[result])(folder)


def imported(name: str) -> Any:
    """Return the object with the name ``package.module:name``.

    Examples
    --------
    >>> imported("math:pi") > 3
    True
    """
    module, _, attribute = name.partition(":")
    return attrgetter(attribute)(importlib.import_module(module))
