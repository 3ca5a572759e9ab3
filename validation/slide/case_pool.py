"""Snow with a level surface: a pool in a trough, and a stream in an inclined gully."""

from __future__ import annotations

import math
from typing import cast

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.scene.terrain_components import Area
from snowshed.snow.accuracy.measurements import CaseSettings
from validation.framework.case import Case, Outcome, Quantity
from validation.framework.drive import relative
from validation.slide.site import Height, Site, rectangle, slide_drive

DEPTH, CURVATURE = 4.0, 0.08  # m in the middle; 1/m, of the cross-section z = CURVATURE y^2
HALF_LENGTH = 24.0  # m on the map
MIDDLE = 8.0  # m, half the length that is compared, which waves from the ends do not reach
DURATION = 1.0  # s
STRIPS = 14
FALLS = {"trough": 0.0, "gully": math.tan(math.radians(30.0))}
CASE_SETTINGS = frozenset({"ground"})

DEFAULTS: CaseSettings = {
    "cell": 1.0,
    "time_step": 0.01,
    "layer_thickness": 0.1,
    "friction": 0.0,
    "mixing_rate": 1.0,
}


def measure(settings: CaseSettings) -> Outcome:
    """Measure the width of the snow after a while, relative to the initial one."""
    fall = FALLS[str(settings["ground"])]
    site = Site(_ground(fall), -40.0, -16.0, 48.0, 16.0, strips(fall))
    drive = slide_drive(site, settings, CASE_SETTINGS)
    x, y = drive.core.positions()[:, :2].T
    middle = np.abs(x - x.mean()) < MIDDLE
    masses = drive.core.masses()[middle]
    width = _width(y[middle], masses)
    drive.run_to(DURATION)
    later = _width(drive.core.positions()[middle, 1], masses)
    return drive.outcome([relative("width", later / width, 1.0)])


def _width(y: Floats, masses: Floats) -> float:
    return math.sqrt(np.average((y - np.average(y, weights=masses)) ** 2, weights=masses))


def _ground(fall: float) -> Height:
    return lambda x, y: np.asarray(CURVATURE * y**2 - fall * x)


def strips(fall: float) -> list[Area]:
    """Return strips of snow along the fall line, up to a surface that is level across it.

    Examples
    --------
    The thickness is normal to the ground, and the snow as deep as the cross-section is high.

    >>> round(max(strip.thickness for strip in strips(0.0)), 1)
    4.0
    """
    half_width = math.sqrt(DEPTH / CURVATURE)
    edges: Floats = np.linspace(-half_width, half_width, STRIPS + 1)
    areas = []
    for south, north in zip(edges[:-1], edges[1:]):
        y = np.linspace(south, north, 21)
        depth = DEPTH - CURVATURE * y**2
        thickness = float((depth / np.sqrt(1 + fall**2 + (2 * CURVATURE * y) ** 2)).mean())
        areas.append(rectangle(-HALF_LENGTH, float(south), HALF_LENGTH, float(north), thickness))
    return areas


def matrix(full: bool) -> list[CaseSettings]:
    """Return both grounds with both kinds of columns; if full, also finer cells and particles."""
    settings_list = [
        cast(CaseSettings, {**DEFAULTS, "ground": ground, "columns": columns})
        for ground in FALLS
        for columns in ("vertical", "across_flow")
    ]
    if not full:
        return settings_list
    fine = [{**settings, "layer_thickness": 0.05} for settings in settings_list]
    return settings_list + fine + [{**settings, "cell": 2.0} for settings in settings_list]


def _quantity(ground: str, columns: str) -> Quantity:
    return Quantity(
        "width",
        f"width over the initial one ({ground})",
        limit=0.05,
        limit_for={"ground": ground, "columns": columns},
    )


CASE = Case(
    name="slide_pool",
    title="Snow with a level surface in a trough and in a gully",
    source="a level surface of snow without friction stays level across the gully",
    description="""
    Snow without friction fills a trough, or a gully that falls by 30 degrees, with a parabolic
    cross-section up to 4 m above its bottom. The surface is level across the fall line, and the
    sides are up to 49 degrees steep. In the trough the snow must stay where it is. In the gully it
    slides down, but must not spread across the gully. The width, from the second moment of the
    middle 16 m, is compared with the initial one after 1 s.
    """,
    quantities=(_quantity("trough", "vertical"), _quantity("gully", "across_flow")),
    matrix=matrix,
    measure=measure,
    remarks="""
    The limits apply to vertical columns in the trough and to columns across the flow in the gully.
    In the accelerating gully vertical columns press too much, by 1/cos² of its fall. Snow at rest
    has columns normal to the ground with `across_flow`, which press too little on steep sides.
    """,
)
