"""NOAA's daily summaries: a row for each day, a column for each element of GHCN-daily.

Files of the archive's folder `access` hold the units of GHCN-daily (tenths of mm and of degrees C).
Files from an order or from the data service are metric or in inches and degrees F, and do not
state which. Only the number of decimals shows the units:

=========================== ==================== ===================== =================
units                       temperature          precipitation         new snow
=========================== ==================== ===================== =================
tenths (archive)            whole                whole                 whole
mm and degrees C            one decimal, 10.0    one decimal, or none  whole
inches and degrees F        whole                two decimals, 0.20    one decimal
=========================== ==================== ===================== =================

Units are never guessed: they are accepted only if the whole content of the file matches exactly one
row of this table. Precipitation with one decimal fits two rows, so temperatures are needed,
too; a file without decimals is accepted only in the form of the archive.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from snowshed._core import InputError
from snowshed.io.weather.american import ELEMENTS, FAHRENHEIT, INCH, ghcn, same_station
from snowshed.io.weather.daily import COUNTS, MISSING, Days, with_totals
from snowshed.io.weather.observation import (
    Quantity,
    Station,
    cells_of,
    coordinate,
    split_cells,
    time_of,
)

TEMPERATURES = ("TMAX", "TMIN", "TAVG")
METRIC: Mapping[str, Quantity] = with_totals(
    {
        "SNOW": Quantity("snowfall", "mm", 1e-3),
        "SNWD": Quantity("snow_depth", "mm", 1e-3),
        "PRCP": Quantity("precipitation", "mm"),
        **dict.fromkeys(TEMPERATURES, Quantity("temperature", "degrees C")),
    }
)
STANDARD: Mapping[str, Quantity] = with_totals(
    {
        "SNOW": Quantity("snowfall", "inches", INCH),
        "SNWD": Quantity("snow_depth", "inches", INCH),
        "PRCP": Quantity("precipitation", "inches", 1e3 * INCH),
        **dict.fromkeys(TEMPERATURES, Quantity("temperature", "degrees F", *FAHRENHEIT)),
    }
)
STATION, DATE, PLACE = "STATION", "DATE", "LATITUDE"
FLAGS = "_ATTRIBUTES"  # of measurement, of quality, of the source, and the time of observation
ARCHIVE = [STATION, DATE, PLACE]  # first columns of a file of the archive, and of no other


def is_summaries(lines: Sequence[str]) -> bool:
    """Return whether a file is of the daily summaries."""
    head = [cell.strip().strip('"') for cell in lines[0].split(",")]
    return head[0] == STATION and DATE in head and any(element in head for element in ELEMENTS)


def read_summaries(name: str, lines: Sequence[str]) -> Station:
    """Return the observations of daily summaries; raises InputError naming line and column."""
    head = split_cells(lines[0], f"{name}, line 1")
    rows = [
        (number, dict(zip(head, cells_of(line, head, f"{name}, line {number}"))))
        for number, line in enumerate(lines[1:], 2)
        if line.strip()
    ]
    units, title = _units(name, head, [row for _, row in rows])
    days = Days()
    for number, row in rows:
        place = f"{name}, line {number}"
        same_station(row[STATION], rows[0][1][STATION], f"{place}, column {STATION}")
        day = time_of(row[DATE], f"{place}, column {DATE}", "%Y-%m-%d")
        for element in (name for name in (*units, *COUNTS) if name in row):
            where = f"{place}, column {element}"
            value = None if element in COUNTS else units[element].read(row[element], where, MISSING)
            measurement, quality, *_ = [*row.get(element + FLAGS, "").split(","), "", ""]
            if row[element] in MISSING or not days.passes(measurement, quality):
                continue
            if element in COUNTS:
                days.count(row[element], day, number, element, where)
            else:
                days.enter(day, number, element, value, where)
    first = rows[0][1] if rows else {}
    station = ghcn(first.get("NAME") or first.get(STATION, ""), days, f"its units are {title}")
    return replace(station, **_position(first, f"{name}, line 2, column"))


def _position(row: Mapping[str, str], where: str) -> dict[str, Any]:
    return {
        key.lower().replace("elevation", "altitude"): coordinate(
            row.get(key, ""), f"{where} {key}", largest
        )
        for key, largest in ((PLACE, 90.0), ("LONGITUDE", 360.0), ("ELEVATION", 9000.0))
    }


def _units(
    name: str, head: Sequence[str], rows: Sequence[Mapping[str, str]]
) -> tuple[Mapping[str, Quantity], str]:
    """Return the units of a file, and their name."""
    temperature, rain = _decimals(rows, *TEMPERATURES), _decimals(rows, "PRCP", "MDPR")
    inches = rain > 1 or _decimals(rows, "SNOW", "MDSF") > 0
    if temperature > 0 and inches:
        raise _unknown(name, head, "with decimals of temperatures, and those of inches")
    if temperature > 0:
        return METRIC, "mm and degrees C"
    if inches or (rain > 0 and temperature == 0):
        return STANDARD, "inches and degrees F"
    if rain > 0:
        raise _unknown(name, head, "with one decimal, as mm and inches have, and no temperature")
    if (head[:3] == ARCHIVE and any(title.endswith(FLAGS) for title in head)) or not rows:
        return ELEMENTS, "tenths of mm and of degrees C, and mm of snow"
    raise _unknown(name, head, "without a decimal in any row")


def _unknown(name: str, head: Sequence[str], contents: str) -> InputError:
    first = next(title for title in head if title in ELEMENTS)
    return InputError(
        f"{name}, line 2, column {first}: {contents}, its units are ambiguous; give a longer file, "
        f"one with temperatures, or that of the archive (its columns begin {', '.join(ARCHIVE)}, "
        f"and have {FLAGS})"
    )


def _decimals(rows: Sequence[Mapping[str, str]], *elements: str) -> int:
    """Return the largest number of decimals among values of some elements; -1 without values."""
    cells = [row.get(element, "").strip() for row in rows for element in elements]
    return max((len(cell.partition(".")[2]) for cell in cells if cell), default=-1)
