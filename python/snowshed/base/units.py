"""Units of the columns of tables, which their names end with: ``height_m``, ``density_kg_m3``."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pandas as pd

UNITS = MappingProxyType(
    {
        "m": "m",
        "m2": "m2",
        "m3": "m3",
        "m_s": "m/s",
        "pa": "Pa",
        "kpa": "kPa",
        "n": "N",
        "kn": "kN",
        "nm": "N m",
        "ns": "N s",
        "kg": "kg",
        "kg_m2": "kg/m2",
        "kg_m3": "kg/m3",
        "w_m2": "W/m2",
        "s": "s",
        "j": "J",
        "mb": "MB",
        "c": "degC",
        "deg": "degree",
    }
)


def unit_of_column(name: str) -> str:
    """Return the unit at the end of a column's name; empty if the name has none.

    Examples
    --------
    >>> unit_of_column("density_kg_m3"), unit_of_column("wall_s"), unit_of_column("event")
    ('kg/m3', 's', '')
    >>> unit_of_column("damping_rate_per_s"), unit_of_column("snow_kg_per_m")
    ('1/s', 'kg/m')
    """
    endings = [ending for ending in UNITS if name.endswith(f"_{ending}")]
    if not endings:
        return ""
    ending = max(endings, key=len)
    counted, per, _ = name.rpartition(f"_per_{ending}")
    return f"{unit_of_column(counted) or 1}/{UNITS[ending]}" if per else UNITS[ending]


def with_units(table: pd.DataFrame) -> pd.DataFrame:
    """Return a table, whose ``attrs["units"]`` now has the units of its columns, if they have one.

    Examples
    --------
    >>> import pandas as pd
    >>> with_units(pd.DataFrame({"event": [1], "height_m": [0.2]})).attrs
    {'units': {'height_m': 'm'}}
    """
    units = {str(name): unit_of_column(str(name)) for name in table}
    table.attrs["units"] = {name: unit for name, unit in units.items() if unit}
    return table
