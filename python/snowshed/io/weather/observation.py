"""Observations from weather files in one form: a row for each time, in SI units and degrees C."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import date, datetime, timedelta, timezone
from functools import lru_cache
from typing import Any, Optional

from snowshed._core import InputError
from snowshed.base.formatting import missing_mark_hint, number_in
from snowshed.base.messages import quoted

ZERO_CELSIUS = 273.15  # K
DAY = 24.0  # hours
#: Parts of time formats: for each sign, the argument of `datetime` and the pattern of its digits.
PARTS = {
    "%Y": ("year", "{4}"),
    "%m": ("month", "{1,2}"),
    "%d": ("day", "{1,2}"),
    "%H": ("hour", "{1,2}"),
    "%M": ("minute", "{1,2}"),
}


@dataclass(frozen=True)
class Observation:
    """The weather at a time; None: not measured.

    Attributes
    ----------
    line
        Line in the file, from 1.
    time
        Time or day of the observation, on one clock throughout a station, without summer time.
    temperature
        Temperature of the air, degrees C.
    precipitation
        Depth of the water in the last `precipitation_hours`, mm.
    snowfall
        Depth of the new snow in the last `snowfall_hours`, m.
    snow_depth
        Depth of the snow on the ground, m.
    precipitation_hours, snowfall_hours
        Duration over which the amounts accumulated. Amounts of different rows do not overlap,
        except those of `Station.rolling`. Amounts of whole days end with the day of `time`, amounts
        of hours with `end`.
    seam
        Whether the row begins another series (another source year, sensor or file), so that the
        change of snow depth since the row before means nothing.
    end
        End of the hours of the amounts. [default: `time`]
    """

    line: int
    time: datetime
    temperature: Optional[float] = None
    precipitation: Optional[float] = None
    snowfall: Optional[float] = None
    snow_depth: Optional[float] = None
    precipitation_hours: Optional[float] = None
    snowfall_hours: Optional[float] = None
    seam: bool = False
    end: Optional[datetime] = None

    def shares(self, hours: Optional[float]) -> dict[date, float]:
        """Return the days on which an amount fell, and the part of it that belongs to each.

        Parameters
        ----------
        hours
            Duration over which the amount accumulated. [default: within the day of `time`]

        Examples
        --------
        >>> row = Observation(1, datetime(2024, 1, 3, 6))
        >>> {day.isoformat(): part for day, part in row.shares(24.0).items()}
        {'2024-01-03': 1.0}
        >>> {day.isoformat(): part for day, part in row.shares(12.0).items()}
        {'2024-01-02': 0.5, '2024-01-03': 0.5}
        >>> {day.isoformat(): part for day, part in row.shares(48.0).items()}
        {'2024-01-02': 0.5, '2024-01-03': 0.5}
        """
        if hours is None or hours == DAY:
            return {self.time.date(): 1.0}
        if hours % DAY == 0.0:
            days = int(hours / DAY)
            first = self.time.date() - timedelta(days - 1)
            return {first + timedelta(n): 1.0 / days for n in range(days)}
        end = self.end or self.time
        begin = end - timedelta(hours=hours)
        if begin.date() == end.date():
            return {end.date(): 1.0}
        parts: dict[date, float] = {}
        while begin < end:
            midnight = datetime(begin.year, begin.month, begin.day) + timedelta(1)
            parts[begin.date()] = (min(midnight, end) - begin) / timedelta(hours=hours)
            begin = midnight
        return parts


def replace_values(row: Observation, **values: Any) -> Observation:
    """Return a row with other values; many times as fast as `dataclasses.replace`.

    Examples
    --------
    >>> replace_values(Observation(1, datetime(2024, 1, 3)), snow_depth=0.5).snow_depth
    0.5
    """
    copy = object.__new__(Observation)
    copy.__dict__.update(row.__dict__)
    copy.__dict__.update(values)
    return copy


@dataclass(frozen=True)
class Station:
    """A weather file, or several of a station.

    Attributes
    ----------
    format
        Name of the format.
    name
        Name of the station, if the file states it.
    rows
        Observations in the order of time. A typical year is assembled as a year that begins in the
        station's summer: July 2001 to June 2002 in the north, January to December 2001 in the
        south.
    notes
        Assumptions made in reading.
    typical_year
        Whether its months come from different years.
    latitude, longitude
        Latitude and longitude, degrees north and east, if the file states them.
    altitude
        Altitude above the sea, m, if the file states it.
    utc_offset
        Hours of the rows' clock ahead of universal time, if the file states them.
    columns
        Column of the file that holds each quantity, by the fields of `Observation`.
    rolling
        Quantities whose rows all hold sums over the last hours, so that rows overlap. This never
        includes precipitation.
    """

    format: str
    name: str
    rows: Sequence[Observation]
    notes: Sequence[str] = field(default_factory=tuple)
    typical_year: bool = False
    latitude: Optional[float] = None
    longitude: Optional[float] = None
    altitude: Optional[float] = None
    utc_offset: Optional[float] = None
    columns: Mapping[str, str] = field(default_factory=dict)
    rolling: frozenset[str] = frozenset()

    @property
    def quantities(self) -> frozenset[str]:
        """Fields of `Observation` that at least one row has."""
        return frozenset(
            name for name in RANGES if any(getattr(row, name) is not None for row in self.rows)
        )


@dataclass(frozen=True)
class Quantity:
    """Quantity of a cell: its unit in the file, and the conversion to the unit of an observation.

    Attributes
    ----------
    name
        A field of `Observation`.
    unit
        Name of the column, for messages.
    factor, offset
        value = factor * cell + offset.
    hours
        Duration over which an amount accumulated; None: since the previous row, or no amount.
    """

    name: str
    unit: str
    factor: float = 1.0
    offset: float = 0.0
    hours: Optional[float] = None

    def read(self, text: str, where: str, missing: Sequence[str] = ("",)) -> Optional[float]:
        """Return a cell's value; None if it is missing.

        Parameters
        ----------
        text
            The cell.
        where
            File, line and column, for messages.
        missing
            Texts that stand for a missing value; numbers count by their value.

        Raises
        ------
        InputError
            If the text is not a number, or not a plausible value.

        Examples
        --------
        >>> Quantity("snow_depth", "cm", 0.01).read("35", "f.csv, line 2, column HS")
        0.35
        """
        low, high = RANGES[self.name]
        cell = text.strip()
        if cell in missing:
            return None
        number = number_in(cell)
        if math.isnan(number):
            raise InputError(
                f"{where}: {quoted(cell)} is not a number ({self._range_text(low, high)})"
            )
        if number in _numbers(tuple(missing)):
            return None
        value = self.factor * number + self.offset
        if not (math.isfinite(value) and low <= value <= high):
            hint = missing_mark_hint(number) or f"; is it really in {self.unit}?"
            raise InputError(
                f"{where}: {cell} is outside the allowed range ({self._range_text(low, high)})"
                f"{hint}"
            )
        return round(max(value, 0.0) if self.name == "snow_depth" else value, 9)

    def _range_text(self, low: float, high: float) -> str:
        ends = [(end - self.offset) / self.factor for end in (low, high)]
        return f"{ends[0]:g} <= value <= {ends[1]:g} {self.unit}"


@lru_cache(maxsize=64)
def _numbers(texts: tuple[str, ...]) -> frozenset[float]:
    return frozenset(number_in(text) for text in texts)


#: Values beyond these have never been measured: the unit must be wrong. Ultrasonic sensors show
#: bare ground some centimetres too low; such a depth counts as 0.
RANGES = {
    "temperature": (-90.0, 60.0),
    "precipitation": (0.0, 2000.0),
    "snowfall": (0.0, 3.0),
    "snow_depth": (-0.2, 15.0),
}


def time_of(text: str, where: str, *formats: str) -> datetime:
    """Return a date or time in one of the formats (`PARTS`), or in ISO 8601 without any.

    Without formats, a time with an offset from universal time keeps it (`tzinfo`).

    Raises
    ------
    InputError
        If the text is not a time.
    """
    cell = text.strip().strip('"')
    for form in formats:
        match = _pattern(form).fullmatch(cell)
        if match is None:
            continue
        try:
            parts = match.groupdict(default="0")
            return datetime(
                int(parts["year"]),
                int(parts["month"]),
                int(parts["day"]),
                int(parts.get("hour", 0)),
                int(parts.get("minute", 0)),
            )
        except ValueError:
            continue
    if not formats:
        try:
            return iso_time(cell)
        except ValueError:
            pass
    example = datetime(2024, 12, 31, 6).strftime(formats[0] if formats else "%Y-%m-%dT%H:%M")
    raise InputError(f"{where}: {quoted(cell)} is not a date such as {example}")


@lru_cache(maxsize=16)
def _pattern(form: str) -> re.Pattern[str]:
    """Return the pattern of a time format of `strptime`; parsing by it is ten times as fast.

    Parts that follow each other without a sign between them have all their digits.
    """
    joined = "%Y%m" in form
    text = re.escape(form).replace("\\ ", " ")
    for sign, (name, digits) in PARTS.items():
        count = "{2}" if joined and name != "year" else digits
        text = text.replace(sign, f"(?P<{name}>[0-9]{count})")
    return re.compile(text)


#: Times of ISO 8601, extended (2024-01-31T12:00) or basic (20240131T1200).
ISO_DATE = r"(\d{4})(-?)(\d\d)\2(\d\d)"
ISO_CLOCK = r"([01]\d|2[0-3])(?:(:?)([0-5]\d)(?:\6([0-5]\d)(?:[.,](\d{1,12}))?)?)?"
ISO_OFFSET = r"([Zz]|[+-]\d\d(?::?[0-5]\d)?)?"
ISO_TIME = re.compile(f"{ISO_DATE}(?:[Tt _]{ISO_CLOCK}{ISO_OFFSET})?", re.ASCII)


def iso_time(cell: str) -> datetime:
    """Return a time of ISO 8601: the same on every version of Python.

    Raises
    ------
    ValueError
        If the text is not such a time.

    Examples
    --------
    >>> iso_time("20240131T120000Z") == iso_time("2024-01-31 12:00+0000")
    True
    """
    match = ISO_TIME.fullmatch(cell)
    if match is None:
        raise ValueError(f"{cell!r} is not a time of ISO 8601")
    year, _, month, day, hour, _, minute, second, parts, zone = match.groups("")
    offset = None
    if zone in ("Z", "z"):
        offset = timezone.utc
    elif zone:
        shift = timedelta(hours=int(zone[1:3]), minutes=int(zone[3:].lstrip(":") or 0))
        offset = timezone(-shift if zone[0] == "-" else shift)
    return datetime(
        int(year), int(month), int(day),
        int(hour or 0), int(minute or 0), int(second or 0), int(parts[:6].ljust(6, "0")),
        tzinfo=offset,
    )  # fmt: skip


def coordinate(text: str, where: str, largest: float) -> Optional[float]:
    """Return a number of a station, such as its latitude; None if the text is empty.

    Raises
    ------
    InputError
        If the amount is larger than allowed, or not a number.

    Examples
    --------
    >>> coordinate("-45.0", "f.epw, line 1, column latitude", 90.0)
    -45.0
    """
    number = number_in(text) if text.strip() else math.nan
    if text.strip() in ("", "-", "NA") or abs(number) in (999.0, 9999.0):
        return None
    if not abs(number) <= largest:
        raise InputError(f"{where}: {quoted(text)}; allowed: {-largest:g} <= value <= {largest:g}")
    return number


def split_cells(line: str, where: str, separator: Optional[str] = ",") -> list[str]:
    """Return the cells of a line without blanks around them; None separates at blanks.

    Raises
    ------
    InputError
        If a quoted cell does not end.
    """
    if separator is None:
        return line.split()
    if '"' not in line and "\r" not in line:  # same result as csv.reader, in a fifth of the time
        return [cell.strip() for cell in line.split(separator)] if line else []
    try:
        cells = next(csv.reader([line], delimiter=separator), [])
    except csv.Error as error:
        raise InputError(f"{where}: not a table: {error}") from None
    return [cell.strip() for cell in cells]


def cells_of(
    line: str, head: Sequence[str], where: str, separator: Optional[str] = ","
) -> list[str]:
    """Return the cells of a line, one for each column.

    Parameters
    ----------
    line, separator
        As for `split_cells`.
    head
        The names of the columns.
    where
        File and line, for messages.

    Raises
    ------
    InputError
        Naming the first column without a cell, or the first cell without a column.
    """
    cells = split_cells(line, where, separator)
    if len(cells) != len(head):
        first = head[len(cells)] if len(cells) < len(head) else str(len(head) + 1)
        raise InputError(f"{where}, column {first}: {len(cells)} cells in {len(head)} columns")
    return cells
