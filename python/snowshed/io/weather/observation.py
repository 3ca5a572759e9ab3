"""What weather files tell, in one form: a row for each time, in SI units and degrees C."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from datetime import datetime
from typing import Optional

from snowshed._core import InputError
from snowshed.io.messages import quoted
from snowshed.io.number_text import number_in

ZERO_CELSIUS = 273.15  # K


@dataclass(frozen=True)
class Observation:
    """The weather at a time; None: not measured.

    Attributes
    ----------
    line
        In the file, from 1.
    time
        When it was, or the day.
    temperature
        Of the air, degrees C.
    precipitation
        mm of water since the row before, or of the day.
    snowfall
        Depth of new snow, m, of the day.
    snow_depth
        m.
    """

    line: int
    time: datetime
    temperature: Optional[float] = None
    precipitation: Optional[float] = None
    snowfall: Optional[float] = None
    snow_depth: Optional[float] = None


@dataclass(frozen=True)
class Station:
    """A weather file.

    Attributes
    ----------
    format
        Its name.
    name
        Of the station, as far as the file tells.
    rows
        In the order of the file.
    notes
        What was assumed in reading it.
    typical_year
        Whether its months come from different years.
    """

    format: str
    name: str
    rows: Sequence[Observation]
    notes: Sequence[str] = field(default_factory=tuple)
    typical_year: bool = False


@dataclass(frozen=True)
class Quantity:
    """What a cell holds: its unit in the file, and how it becomes the unit of an observation.

    Attributes
    ----------
    name
        A field of `Observation`.
    unit
        In the file, for messages.
    factor, offset
        value = factor * cell + offset.
    low, high
        Of the value.
    """

    name: str
    unit: str
    factor: float = 1.0
    offset: float = 0.0

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
            If it is no number, or none of such a quantity.

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
                f"{where}: {quoted(cell)} is not a number ({self._allowed(low, high)})"
            )
        if any(number_in(one) == number for one in missing):
            return None
        value = self.factor * number + self.offset
        if not (math.isfinite(value) and low <= value <= high):
            raise InputError(
                f"{where}: {cell} is outside the allowed range ({self._allowed(low, high)}); "
                f"is it really in {self.unit}?"
            )
        return round(value, 9)

    def _allowed(self, low: float, high: float) -> str:
        ends = [(end - self.offset) / self.factor for end in (low, high)]
        return f"{ends[0]:g} <= value <= {ends[1]:g} {self.unit}"


#: Beyond these nothing was ever measured, and a unit is mistaken.
RANGES = {
    "temperature": (-90.0, 60.0),
    "precipitation": (0.0, 2000.0),
    "snowfall": (0.0, 3.0),
    "snow_depth": (0.0, 15.0),
}


def time_of(text: str, where: str, *formats: str) -> datetime:
    """Return a date or time in one of the formats of `datetime.strptime`, or ISO 8601 without any.

    Raises
    ------
    InputError
        If it is none.
    """
    cell = text.strip().strip('"')
    for one in formats:
        try:
            return datetime.strptime(cell, one)
        except ValueError:
            continue
    if not formats:
        try:
            return datetime.fromisoformat(cell.replace("Z", "+00:00")).replace(tzinfo=None)
        except ValueError:
            pass
    example = datetime(2024, 12, 31, 6).strftime(formats[0] if formats else "%Y-%m-%dT%H:%M")
    raise InputError(f"{where}: {quoted(cell)} is not a date such as {example}")


def cells_of(line: str, count: int, where: str, separator: Optional[str] = ",") -> list[str]:
    """Return the cells of a line, which must be so many.

    Raises
    ------
    InputError
        If there are more or fewer.
    """
    import csv

    try:
        cells = (
            line.split() if separator is None else next(csv.reader([line], delimiter=separator), [])
        )
    except csv.Error as error:  # a cell without end
        raise InputError(f"{where}: not a table: {error}") from None
    if len(cells) != count:
        raise InputError(f"{where}: {len(cells)} cells in {count} columns")
    return [cell.strip() for cell in cells]
