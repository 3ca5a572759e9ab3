"""Rows of equal panels in a season: every row catches and sheds the same snow at the same time."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any, Optional

from snowshed._core import InputError
from snowshed.scene.builders.panels import further_rows, row_board
from snowshed.scene.components import Body, Layer
from snowshed.scene.panel_edge import ground_tilt
from snowshed.scene.scene import Scene

MAX_ROWS = 20


@dataclass(frozen=True)
class PanelRows:
    """Equal panels, one behind the other down the slide direction.

    Attributes
    ----------
    count
        Number of rows, 1 to 20; the first is the scene's panel.
    pitch
        Horizontal distance from a row to the next, m; 0 for a single row.

    Examples
    --------
    >>> PanelRows(3, 6.0).count, PanelRows().count
    (3, 1)
    """

    count: int = 1
    pitch: float = 0.0

    def __post_init__(self) -> None:
        if not 1 <= self.count <= MAX_ROWS:
            raise InputError(f"rows: {self.count}; allowed: 1 to {MAX_ROWS}")
        if not (math.isfinite(self.pitch) and 0.0 <= self.pitch <= 1000.0):
            raise InputError(f"pitch: {self.pitch:g} m; allowed: 0 to 1000 m")
        if self.count > 1 and self.pitch == 0.0:
            raise InputError("pitch: missing; several rows need the distance from one to the next")
        if self.count == 1 and self.pitch > 0.0:
            raise InputError("pitch: not allowed for a single row; give the number of rows")

    def distances(self, scene: Mapping[str, Any]) -> list[float]:
        """Return the distance of each row from the first, along the ground of a scene, m."""
        along = self.pitch / math.cos(math.radians(ground_tilt(scene)))
        return [number * along for number in range(self.count)]


SINGLE_ROW = PanelRows()


def check_rows(rows: PanelRows, scene: Mapping[str, Any]) -> None:
    """Raise InputError if the rows of a scene's panel overlap, whether or not snow slides."""
    if rows.count > 1:
        further_rows(scene, rows.count, rows.pitch)


def snow_stays_on_a_row(rows: PanelRows, error: str) -> Optional[int]:
    """Return the slide-off that the core could not lay on a row, because snow stayed on it.

    Parameters
    ----------
    rows
        The rows of the season.
    error
        Text of an error of its run.

    Returns
    -------
    int or None
        None if there is a single row, or the error has another cause.
    """
    event = re.search(r"in event (\d+), .* within snow that is already there", error)
    return int(event[1]) if event and rows.count > 1 else None


@contextmanager
def lying_snow_named(rows: PanelRows) -> Iterator[None]:
    """Say what it means if the core cannot lay snow on a row, because snow stayed on it."""
    try:
        yield
    except InputError as error:
        event = snow_stays_on_a_row(rows, str(error))
        if event is None:
            raise
        raise InputError(
            f"rows: before slide-off {event}, snow stays on a lower row, because the stack "
            "reaches it; that row is buried, and no further snow can be laid on it. Give a greater "
            "height"
        ) from None


def add_rows(scene: Scene, rows: PanelRows, layers: Sequence[Layer]) -> None:
    """Add all rows but the first to the scene of a season, with the first row's layers of snow.

    Raises
    ------
    InputError
        If rows overlap.
    """
    if rows.count == 1:
        return
    data = scene.resolve().data
    panel, slab, dx = data["panel"], data["slab"], float(data["numerics"]["dx"])
    span = (0.5 * (panel["length"] - slab["length"]), 0.5 * (panel["length"] + slab["length"]))
    for number, slope in enumerate(further_rows(data, rows.count, rows.pitch), 2):
        board = row_board(number, slope, panel["length"], panel["friction"], dx)
        scene.append("obstacles", replace(board, condition=panel["condition"]))
        for layer in layers:
            lying = slope.narrowed(slab["width"]).layer(*span, 0.0, float(layer.thickness or 0.0))
            scene.append("bodies", Body(shape=lying, event=layer.event, snow=layer.snow))
