"""The clearance between a panel's lower edge and the stack, and the event that closes it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.scene.panel_edge import ground_tilt, panel_edge
from snowshed.snow.stack.measure import levelled_positions

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class Clearance:
    """The clearance between a panel's lower edge and the stack, m, normal to the ground.

    Attributes
    ----------
    below
        Distance between the edge and the snow directly below it. Without snow it is the height of
        the edge; it is 0 once the snow covers the edge.
    crest
        Height of the edge minus the height of the highest snow, wherever this snow lies.
    """

    below: float
    crest: float


def clearance(
    scene: Mapping[str, Any],
    outline: Floats,
    height: float,
    cover: float = 0.0,
    rows: Sequence[float] = (0.0,),
) -> Clearance:
    """Measure the clearance over a stack.

    Parameters
    ----------
    scene
        The complete scene, with a panel.
    outline : (k, 2)
        Profile of the stack on levelled ground, m, as in outline.csv.
    height
        Height of the stack, m.
    cover
        Depth of the natural snow cover below the stack, m, vertically.
    rows
        Distances of equal panels from the scene's, along the ground, m. The clearance is that of
        the panel with least snow below it to spare.

    Examples
    --------
    >>> from snowshed.scene.scene import Scene
    >>> data = Scene.preset("lab-50").resolve().data
    >>> heap = np.array([[0.0, 0.0], [0.2, 0.2], [0.4, 0.0]])
    >>> left = clearance(data, heap, 0.2)
    >>> round(left.below, 3), round(left.crest, 3)
    (0.251, 0.13)
    """
    _, (x, z) = panel_ends(scene)
    deepest = max(_surface(outline, x + away) for away in rows)
    above_cover = z - cover * math.cos(math.radians(ground_tilt(scene)))
    return Clearance(max(above_cover - deepest, 0.0), above_cover - height)


def below_panel(
    scene: Mapping[str, Any], outline: Floats, rows: Sequence[float] = (0.0,)
) -> Floats:
    """Return the points of an outline (k, 2) that do not lie over the face of a panel.

    `rows` are the distances of equal panels, as for `clearance`.

    Snow that rests against the panel's lower end may reach up the face. Such snow counts neither as
    snow on the panel nor as part of the stack below the edge.
    """
    if len(outline) == 0:
        return outline
    (upper_x, upper_z), (x, z) = panel_ends(scene)
    over = np.zeros(len(outline), dtype=bool)
    for away in rows:
        along = outline[:, 0] - away
        above = outline[:, 1] > np.interp(along, [upper_x, x], [upper_z, z])
        over |= above & (along < x) & ((along > upper_x) | (away == rows[0]))
    below: Floats = outline[~over]
    return below


def panel_ends(scene: Mapping[str, Any]) -> list[list[float]]:
    """Return the panel's upper and lower edge, [x, z], on levelled ground."""
    edge = panel_edge(scene)
    ends = np.array([[edge.upper[0], 0.0, edge.upper[1]], [edge.x, 0.0, edge.z]])
    levelled: list[list[float]] = levelled_positions(ends, ground_tilt(scene))[:, [0, 2]].tolist()
    return levelled


def _surface(outline: Floats, x: float) -> float:
    """Return the height of the snow at x, m; zero beyond the ends of the stack."""
    if len(outline) == 0:
        return 0.0
    positions, heights = outline[:, 0], outline[:, 1]
    return float(np.interp(x, positions, heights, left=0.0, right=0.0))


#: Causes of a first contact, by the columns of the table that show it.
CAUSES = (
    ("slab", "the snow on the panel and the stack touch"),
    ("below", "the snow below the lower edge reaches it"),
    ("crest", "the crest of the stack is as high as the lower edge"),
    ("cover", "the natural snow cover reaches the lower edge"),
)


@dataclass(frozen=True)
class PanelContact:
    """The first contact of the snow below with the panel.

    Attributes
    ----------
    date
        As in the season's table.
    event
        The last slide-off until then; None without one.
    cause
        A name in `CAUSES`.
    """

    date: str
    event: Optional[int]
    cause: str

    @property
    def text(self) -> str:
        """The contact as a clause, such as "the stack reaches the lower edge"."""
        return dict(CAUSES)[self.cause]


def first_contact(table: pd.DataFrame, gap: float) -> Optional[PanelContact]:
    """Return the first contact with the panel in a season, if any.

    Parameters
    ----------
    table
        As in season.csv.
    gap
        Largest gap that counts as a contact, m, such as a cell of the grid.
    """
    import pandas as pd

    sunk = table["stack_height_m"] - table["settled_height_m"]
    reached = {
        "slab": table["joined"] > 0,
        "below": table["settled_clearance_m"] <= gap,
        "crest": table["crest_clearance_m"] + sunk <= gap,
    }
    touched = pd.DataFrame(reached).to_numpy()
    rows = np.flatnonzero(touched.any(axis=1))
    if len(rows) == 0:
        return None
    row = int(rows[0])
    cause = list(reached)[int(np.argmax(touched[row]))]
    if not table["stack_height_m"].iloc[row] > 0.0:
        cause = "cover"
    events = table["event"].iloc[: row + 1].dropna()
    event = int(events.iloc[-1]) if len(events) else None
    return PanelContact(str(table["date"].iloc[row]), event, cause)


def first_reached(clearances: Sequence[float], dx: float) -> Optional[int]:
    """Return the first event after which no clearance is left, counted from 1, if any.

    A clearance of `dx`, m, counts as none: the grid does not resolve a gap below one cell, and the
    particles' centres are half a spacing below the surface.

    Examples
    --------
    >>> first_reached([0.3, 0.1, 0.02, -0.1], 0.02), first_reached([0.3], 0.02)
    (3, None)
    """
    return next((event for event, left in enumerate(clearances, 1) if left <= dx), None)
