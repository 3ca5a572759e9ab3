"""One row of a season's weather."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from typing import Optional

from snowshed.season.weather.source import SnowSource

#: Largest snowfall of a row, which may hold the snow of several days.
MAX_SNOWFALL = 3.0  # m


@dataclass(frozen=True)
class Weather:
    """One row of a season.

    Attributes
    ----------
    line
        Line in the file, or row in the table, from 1.
    date
        Date at which the snow had fallen.
    snowfall
        Depth of the new snow on level ground, m.
    density
        Density of the new snow, kg/m3; None: not measured.
    temperature
        Temperature of the air, degrees C, until the next row.
    friction, adhesion
        Friction and adhesion (Pa) of the panel on that day. [default: those of the settings]
    snow_depth
        Depth of the natural snow cover, m; None: not measured.
    irradiance
        Irradiance of the panel's plane at that time, W/m2; None: not measured.
    source
        Origin of the snowfall.
    reason
        Reason why the snowfall differs from the file's value of that day; empty if it does not.
    """

    line: int
    date: datetime
    snowfall: float
    density: Optional[float]
    temperature: float
    friction: Optional[float] = None
    adhesion: Optional[float] = None
    snow_depth: Optional[float] = None
    source: SnowSource = SnowSource.GIVEN
    reason: str = ""
    irradiance: Optional[float] = None
