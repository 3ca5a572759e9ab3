"""Days of a station, element by element, in the daily data of the United States."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from typing import Any, NamedTuple, Optional

from snowshed._core import InputError
from snowshed.base.formatting import number_in
from snowshed.base.messages import quoted
from snowshed.io.weather.amounts import Total, without_overlap
from snowshed.io.weather.observation import DAY, Observation, Quantity

MISSING = ("", "-9999")
PRESUMED = "P"  # flag of a missing value that is presumed to be 0
MAX_DAYS = 366  # days of a total


class _Several(NamedTuple):
    """Elements of an amount (of a day, of several days, number of these days), and its unit."""

    day: str
    days: str
    number: str
    unit: str


SNOW = _Several("SNOW", "MDSF", "DASF", "m of new snow")
WATER = _Several("PRCP", "MDPR", "DAPR", "mm of precipitation")
COUNTS = (SNOW.number, WATER.number)
#: Elements of an amount of several days and of their number, by the element of a day.
TOTALS = {names.day: (names.days, names.number) for names in (SNOW, WATER)}
#: Elements of each quantity, by their names in the files.
COLUMNS: Mapping[str, str] = {
    "temperature": "TAVG, or TMAX and TMIN",
    "precipitation": "PRCP",
    "snowfall": "SNOW",
    "snow_depth": "SNWD",
}


def with_totals(elements: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Return elements, and those of amounts over several days in the units of the daily amounts."""
    more = {names.days: elements[names.day] for names in (SNOW, WATER)}
    return {**elements, **more}


@dataclass
class Days:
    """Measurements of the days of a station, whose elements come in any order.

    Attributes
    ----------
    values
        Line and values by element, for each day.
    left_out
        Number of left-out values, by reason.
    """

    values: dict[datetime, dict[str, Any]] = field(default_factory=dict)
    left_out: Counter[str] = field(default_factory=Counter)

    def enter(self, day: datetime, line: int, element: str, value: Any, where: str) -> None:
        """Enter a value, None if it is missing; raises InputError for a second value of a day."""
        values = self.values.setdefault(day, {"line": line})
        if values.get(element, value) != value:
            raise InputError(
                f"{where}: {element} of {day.date()} occurs twice with different values; the "
                f"first is in line {values['line']} or below"
            )
        values[element] = value

    def passes(self, measurement: str, quality: str) -> bool:
        """Return whether a value with these flags is valid; invalid values are counted."""
        if quality.strip():
            self.left_out["failed a check of quality"] += 1
        elif measurement.strip() == PRESUMED:
            self.left_out["are missing and only presumed to be 0"] += 1
        else:
            return True
        return False

    def count(self, text: str, day: datetime, line: int, element: str, where: str) -> None:
        """Enter the number of days of an amount over several days."""
        cell = text.strip()
        if cell in MISSING:
            return
        number = number_in(cell)
        if not (1 <= number <= MAX_DAYS and number == int(number)):
            raise InputError(f"{where}: {quoted(cell)}; allowed: 1 to {MAX_DAYS} days")
        self.enter(day, line, element, int(number), where)

    def rows(self) -> tuple[list[Observation], list[str]]:
        """Return the days with any measurement, in order, and notes."""
        notes = [f"{count} values {why}, and are left out" for why, count in self.left_out.items()]
        snow, of_snow = self._amounts(SNOW)
        water, of_water = self._amounts(WATER)
        rows = []
        for day, values in sorted(self.values.items()):
            mean = values.get("TAVG")
            if mean is None and None not in (values.get("TMAX"), values.get("TMIN")):
                mean = 0.5 * (values["TMAX"] + values["TMIN"])
            new, new_hours = snow.get(day, (None, None))
            wet, wet_hours = water.get(day, (None, None))
            deep = values.get("SNWD")
            if any(value is not None for key, value in values.items() if key not in NO_VALUES):
                row = Observation(values["line"], day, mean, wet, new, deep, wet_hours, new_hours)
                rows.append(row)
        return rows, [*notes, *of_snow, *of_water]

    def _amounts(self, names: _Several) -> tuple[dict[datetime, tuple[float, float]], list[str]]:
        """Return the amount and its hours on each day with a measured amount, and notes."""
        totals: list[Total] = []
        days: list[datetime] = []
        several, counted = 0, 0
        last: Optional[datetime] = None
        for day, values in sorted(self.values.items()):
            own, total = values.get(names.day), values.get(names.days)
            end = _after(day)
            if own is not None:
                totals.append(Total(end, DAY, own))
                days.append(day)
            if total is not None:
                count = values.get(names.number)
                counted += count is None
                count = count or (min((day - last).days, MAX_DAYS) if last else 1)
                totals.append(Total(end, DAY * max(count, 1), total))
                days.append(day)
                several += 1
            if own is not None or total is not None:
                last = day
        amounts, notes = without_overlap(totals, DAY, names.unit)
        by_day: dict[datetime, tuple[float, float]] = {}
        for day, total, amount in zip(days, totals, amounts):
            before, hours = by_day.get(day, (0.0, 0.0))
            by_day[day] = (before + amount, max(hours, total.hours))
        if several:
            gathered = math.fsum(values.get(names.days) or 0.0 for values in self.values.values())
            notes.insert(
                0,
                f"{several} amounts of several days ({names.days}), {gathered:.4g} {names.unit} in "
                "all, are spread over their days"
                + (
                    f"; {counted} without a number of days count since the last amount"
                    if counted
                    else ""
                ),
            )
        return by_day, notes


NO_VALUES = ("line", *COUNTS)


def _after(day: datetime) -> datetime:
    try:
        return day + timedelta(days=1)
    except OverflowError:
        return day
