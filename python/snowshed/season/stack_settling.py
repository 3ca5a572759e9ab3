"""An estimate of the settling of the stack since the last slide-off, and of its melt.

The simulated stack settles just before the next event (`snowshed.running.ageing`), and does not
melt. The snow below its crest is treated as a column with the mean density of the stack, which
settles under its own weight and has lost its melt since the first event from its top. The ratio of
its thickness to the simulated height lowers the whole profile. The estimate is used in the table
only.

The depth of the natural cover is added to the stack's height, because snow falls on both alike. Its
melt then counts for both, too: the stack melts only while the ground beside it is bare.
"""

from __future__ import annotations

from typing import Optional

from snowshed.season.settling_column import SnowColumn
from snowshed.snow.relations.settling import SettlingLaw


class SettlingStack:
    """The column of snow below the crest of a stack.

    Parameters
    ----------
    law
        The law of settling; None: it does not settle.
    gravity
        Gravity, m/s2.

    Examples
    --------
    >>> stack = SettlingStack(None, 9.81)
    >>> stack.set_stack(0.5, 200.0)
    >>> stack.melt(20.0)
    >>> stack.ratio
    0.8
    >>> stack.set_stack(1.0, 200.0)  # after another event: the melt counts once
    >>> stack.ratio
    0.9
    """

    def __init__(self, law: Optional[SettlingLaw], gravity: float) -> None:
        self._law = law
        self._column = SnowColumn(load_factor=gravity)
        self._height, self._melted = 0.0, 0.0

    @property
    def ratio(self) -> float:
        """Ratio of settled to simulated height, at most 1."""
        return min(self._column.thickness / self._height, 1.0) if self._height else 1.0

    def set_stack(self, height: float, density: float) -> None:
        """Set the stack to the height, m, and the density, kg/m3, that an event left."""
        self._column.clear()
        self._column.add(height * density, density)
        self._column.melt(self._melted)
        self._height = height

    def settle(self, seconds: float, temperature: float) -> None:
        """Settle the stack for some time, s, at an air temperature, degrees C."""
        self._column.settle(self._law, seconds, temperature)

    def melt(self, mass: float) -> None:
        """Take a mass, kg/m2, away from the top; without a stack nothing melts."""
        if self._height:
            self._melted += min(mass, self._column.mass)
            self._column.melt(mass)
