"""Results that only some methods have."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Union, cast

if TYPE_CHECKING:
    import pandas as pd
    import xarray


class MethodResults(ABC):
    """Results that only some methods have: at the end of a run, or of a simulation up to now.

    If the scene's method has no such result, the attribute raises an InputError that is also an
    AttributeError, so that `hasattr` returns False.
    """

    @abstractmethod
    def result(self, name: str) -> object:
        """Return a result of the scene's method by its name, such as "maps"."""

    @property
    def maps(self) -> xarray.Dataset:
        """The maps of a slide at the nodes of its grid: largest values over time, and at the end.

        Needs xarray (extra ``study``).
        """
        return cast("xarray.Dataset", self.result("maps"))

    @property
    def curve(self) -> pd.DataFrame:
        """The curve of a loading test: strains, stresses, bonds and contacts over time."""
        return cast("pd.DataFrame", self.result("curve"))

    @property
    def forces(self) -> Union[pd.DataFrame, xarray.Dataset]:
        """The forces between the snow and what it touches.

        For a run that makes a stack and has ``output.forces``: the forces on each obstacle over
        time (`snowshed.results.obstacle_forces`). For a loading test: a table of the contacts
        between grains at its end.
        """
        return cast("Union[pd.DataFrame, xarray.Dataset]", self.result("forces"))
