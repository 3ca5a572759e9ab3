"""The columns of a season's table: units and allowed values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from snowshed._core import InputError

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
