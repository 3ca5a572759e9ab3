"""How far a stack settles between events: an estimate beside the simulation.

The simulated stack keeps its shape between events. Here the snow below its crest is a column: every
event adds what the crest grew by, with the mean density of the stack, and the column settles under
its own weight until the next. The ratio of its thickness to the simulated height then lowers the
whole profile. The simulation itself does not feel it: later slabs slide onto the unsettled stack.
"""

from __future__ import annotations

from typing import Optional

from snowshed.season.column import SnowColumn
from snowshed.snow_relations.settling import SettlingLaw


class SettlingStack:
    """The column of snow below the crest of a stack.

    Parameters
    ----------
    law
        How it settles; None: not at all.
    gravity
        m/s2.

    Examples
    --------
    >>> stack = SettlingStack(None, 9.81)
    >>> stack.grow(0.5, 200.0)
    >>> stack.ratio
    1.0
    """

    def __init__(self, law: Optional[SettlingLaw], gravity: float) -> None:
        self._law = law
        self._column = SnowColumn(load_factor=gravity)
        self._height = 0.0

    @property
    def ratio(self) -> float:
        """Settled over simulated height, at most 1."""
        return min(self._column.thickness / self._height, 1.0) if self._height else 1.0

    def grow(self, height: float, density: float) -> None:
        """Let an event bring the crest to a height, m; density: of the stack, kg/m3."""
        self._column.add(max(height - self._height, 0.0) * density, density)
        self._height = max(height, self._height)

    def wait(self, seconds: float, temperature: float) -> None:
        """Let time pass at an air temperature, degrees C."""
        self._column.settle(self._law, seconds, temperature)
