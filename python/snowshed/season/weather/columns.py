"""The columns of a season's table: units and allowed values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Optional

from snowshed._core import InputError
from snowshed.base.formatting import missing_mark_hint
from snowshed.base.notes import InputNote, issue_note

#: Largest snowfall of a row, which may hold the snow of several days.
MAX_SNOWFALL = 3.0  # m


@dataclass(frozen=True)
class MeasuredColumn:
    """The unit and the range of a column."""

    low: float
    high: float
    unit: str
    required: bool = False  # whether the column must exist
    filled: bool = False  # whether every cell must be filled
    hint: str = ""  # likely meaning of a number beyond the range
    usual: Optional[tuple[float, float]] = None  # other numbers than 0 are noted

    @property
    def range_text(self) -> str:
        """The range, with its unit."""
        return f"{self.low:g} <= value <= {self.high:g} {self.unit}".rstrip()

    def check(self, value: float, where: str) -> None:
        """Raise InputError if a value is outside the range; note an unusual one.

        Examples
        --------
        >>> MeasuredColumn(0.0, 90.0, "degrees").check(95.0, "tilt")
        Traceback (most recent call last):
        snowshed._core.InputError: tilt: 95 is outside the allowed range (0 <= value <= 90 degrees)
        """
        if not self.low <= value <= self.high:
            hint = missing_mark_hint(value) or (self.hint if value > self.high else "")
            raise InputError(
                f"{where}: {value:g} is outside the allowed range ({self.range_text}){hint}"
            )
        for note in self.unusual(value, where):
            issue_note(note, InputNote)

    def unusual(self, value: float, where: str) -> list[str]:
        """Return a note if a value is unusual."""
        if not self.usual or not value or self.usual[0] <= value <= self.usual[1]:
            return []
        low, high = (f"{limit:g} {self.unit}".rstrip() for limit in self.usual)
        number = f"{value:g} {self.unit}".rstrip()
        return [f"{where}: {number} is unusual; most values are {low} to {high}, so check its unit"]


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
