"""Areas of later snow, forest and dams on the slope of a slide, for maps and pages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from snowshed.base.arguments import checked
from snowshed.plot.figure_style import INK
from snowshed.plot.terrain_map import Outline

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: Lists of a scene's terrain: label and colour.
LOOKS: Mapping[str, tuple[str, str]] = {
    "secondary_release": ("secondary release", "#7b3294"),
    "inflows": ("inflow", "#b8651b"),
    "resistance": ("forest or resistance", "#1b7837"),
    "dams": ("dam", INK),
}
NEVER_STARTED = "secondary release, never started"


@dataclass(frozen=True)
class SlopeObject:
    """An area or a dam on the map.

    Attributes
    ----------
    label
        Its kind in the legend.
    colour
        Colour of its line.
    dashed
        True for a secondary release that never started.
    corners
        Corners of its closed outline, or of the dam's line, in map coordinates, m.
    is_dam
        True for a dam, whose line is open.
    """

    label: str
    colour: str
    dashed: bool
    corners: Outline
    is_dam: bool


def slope_objects(
    terrain: Mapping[str, Any], late_releases: Sequence[Mapping[str, Any]] = ()
) -> list[SlopeObject]:
    """Return the areas of later snow, the forest and the dams of a scene.

    Parameters
    ----------
    terrain
        The terrain of a complete scene's data.
    late_releases
        As in ``slide_facts`` of the core's simulation; those by contact say which areas never
        started. They have the order of the scene.

    Examples
    --------
    >>> dam = {"corners": [{"x": 0.0, "y": 0.0}, {"x": 9.0, "y": 0.0}]}
    >>> [each.label for each in slope_objects({"dams": [dam]})]
    ['dam']
    """
    started = [each["time_s"] is not None for each in late_releases if each["by_contact"]]
    objects = []
    for kind, (label, colour) in LOOKS.items():
        for number, each in enumerate(terrain.get(kind) or ()):
            waits = kind == "secondary_release" and started[number : number + 1] == [False]
            is_dam = kind == "dams"
            corners = [(c["x"], c["y"]) for c in each["corners"]] if is_dam else each["outline"]
            objects.append(
                SlopeObject(NEVER_STARTED if waits else label, colour, waits, corners, is_dam)
            )
    return objects


@checked
def draw_objects(axes: Axes, objects: Sequence[SlopeObject]) -> None:
    """Draw areas and dams, each kind once in the legend."""
    named: set[str] = set()
    for each in objects:
        line = np.array(each.corners if each.is_dam else [*each.corners, each.corners[0]])
        width = 3.2 if each.is_dam else 1.6
        label = None if each.label in named else each.label
        named.add(each.label)
        axes.plot(line[:, 0], line[:, 1], color="white", lw=width + 1.4, zorder=6, alpha=0.7)
        axes.plot(
            line[:, 0], line[:, 1], "--" if each.dashed else "-", color=each.colour, lw=width,
            zorder=7, label=label, solid_capstyle="butt",
        )  # fmt: skip


def event_rows(facts: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """Return a row for each later release, the forest and each dam: kind, name, and its part.

    Examples
    --------
    >>> event_rows({"dams": [{"name": "lower", "passed_kg": 0.0}]})
    [('dam', 'lower', 'no snow passed over it')]
    """
    rows = []
    for each in facts.get("late_releases", ()):
        kind = "secondary release" if each["by_contact"] else f"inflow at {each['planned_s']:g} s"
        missed = "never started" if each["by_contact"] else "the slide ended earlier"
        mass = f"{1e-3 * each['mass_kg']:,.3f} t"
        part = missed if each["time_s"] is None else f"{mass} after {each['time_s']:.2f} s"
        rows.append((kind, each["name"], part))
    if facts.get("detrained_kg", 0.0) > 0.0:
        rows.append(("forest", "", f"took {1e-3 * facts['detrained_kg']:,.3f} t"))
    for dam in facts.get("dams", ()):
        passed = f"{1e-3 * dam['passed_kg']:,.3f} t passed over it"
        rows.append(("dam", dam["name"], passed if dam["passed_kg"] else "no snow passed over it"))
    return rows
