"""A row of conversions.csv: changes of the stack by reseeding (between = "reseed")."""

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
    """Return the changes of mass, height, length and outline by the conversion before an event.

    Parameters
    ----------
    event
        The event that follows.
    conversion
        Result of the core's ``begin_event``: positions, masses, initial densities and
        on_panel, each before and after.
    measure
        Function that measures a stack from positions, masses, densities and on_panel.

    Returns
    -------
    dict
        `CONVERSION_COLUMNS`. Masses include the snow on the panel, heights and lengths do not.
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


def outline_difference(first: Floats, second: Floats) -> float:
    """Return the root mean square of the difference in height of two outlines, m.

    The mean is over 30 columns in the range of x that both cover; NaN without such a range.

    Parameters
    ----------
    first, second : (k, 2)
        Outlines, as in `Extent`.

    Examples
    --------
    >>> ridge = np.array([[0.0, 0.0], [1.0, 0.2], [2.0, 0.0]])
    >>> round(outline_difference(ridge, ridge + [0, 0.01]), 6)
    0.01
    """
    if len(first) == 0 or len(second) == 0:
        return float("nan")
    low, high = max(first[0, 0], second[0, 0]), min(first[-1, 0], second[-1, 0])
    if low > high:
        return float("nan")
    columns = low + (high - low) * (np.arange(CELLS) + 0.5) / CELLS
    difference = np.interp(columns, *first.T) - np.interp(columns, *second.T)
    return float(np.sqrt(np.mean(difference**2)))
