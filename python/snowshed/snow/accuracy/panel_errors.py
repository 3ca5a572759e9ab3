"""Errors of the grid on several recorded panels, in the laboratory and of the size of plants.

The stacks of one panel are too high after one slide-off and too low after another. The error of one
of them may therefore be small by chance, and the span over all panels stands beside it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Optional

from snowshed.base.formatting import number_span, percent_span, plural
from snowshed.snow.accuracy.mechanisms import SCHEME, Mechanisms

if TYPE_CHECKING:
    import pandas as pd

#: Errors of mean stacks relative to the finest recorded grid of their scheme, from
#: ``benchmarks/stack_grid.py``: the laboratory's panels, and panels of the thesis's chapter 5.
TABLE = Path(__file__).with_name("panel-errors.csv")
DIMENSION, CELLS, SLIDE_OFFS = "dimension", "cells", "slide_offs"
PANEL = ("tilt", "panel_length", "friction")
ERRORS = {"height": "height_error", "length": "length_error"}
COLUMNS = (SCHEME, DIMENSION, *PANEL, CELLS, SLIDE_OFFS, *ERRORS.values())
ROUNDING = 1e-6


@dataclass(frozen=True)
class PanelErrors:
    """Errors of recorded stacks, as spans from the smallest to the largest.

    Attributes
    ----------
    spans
        Relative errors of "height" and "length"; positive: too large.
    panels
        The recorded panels, such as "7 panels in 2D".
    slide_offs
        Fewest slide-offs of which the stacks are made.
    cells
        Fewest and most cells across their slabs.

    Examples
    --------
    >>> errors = panel_errors(Mechanisms("objective"), cells=2.0, slide_offs=5)
    >>> errors.panels, errors.slide_offs, errors.cells
    ('4 panels in 2D', 5, (2.0, 4.0))
    """

    spans: Mapping[str, tuple[float, float]]
    panels: str
    slide_offs: int
    cells: tuple[float, float]

    @property
    def sentence(self) -> str:
        """The spans of height and length with their recorded stacks, as a clause."""
        spans = ", ".join(
            f"{name} {self.span(name, 'too large', 'too small')}" for name in self.spans
        )
        return (
            f"all recorded panels ({self.panels}, {self.slide_offs} or more slide-offs, "
            f"{self.cells_text}): {spans}"
        )

    @property
    def cells_text(self) -> str:
        """The cells across the slabs."""
        return f"{number_span(*self.cells)} cells in the slab"

    def span(self, quantity: str, more: str, less: str) -> str:
        """Return the errors of "height" or "length" in percent, with words for their signs."""
        low, high = self.spans[quantity]
        return percent_span(100 * low, 100 * high, more, less)

    def largest(self, quantity: str) -> float:
        """Return the largest relative error of "height" or "length", without its sign."""
        return max(map(abs, self.spans[quantity]))


def panel_errors(
    mechanisms: Mechanisms, cells: float, slide_offs: int, *, planar: bool = False
) -> Optional[PanelErrors]:
    """Return the errors of all recorded panels with a scheme.

    Stacks of fewer slide-offs and grids with fewer cells in the slab are left out, except those of
    the most slide-offs and the finest grid.

    Parameters
    ----------
    mechanisms
        The scheme, and settings that depart from it.
    cells
        Number of cells across the slab.
    slide_offs
        Number of slide-offs of which the stack is made.
    planar
        Whether to leave out stacks in 3D.

    Returns
    -------
    PanelErrors or None
        None if nothing was recorded for the mechanisms.

    Examples
    --------
    >>> errors = panel_errors(Mechanisms("objective"), cells=2.0, slide_offs=1)
    >>> errors.largest("height") > 0.3
    True
    >>> panel_errors(Mechanisms("objective", {"damping_length": 0.02}), 2.0, 1) is None
    True
    """
    if mechanisms.overrides or mechanisms.scheme not in recorded_schemes():
        return None
    rows = _table()
    rows = rows[(rows[SCHEME] == mechanisms.scheme) & ~(planar & (rows[DIMENSION] == 3))]
    slide_offs = min(slide_offs, int(rows[SLIDE_OFFS].max()))
    rows = rows[rows[SLIDE_OFFS] >= slide_offs]
    rows = rows[rows[CELLS] > min(cells, rows[CELLS].max()) - ROUNDING]
    return PanelErrors(
        {
            name: (float(rows[column].min()), float(rows[column].max()))
            for name, column in ERRORS.items()
        },
        _panels_text(rows),
        slide_offs,
        (float(rows[CELLS].min()), float(rows[CELLS].max())),
    )


def recorded_schemes() -> list[str]:
    """Return the schemes whose panels are recorded."""
    return sorted(set(_table()[SCHEME]))


def _panels_text(rows: pd.DataFrame) -> str:
    counts = rows.drop_duplicates([DIMENSION, *PANEL])[DIMENSION].value_counts().sort_index()
    return " and ".join(f"{plural(int(n), 'panel')} in {d}D" for d, n in counts.items())


@cache
def _table() -> pd.DataFrame:
    import pandas as pd

    return pd.read_csv(TABLE)
