"""The terrain of a scene, its areas and dams, field by field as the core reads them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import List, Optional

from snowshed.base.paths import PathLike
from snowshed.base.record import Record, default
from snowshed.scene.shape import Outline


@dataclass
class Hole(Record):
    """A part of an area that does not belong to it.

    Attributes
    ----------
    outline : sequence of (x, y)
        Corners, in the terrain's coordinates [m]. Required.
    """

    outline: Optional[Outline] = None


@dataclass
class Area(Record):
    """An area on the map with snow on it.

    Attributes
    ----------
    name : str
        Name in messages and results.
    outline : sequence of (x, y)
        Corners, in the terrain's coordinates [m]. Required.
    holes : list of Hole
        Parts within the outline that do not belong to it.
    thickness : float
        Thickness of the snow, normal to the ground [m]. 0 < value <= 100; required.
    """

    name: Optional[str] = default("")
    outline: Optional[Outline] = None
    holes: Optional[List[Hole]] = None
    thickness: Optional[float] = None


@dataclass
class ResistanceArea(Record):
    """An area on the map that holds snow back.

    Attributes
    ----------
    name : str
        Name in messages and results.
    outline : sequence of (x, y)
        Corners, in the terrain's coordinates [m]. Required.
    holes : list of Hole
        Parts within the outline that do not belong to it.
    """

    name: Optional[str] = default("")
    outline: Optional[Outline] = None
    holes: Optional[List[Hole]] = None


@dataclass
class Pulse(Record):
    """Snow that enters an area at one time.

    Attributes
    ----------
    time : float
        Time at which the snow enters [s]. 0 <= value <= 1e+09; default 0.
    thickness : float
        Thickness of the snow over the whole area, normal to the ground [m]. 0 < value <= 100;
        required.
    speed : float
        Speed of the snow, down the slope [m/s]. 0 <= value <= 200; default 0.
    """

    time: Optional[float] = default(0.0)
    thickness: Optional[float] = None
    speed: Optional[float] = default(0.0)


@dataclass
class Inflow(Record):
    """An area on the map that snow enters at given times.

    Attributes
    ----------
    name : str
        Name in messages and results.
    outline : sequence of (x, y)
        Corners, in the terrain's coordinates [m]. Required.
    holes : list of Hole
        Parts within the outline that do not belong to it.
    bonds : bool
        Whether the snow of each time is a slab with bonds; in the mode "improved" only. Default
        False.
    hydrograph : list of Pulse
        Times at which snow enters the area, with its thickness and speed. Required.
    """

    name: Optional[str] = default("")
    outline: Optional[Outline] = None
    holes: Optional[List[Hole]] = None
    bonds: Optional[bool] = default(False)
    hydrograph: Optional[List[Pulse]] = None


@dataclass
class DamCorner(Record):
    """A corner of the line of a dam's crown.

    Attributes
    ----------
    x : float
        Map coordinate along x [m]. -1e+08 <= value <= 1e+08; required.
    y : float
        Map coordinate along y [m]. -1e+08 <= value <= 1e+08; required.
    height : float
        Height of the crown above the ground [m]. 0 < value <= 1000; required.
    """

    x: Optional[float] = None
    y: Optional[float] = None
    height: Optional[float] = None


@dataclass
class Dam(Record):
    """A dam that holds or deflects snow, as a line on the map.

    Attributes
    ----------
    name : str
        Name in messages and results.
    corners : list of DamCorner
        Corners of the line of its crown. Required.
    slope : float
        Slope of its face, on the left of the line; in the mode "compatible" only, in the other one
        dams are vertical [deg]. 0 < value <= 90; default 90.
    restitution : float
        Share of the speed toward the dam with which snow leaves it. 0 <= value <= 1; default 0.
    """

    name: Optional[str] = default("")
    corners: Optional[List[DamCorner]] = None
    slope: Optional[float] = default(90.0)
    restitution: Optional[float] = default(0.0)


@dataclass
class Terrain(Record):
    """Ground from a raster of elevations, and where snow lies on it.

    Attributes
    ----------
    file : str or path
        Elevations, m: an ESRI ASCII grid; relative to the scene file. Required.
    crs : str
        Coordinate system of the raster and the areas, passed on to the results.
    single_precision : bool
        Whether the mode "compatible" rounds elevations to single precision, as AvaFrame reads
        text. Default True.
    thickness_file : str
        Thickness of the released snow, m, in place of that of the areas: an ESRI ASCII grid;
        relative to the scene file.
    max_thickness : float
        Largest thickness of the snow that is released or entrained [m]. 0 < value <= 100; default
        10.
    max_slope : float
        Steepest ground between neighbouring nodes under a release, where they differ by more than
        10 m in height [deg]. 0 < value <= 90; default 70.
    notes : str
        Assumptions about the files, one a line, passed on to the results.
    release_speed : float
        Speed of the snow of `release` at the start, down the slope [m/s]. 0 <= value <= 200;
        default 0.
    release : list of Area
        Areas of release. Required.
    secondary_release : list of Area
        Areas that are released when snow of the slide enters them.
    inflows : list of Inflow
        Areas that snow enters at given times.
    entrainment : list of Area
        Areas where the slide entrains snow.
    resistance : list of ResistanceArea
        Areas where forest or buildings resist the slide.
    dams : list of Dam
        Dams that hold or deflect the slide.
    """

    file: Optional[PathLike] = None
    crs: Optional[str] = default("")
    single_precision: Optional[bool] = default(True)
    thickness_file: Optional[str] = default("")
    max_thickness: Optional[float] = default(10.0)
    max_slope: Optional[float] = default(70.0)
    notes: Optional[str] = default("")
    release_speed: Optional[float] = default(0.0)
    release: Optional[List[Area]] = None
    secondary_release: Optional[List[Area]] = None
    inflows: Optional[List[Inflow]] = None
    entrainment: Optional[List[Area]] = None
    resistance: Optional[List[ResistanceArea]] = None
    dams: Optional[List[Dam]] = None
