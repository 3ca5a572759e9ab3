"""Warnings where a slide violates the method's assumptions.

AvaFrame's documentation states the range of com5SnowSlide: releases on slopes of 28 to 50 degrees
between 500 and 1500 m of altitude, drops of 30 to at most 60 or 80 m, a snow depth of 150 years,
and snow that moves as one slab without turbulence.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional

import numpy as np

from snowshed.base.arrays import Booleans, Floats
from snowshed.io.raster.areas import ring_area
from snowshed.io.raster.raster import Raster, read_raster

SLOPES = (28.0, 50.0)  # degrees
ALTITUDES = (500.0, 1500.0)  # m
DROPS = (30.0, 80.0)  # m
MAX_BROKEN_SHARE = 0.1  # share of the bonds that may break
MAX_OUTSIDE_SHARE = 0.1  # largest share of a release outside the range of slopes


@dataclass(frozen=True)
class ReleaseArea:
    """Size, altitude and slope of a release area.

    Attributes
    ----------
    name
        Name of the area.
    thickness
        Thickness of its snow, m; the mean thickness if a raster gives it.
    area, sloping_area
        Area on the map, and along the ground, m2.
    lowest, highest
        Altitudes, m.
    slope, steepest, flattest
        Mean, largest and least inclination, degrees.
    outside
        Share of the area whose inclination is outside `SLOPES`.
    """

    name: str
    thickness: float
    area: float
    sloping_area: float
    lowest: float
    highest: float
    slope: float
    steepest: float
    flattest: float
    outside: float

    @property
    def volume(self) -> float:
        """Thickness times the area along the ground, m3."""
        return self.thickness * self.sloping_area


def thickness_map(terrain: Mapping[str, Any], folder: Path) -> Optional[Raster]:
    """Return the raster of the release's thickness, m, if a terrain has one.

    Parameters
    ----------
    terrain
        Terrain of a complete scene.
    folder
        Folder from which its relative paths start.

    Raises
    ------
    InputError
        If the file is not a raster.
    OSError
        If it cannot be read.
    """
    file = terrain.get("thickness_file")
    return read_raster(folder / file) if file else None


def release_areas(
    ground: Raster, areas: Sequence[Mapping[str, Any]], thickness: Optional[Raster] = None
) -> list[ReleaseArea]:
    """Return size, altitude and slope of release areas on a terrain.

    Parameters
    ----------
    ground
        Elevations.
    areas
        The areas of a complete scene: name, outline (map coordinates, m) and thickness, m.
    thickness
        Raster of thicknesses that replaces those of the areas, m.
    """
    inclination = _inclination(ground)
    if thickness is not None:
        areas = [{**area, "thickness": _mean_thickness(thickness, area)} for area in areas]
    return [_release_area(ground, inclination, area) for area in areas]


def validity_notes(
    areas: Sequence[ReleaseArea], settings: Mapping[str, Any], figures: Mapping[str, Any]
) -> list[str]:
    """Return warnings where a slide is outside the stated validity, a sentence each.

    Parameters
    ----------
    areas
        The release areas.
    settings
        The settings of the method, as a scene holds them.
    figures
        The figures of ``slide.json``.

    Examples
    --------
    >>> validity_notes([], {"bonds": False}, {"drop_m": 50.0, "ended": "rest"})
    ['Without bonds this is a plain avalanche; the validity is stated for slabs with bonds.']
    """
    notes = [text for area in areas for text in _release_notes(area, settings)]
    drop = figures.get("drop_m", 0.0)
    if drop and not DROPS[0] <= drop <= DROPS[1]:
        notes.append(
            f"The drop is {drop:.0f} m; the method was made for {DROPS[0]:.0f} to {DROPS[1]:.0f} m."
        )
    bonds, broken = figures.get("bonds_made", 0), figures.get("bonds_broken", 0)
    if not settings.get("bonds", True):
        notes.append(
            "Without bonds this is a plain avalanche; the validity is stated for slabs with bonds."
        )
    elif bonds and broken > MAX_BROKEN_SHARE * bonds:
        notes.append(
            f"{100.0 * broken / bonds:.0f} % of the bonds broke: the method was made for snow that "
            "moves as a unit; this slide does not."
        )
    if figures.get("ended") == "time_limit":
        notes.append("The slide was still moving at the time limit; it may run farther.")
    return notes


def _release_notes(area: ReleaseArea, settings: Mapping[str, Any]) -> list[str]:
    notes = []
    if area.outside > MAX_OUTSIDE_SHARE:
        notes.append(
            f"Release {area.name!r}: the method was made for slopes of {SLOPES[0]:.0f} to "
            f"{SLOPES[1]:.0f} degrees; {100.0 * area.outside:.0f} % of the release area are "
            f"flatter or steeper ({area.flattest:.0f} to {area.steepest:.0f} degrees, mean "
            f"{area.slope:.0f})."
        )
    if area.lowest < ALTITUDES[0] or area.highest > ALTITUDES[1]:
        notes.append(
            f"Release {area.name!r}: its altitude is {area.lowest:.0f} to {area.highest:.0f} m; "
            f"the method was made for {ALTITUDES[0]:.0f} to {ALTITUDES[1]:.0f} m."
        )
    layer = settings.get("layer_thickness", 0.0)
    if area.thickness < layer:
        notes.append(
            f"Release {area.name!r}: {area.thickness:g} m of snow are less than the layer of a "
            f"particle ({layer:g} m), so that a cell holds less than one particle; choose a "
            "smaller layer_thickness."
        )
    return notes


def _mean_thickness(thickness: Raster, area: Mapping[str, Any]) -> float:
    return float(np.nan_to_num(thickness.heights[_within(thickness, area)]).mean())


def _release_area(ground: Raster, inclination: Floats, area: Mapping[str, Any]) -> ReleaseArea:
    outline = np.asarray(area["outline"], dtype=float)
    inside = _within(ground, area)
    slopes, heights = inclination[inside], ground.heights[inside]
    flat = ring_area(outline) - sum(ring_area(hole["outline"]) for hole in area.get("holes") or ())
    outside = (slopes < SLOPES[0]) | (slopes > SLOPES[1])
    return ReleaseArea(
        name=area.get("name") or "release",
        thickness=float(area["thickness"]),
        area=flat,
        sloping_area=flat * float(np.mean(1.0 / np.cos(np.radians(slopes)))),
        lowest=float(heights.min()),
        highest=float(heights.max()),
        slope=float(slopes.mean()),
        steepest=float(slopes.max()),
        flattest=float(slopes.min()),
        outside=float(outside.mean()),
    )


def _within(ground: Raster, area: Mapping[str, Any]) -> Booleans:
    """Return the nodes inside an area, or the nearest node if the area is smaller than a cell."""
    outline = np.asarray(area["outline"], dtype=float)
    inside = _inside(ground, outline)
    for hole in area.get("holes") or ():
        inside &= ~_inside(ground, np.asarray(hole["outline"], dtype=float))
    if not inside.any():
        middle = outline.mean(axis=0)
        column = round((middle[0] - ground.east) / ground.cell)
        row = round((middle[1] - ground.north) / ground.cell)
        rows, columns = ground.heights.shape
        inside[np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1)] = True
    return inside


def _inclination(ground: Raster) -> Floats:
    if min(ground.heights.shape) < 2:
        return np.zeros(ground.heights.shape)
    north, east = np.gradient(ground.heights, ground.cell)
    degrees: Floats = np.degrees(np.arctan(np.hypot(north, east)))
    return degrees


def _inside(ground: Raster, ring: Floats) -> Booleans:
    """Return the nodes inside a ring, by the even-odd rule."""
    rows, columns = ground.heights.shape
    x = (ground.east + ground.cell * np.arange(columns))[None, :]
    y = (ground.north + ground.cell * np.arange(rows))[:, None]
    inside: Booleans = np.zeros((rows, columns), dtype=bool)
    for (x0, y0), (x1, y1) in zip(ring, np.roll(ring, -1, axis=0)):
        if y0 != y1:
            crossing = x0 + (y - y0) * (x1 - x0) / (y1 - y0)
            inside ^= ((y0 > y) != (y1 > y)) & (x < crossing)
    return inside
