"""The columns of a season's table, and the same values in rows of `Weather` made by hand."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import date, datetime

from snowshed._core import InputError
from snowshed.base.arguments import is_number
from snowshed.base.field_type import shown
from snowshed.io.csv_table import TableRow
from snowshed.season.weather.checks import check_rows
from snowshed.season.weather.row import MAX_SNOWFALL, Weather


@dataclass(frozen=True)
class MeasuredColumn:
    """The unit and the range of a column."""

    low: float
    high: float
    unit: str
    required: bool = False  # whether the column must exist
    filled: bool = False  # whether every cell must be filled
    hint: str = ""  # likely meaning of a number beyond the range

    @property
    def range_text(self) -> str:
        """The range, with its unit."""
        return f"{self.low:g} <= value <= {self.high:g} {self.unit}".rstrip()

    def check(self, value: float, where: str) -> None:
        """Raise InputError if a value is outside the range."""
        if not self.low <= value <= self.high:
            hint = self.hint if value > self.high else ""
            raise InputError(
                f"{where}: {value:g} is outside the allowed range ({self.range_text}){hint}"
            )


COLUMNS: Mapping[str, MeasuredColumn] = {
    "snowfall_m": MeasuredColumn(
        0.0, MAX_SNOWFALL, "m", required=True, filled=True, hint="; is it in cm, mm or inches?"
    ),
    "temperature_c": MeasuredColumn(-90.0, 40.0, "degrees C", required=True, filled=True),
    "density_kg_m3": MeasuredColumn(10.0, 700.0, "kg/m3"),
    "friction": MeasuredColumn(0.0, 10.0, ""),
    "adhesion_pa": MeasuredColumn(0.0, 1e6, "Pa"),
    "snow_depth_m": MeasuredColumn(0.0, 15.0, "m", hint="; is it in cm, mm or inches?"),
    "irradiance_w_m2": MeasuredColumn(
        -20.0, 2000.0, "W/m2"
    ),  # night offsets of sensors are negative
}
ALLOWED = ("date", *COLUMNS)
#: The column of each number of a `Weather`.
COLUMN_OF: Mapping[str, str] = {
    "snowfall": "snowfall_m",
    "temperature": "temperature_c",
    "density": "density_kg_m3",
    "friction": "friction",
    "adhesion": "adhesion_pa",
    "snow_depth": "snow_depth_m",
    "irradiance": "irradiance_w_m2",
}


def check_given_rows(
    rows: Sequence[object], name: str = "the season", *, ordered: bool = True
) -> list[Weather]:
    """Return rows made by hand; raises InputError if they cannot be the weather of seasons.

    Parameters
    ----------
    rows
        The rows; they may have no snow.
    name
        The argument, for messages.
    ordered
        Whether the rows are a season, in order.

    Examples
    --------
    >>> check_given_rows([Weather(2, datetime(2024, 12, 1), 20.0, None, -4.0)])
    Traceback (most recent call last):
    snowshed._core.InputError: the season, row 1, snowfall: 20 is outside the allowed range \
(0 <= value <= 3 m); is it in cm, mm or inches?
    """
    weather: list[Weather] = []
    for number, row in enumerate(rows, 1):
        where = f"{name}, row {number}"
        if not isinstance(row, Weather):
            raise InputError(f"{where}: {shown(row)}; needed: Weather")
        if not isinstance(row.date, datetime):
            kind = "a date without a time" if isinstance(row.date, date) else shown(row.date)
            raise InputError(f"{where}, date: {kind}; needed: a datetime")
        if row.date.tzinfo is not None:
            raise InputError(f"{where}, date: has a time zone; needed: a datetime without one")
        for field, column in COLUMN_OF.items():
            value = getattr(row, field)
            if value is None and not COLUMNS[column].filled:
                continue
            if not is_number(value):
                raise InputError(f"{where}, {field}: {shown(value)}; needed: a number")
            COLUMNS[column].check(value, f"{where}, {field}")
        weather.append(row)
    if not ordered:
        return weather
    positions = [TableRow(name, f"row {number}", number, {}) for number in range(1, len(rows) + 1)]
    check_rows(weather, positions, name, snowless=True)
    return weather
