"""A row of conversions.csv: how far reseeding moved the stack (between = "reseed")."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from snowshed.base.arrays import Booleans, Floats
from snowshed.snow.stack.surface import CELLS

if TYPE_CHECKING:
    from snowshed.snow.stack.measure import StackMeasure

Measure = Callable[[Floats, Floats, Floats, Booleans], "StackMeasure"]


def conversion_row(event: int, conversion: dict[str, Any], measure: Measure) -> dict[str, Any]:
    """Return what the conversion before an event did to mass, height, length and outline.

    Parameters
    ----------
    event
        The event that follows.
    conversion
        What the core's ``begin_event`` returned: positions, masses, initial densities and
        on_panel, each before and after.
    measure
        Measures the stack that positions, masses, densities and on_panel make.

    Returns
    -------
    dict
        `CONVERSION_COLUMNS`; masses with, heights and lengths without the snow on the panel.
    """
    row: dict[str, Any] = {"event": event}
    outlines = []
    for when in ("before", "after"):
        masses = conversion[f"masses_{when}"]
        stack = measure(
            conversion[f"positions_{when}"],
            masses,
            conversion[f"densities_{when}"],
            conversion[f"on_panel_{when}"],
        )
        row[f"mass_{when}_kg"] = float(masses.sum())
        row[f"particles_{when}"] = len(masses)
        row[f"height_{when}_m"] = stack.height
        row[f"length_{when}_m"] = stack.length
        outlines.append(stack.outline)
    return {**row, "outline_rms_m": outline_difference(*outlines)}


def outline_difference(one: Floats, other: Floats) -> float:
    """Return the root mean square of the difference in height of two outlines, m.

    Taken in 30 columns over the range of x that both cover; NaN if there is none.

    Parameters
    ----------
    one, other : (k, 2)
        Outlines as of `Extent`.

    Examples
    --------
    >>> ridge = np.array([[0.0, 0.0], [1.0, 0.2], [2.0, 0.0]])
    >>> round(outline_difference(ridge, ridge + [0, 0.01]), 6)
    0.01
    """
    if len(one) == 0 or len(other) == 0:
        return float("nan")
    low, high = max(one[0, 0], other[0, 0]), min(one[-1, 0], other[-1, 0])
    if low > high:
        return float("nan")
    columns = low + (high - low) * (np.arange(CELLS) + 0.5) / CELLS
    difference = np.interp(columns, *one.T) - np.interp(columns, *other.T)
    return float(np.sqrt(np.mean(difference**2)))
