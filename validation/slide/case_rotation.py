"""Slide whose terrain and release are turned on the map."""

from __future__ import annotations

import math

import numpy as np

from snowshed.base.arrays import Floats
from snowshed.io.raster.raster import Raster
from snowshed.methods.slide.maps import SlideMaps
from snowshed.scene.terrain_components import Area
from snowshed.snow.accuracy.measurements import CaseSettings, Measured
from validation.framework.case import Case, Outcome, Quantity
from validation.framework.drive import TimedEventDriver
from validation.slide.site import Site, maps_of, node_axes, slide_drive

HALF = 70.0  # m, half the edge of the terrain
STEEP = math.tan(math.radians(35.0))
BEND = 0.0  # m, where the run-out begins
LEVEL = 30.0  # m, where the ground becomes level
CORNERS = ((-52.0, -9.0), (-36.0, -12.0), (-34.0, 3.0), (-38.0, 12.0), (-54.0, 8.0))
THICKNESS = 1.0  # m
REST_TIME = 12.0  # s, after which nearly all snow is at rest
CASE_SETTINGS = frozenset({"turned", "shape"})

DEFAULTS: CaseSettings = {
    "cell": 2.0,
    "time_step": 0.04,
    "layer_thickness": 0.04,
    "mixing_rate": 8.0,
    "friction_law": "voellmy",
    "stop_ratio": 0.01,
}


def ground(shape: str, x: Floats, y: Floats) -> Floats:
    """Return the height (m) of a slope with run-out: a plane, or a plane with a channel."""
    bend = np.clip(x, BEND, LEVEL) - BEND
    fall = STEEP * (np.minimum(x, BEND) + bend - bend**2 / (2 * (LEVEL - BEND)))
    channel = 0.0 if shape == "plane" else y**2 / 60.0
    return np.asarray(channel - fall)


def turn(x: Floats, y: Floats, degrees: float) -> tuple[Floats, Floats]:
    """Return the coordinates of points after a counterclockwise turn about the origin.

    Examples
    --------
    >>> [round(float(v), 6) + 0.0 for v in turn(np.array(1.0), np.array(0.0), 90.0)]
    [0.0, 1.0]
    """
    cosine, sine = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.asarray(cosine * x - sine * y), np.asarray(sine * x + cosine * y)


def peaks(settings: CaseSettings, degrees: float) -> tuple[TimedEventDriver, SlideMaps]:
    """Return a slide at its end, with turned terrain and release, and its maps."""
    shape = str(settings["shape"])
    corners = [turn(np.array(x), np.array(y), degrees) for x, y in CORNERS]
    site = Site(
        lambda x, y: ground(shape, *turn(x, y, -degrees)),
        -HALF,
        -HALF,
        HALF,
        HALF,
        [Area(outline=[(float(x), float(y)) for x, y in corners], thickness=THICKNESS)],
    )
    drive = slide_drive(site, settings, CASE_SETTINGS)
    drive.run_to(REST_TIME)
    return drive, maps_of(drive)


def measure(settings: CaseSettings) -> Outcome:
    """Compare the peak fields with those of the slide that was not turned."""
    degrees = float(settings["turned"])
    straight, turned = peaks(settings, 0.0)[1], peaks(settings, degrees)
    maps = turned[1]
    measured = []
    for name, before, after in (
        ("thickness", straight.peak_thickness, maps.peak_thickness),
        ("speed", straight.peak_speed, maps.peak_speed),
    ):
        change = np.abs(_read_back(maps, after, degrees) - before)
        resolved = np.abs(_read_back(maps, _turned(straight, before, degrees), degrees) - before)
        for ending, power in (("", 1), ("_l2", 2)):
            sums = [(values**power).sum() for values in (change, resolved)]
            share = float((sums[0] / sums[1]) ** (1 / power))
            measured.append(Measured(f"{name}{ending}", share, 0.0, share))
    return turned[0].outcome(measured)


def _read_back(maps: SlideMaps, values: Floats, degrees: float) -> Floats:
    """Return a map of the turned slide at the nodes of the unturned one."""
    return _turned(maps, values, -degrees)


def _turned(maps: SlideMaps, values: Floats, degrees: float) -> Floats:
    """Return a map after a counterclockwise turn, bilinear between nodes; 0 beyond its edge."""
    x, y = turn(*np.meshgrid(*node_axes(maps)), -degrees)
    inside = np.maximum(np.abs(x), np.abs(y)) < HALF
    heights = np.zeros_like(values)
    heights[inside] = Raster(values, maps.west, maps.south, maps.cell).height_at(
        x[inside], y[inside]
    )
    return heights


def matrix(full: bool) -> list[CaseSettings]:
    """Return both grounds with angles; if full, also finer cells and particles."""
    angles = (10.0, 30.0, 45.0, 77.0) if full else (30.0,)
    settings_list: list[CaseSettings] = [
        {**DEFAULTS, "shape": shape, "turned": angle}
        for shape in ("plane", "channel")
        for angle in angles
    ]
    if full:
        settings_list += [
            {**settings, "cell": 4.0, "layer_thickness": 0.08} for settings in settings_list
        ]
    return settings_list


CASE = Case(
    name="slide_rotation",
    title="A slide with terrain and release turned on the map",
    source="the results cannot depend on where north is",
    description="""
    A slab 1 m thick breaks loose on a slope of 35 degrees that runs out onto level ground, a plane
    or a channel, with Voellmy's friction and mixing. Terrain and release are turned
    by an angle. The peak fields are turned back and compared with those of the unturned slide over
    the whole map. The norms L1 and L2 of the difference are relative to those of the interpolation
    error, that is the change of a map by bilinear turns there and back.
    """,
    quantities=tuple(
        Quantity(
            f"{name}{ending}",
            f"change of peak {name} over the error of interpolation, {norm} norm",
            limit=1.0,
            relative=False,
        )
        for name in ("thickness", "speed")
        for ending, norm in (("", "L1"), ("_l2", "L2"))
    ),
    matrix=matrix,
    measure=measure,
    remarks="""
    The speed at a node is a mean over the nodes around it, with weights that do not depend on
    directions on the map. When only the nearest particles counted, the peak speed changed by up to
    1.3 (L1) and 1.7 (L2) times the interpolation error. The changes were at the rim, where one
    particle or none comes near a node.
    """,
)
