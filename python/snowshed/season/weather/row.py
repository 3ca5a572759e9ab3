"""One row of a season's weather."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date, datetime
from typing import Optional

from snowshed._core import InputError
from snowshed.base.arguments import is_integer, is_number
from snowshed.base.field_type import shown
from snowshed.season.weather.columns import COLUMN_OF, COLUMNS
from snowshed.season.weather.source import SnowSource


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

    Raises
    ------
    InputError
        If a value is of a wrong type or outside its range.

    Examples
    --------
    >>> Weather(2, datetime(2024, 12, 1), 20.0, None, -4.0)
    Traceback (most recent call last):
    snowshed._core.InputError: snowfall on 2024-12-01: 20 is outside the allowed range \
(0 <= value <= 3 m); is it in cm, mm or inches?
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

    def __post_init__(self) -> None:
        if not is_integer(self.line):
            raise InputError(f"line: {shown(self.line)}; needed: a whole number")
        if not isinstance(self.date, datetime):
            kind = "a date without a time" if isinstance(self.date, date) else shown(self.date)
            raise InputError(f"date: {kind}; needed: a datetime")
        if self.date.tzinfo is not None:
            raise InputError("date: has a time zone; needed: a datetime without one")
        for field, column in COLUMN_OF.items():
            value = getattr(self, field)
            if value is None and not COLUMNS[column].filled:
                continue
            where = f"{field} on {self.date.date()}"
            if not is_number(value):
                raise InputError(f"{where}: {shown(value)}; needed: a number")
            COLUMNS[column].check(value, where)
