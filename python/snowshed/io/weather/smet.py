"""SMET and its successor iCSV, the formats of MeteoIO and snow models.

Both name their fields and the mark of missing values in a header. Their units are SI (K, m, mm),
or become SI with the offsets and factors in the header; iCSV may name its units instead. Amounts
are sums since the row before, except HN24, the new snow of the last 24 hours.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Optional

from snowshed._core import InputError
from snowshed.base.formatting import number_in
from snowshed.base.messages import quoted
from snowshed.io.weather.columns import Cells, Column, Reading, observations
from snowshed.io.weather.observation import (
    DAY,
    ZERO_CELSIUS,
    Quantity,
    Station,
    cells_of,
    coordinate,
    time_of,
)

#: Fields of MeteoIO, in order of preference: their quantity, SI unit, and the hours over which an
#: amount gathers (None: since the row before). HNW is the former name of PSUM.
FIELDS: Mapping[str, tuple[str, str, Optional[float]]] = {
    "TA": ("temperature", "K", None),
    "PSUM": ("precipitation", "mm", None),
    "HNW": ("precipitation", "mm", None),
    "HS": ("snow_depth", "m", None),
    "HN": ("snowfall", "m", None),
    "HN24": ("snowfall", "m", DAY),
}
#: Units of each quantity, with the factor and the offset to the unit of an observation.
KELVIN, CELSIUS, FAHRENHEIT = (1.0, -ZERO_CELSIUS), (1.0, 0.0), (5.0 / 9.0, -160.0 / 9.0)
INCH = 0.0254  # m
DEPTHS = {
    "m": (1.0, 0.0),
    "cm": (0.01, 0.0),
    "mm": (0.001, 0.0),
    **dict.fromkeys(("in", "inch", "inches"), (INCH, 0.0)),
}
UNITS: Mapping[str, Mapping[str, tuple[float, float]]] = {
    "temperature": {
        **dict.fromkeys(("K", "kelvin", "Kelvin"), KELVIN),
        **dict.fromkeys(("degC", "°C", "C", "deg C", "celsius", "Celsius"), CELSIUS),
        **dict.fromkeys(("degF", "°F", "F"), FAHRENHEIT),
    },
    "precipitation": {
        **dict.fromkeys(("mm", "kg/m2", "kg/m^2", "kg m-2", "kg/m²"), (1.0, 0.0)),
        "cm": (10.0, 0.0),
        "m": (1000.0, 0.0),
        **dict.fromkeys(("in", "inch", "inches"), (1000.0 * INCH, 0.0)),
    },
    "snowfall": DEPTHS,
    "snow_depth": DEPTHS,
}
JULIAN_NOON, NOON = 2451545.0, datetime(2000, 1, 1, 12)
PROFILES = "2DTIMESERIES"
NUMBER = r"(-?[0-9.]+)"
POINT = re.compile(rf"POINTZ? *\( *{NUMBER} +{NUMBER}(?: +{NUMBER})? *\)", re.IGNORECASE)


@dataclass(frozen=True)
class _Header:
    """The keys of a header with their lines, and the first line of data."""

    name: str
    start: int
    values: Mapping[str, str]
    lines: Mapping[str, int]

    def where(self, key: str) -> str:
        """Return the line of a key for messages; for a missing key, the line below the header."""
        return f"{self.name}, line {self.lines.get(key, self.start + 1)}, column {key}"


def is_smet(lines: Sequence[str]) -> bool:
    """Return whether a file is SMET."""
    return lines[0].startswith("SMET ")


def read_smet(name: str, lines: Sequence[str]) -> Station:
    """Return a SMET file's observations; raises InputError naming line and column."""
    kind = [*lines[0].split(), "nothing"][2]
    if kind != "ASCII":
        raise InputError(f"{name}, line 1, column 3: {quoted(kind)}; allowed: ASCII")
    header = _header(name, [re.sub(r"\s[#;].*", "", line).strip() for line in lines])
    fields = header.values.get("fields", "").split()
    rows = [re.sub(r"(^|\s)[#;].*", "", line) for line in lines]  # comments of the standard
    return _station("SMET", header, rows, fields, _by_factors(header, fields, None), None)


def is_icsv(lines: Sequence[str]) -> bool:
    """Return whether a file is iCSV."""
    return lines[0].lstrip("# ").startswith("iCSV ")


def read_icsv(name: str, lines: Sequence[str]) -> Station:
    """Return an iCSV file's observations; raises InputError naming line and column."""
    if PROFILES in lines[0]:
        raise InputError(
            f"{name}, line 1, column 5: {PROFILES} holds profiles, not the weather of a station"
        )
    header = _header(name, [re.sub("^#+", "", line.strip()).strip() for line in lines])
    separator = header.values.get("field_delimiter", ",")
    if len(separator) != 1:
        raise InputError(
            f"{header.where('field_delimiter')}: {quoted(separator)}; allowed: one character"
        )
    fields = _header_list(header, "fields", separator)
    quantities = _by_units(header, fields, separator) or _by_factors(header, fields, separator)
    return _station("iCSV", header, lines, fields, quantities, separator)


def _by_factors(
    header: _Header, fields: Sequence[str], separator: str | None
) -> dict[int, Quantity]:
    """Return the fields to read, with the header's factors and offsets to SI units."""
    offsets, factors = (
        _numbers(header, field, fields, separator) for field in ("units_offset", "units_multiplier")
    )
    quantities = {}
    for place, field in enumerate(fields):
        if field in FIELDS:
            name, unit, hours = FIELDS[field]
            shift = UNITS[name][unit][1]
            factor, offset = factors[place] if factors else 1.0, offsets[place] if offsets else 0.0
            if factor == 0.0:
                raise InputError(f"{header.where('units_multiplier')}: 0 for {field}")
            unit = (
                unit if (factor, offset) == (1.0, 0.0) else f"{unit} by {factor:g} and {offset:g}"
            )
            quantities[place] = Quantity(name, unit, factor, offset + shift, hours)
    return quantities


def _by_units(header: _Header, fields: Sequence[str], separator: str) -> dict[int, Quantity]:
    """Return the fields to read in the units of the header; none if the header names no units.

    Factors besides units must be 1, or convert the units to SI.
    """
    units = _header_list(header, "units", separator)
    if not units:
        return {}
    if len(units) != len(fields):
        raise InputError(f"{header.where('units')}: {len(units)} units for {len(fields)} fields")
    by_factors = _by_factors(header, fields, separator)
    quantities = {}
    for place, field in enumerate(fields):
        if field not in FIELDS:
            continue
        name, si, hours = FIELDS[field]
        unit = units[place]
        if unit not in UNITS[name]:
            raise InputError(
                f"{header.where('units')}: {quoted(unit)} of {field}; allowed: "
                f"{', '.join(UNITS[name])}"
            )
        quantities[place] = Quantity(name, unit, *UNITS[name][unit], hours)
        factor, offset = by_factors[place].factor, by_factors[place].offset
        to_si = UNITS[name][unit]
        plain = math.isclose(factor, 1.0) and math.isclose(offset, UNITS[name][si][1])
        if not plain and not (
            math.isclose(factor, to_si[0]) and math.isclose(offset, to_si[1], abs_tol=0.01)
        ):
            raise InputError(
                f"{header.where('units')}: {quoted(unit)} of {field}, and a factor {factor:g} that "
                f"does not convert {unit} to {si}; correct one of them"
            )
    return quantities


def _station(
    form: str,
    header: _Header,
    lines: Sequence[str],
    fields: Sequence[str],
    quantities: Mapping[int, Quantity],
    separator: str | None,
) -> Station:
    clock = next((name for name in ("timestamp", "julian") if name in fields), None)
    if clock is None or not quantities:
        needed = f"none of {', '.join(FIELDS)}" if clock else "neither timestamp nor julian"
        raise InputError(
            f"{header.where('fields')}: {needed} among {', '.join(fields) or 'no fields'}"
        )
    when = fields.index(clock)
    missing = ("", header.values.get("nodata", "-999"), "nan", "NaN", "NA")
    order = list(FIELDS)
    columns = [
        Column(place, fields[place], quantities[place])
        for place in sorted(quantities, key=lambda place: order.index(fields[place]))
    ]
    of_columns, readings = Cells(columns, missing), []
    for number, line in enumerate(lines[header.start + 1 :], header.start + 2):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        place = f"{header.name}, line {number}"
        cells = cells_of(line, fields, place, separator)
        if cells == fields:  # some writers of iCSV repeat the names of the columns
            continue
        values = of_columns.read(cells, place)
        readings.append(Reading(number, _time(cells[when], place, clock), values))
    rows, titles, notes = observations(columns, readings)
    title = header.values.get("station_name") or header.values.get("station_id", "")
    latitude, longitude, altitude, zone = _position(header)
    return Station(form, title, rows, notes, False, latitude, longitude, altitude, zone, titles)


def _position(header: _Header) -> tuple[Optional[float], ...]:
    """Return latitude, longitude, altitude, and hours ahead of universal time."""
    values = header.values
    point = POINT.match(values.get("geometry", ""))
    if point and values.get("srid", "").endswith("4326"):
        longitude, latitude, altitude = (point[1], point[2], point[3] or "")
    else:
        keys = ("longitude", "latitude", "altitude")
        longitude, latitude, altitude = (values.get(key, "") for key in keys)
    zone = "tz" if "tz" in values else "timezone"
    nodata = values.get("nodata", "-999")
    return tuple(
        None if text == nodata else coordinate(text, header.where(key), largest)
        for text, key, largest in (
            (latitude, "latitude", 90.0),
            (longitude, "longitude", 360.0),
            (altitude, "altitude", 9000.0),
            (values.get(zone, ""), zone, 15.0),
        )
    )


def _time(cell: str, place: str, clock: str) -> datetime:
    where = f"{place}, column {clock}"
    if clock == "timestamp":
        return time_of(cell, where)
    try:  # rounded to seconds: a Julian date in double precision has steps of 40 microseconds
        seconds = round(86400 * (number_in(cell) - JULIAN_NOON))
        return NOON + timedelta(seconds=seconds)
    except (ValueError, OverflowError):
        raise InputError(
            f"{where}: {quoted(cell)} is not a Julian date such as 2460676.5"
        ) from None


def _header(name: str, lines: Sequence[str]) -> _Header:
    """Return the header above [DATA], of lines without comments."""
    values: dict[str, str] = {}
    indices: dict[str, int] = {}
    for number, line in enumerate(lines, 1):
        if line == "[DATA]":
            return _Header(name, number - 1, values, indices)
        if number == 1 or not line or line.startswith(("[", "#", ";")):
            continue
        key, equals, value = (part.strip() for part in line.partition("="))
        if not equals:
            raise InputError(
                f"{name}, line {number}, column 1: {quoted(line)} is not a KEY = VALUE of a header"
            )
        values[key], indices[key] = value, number
    raise InputError(
        f"{name}, line {len(lines)}, column 1: the file ends without its section [DATA]"
    )


def _header_list(header: _Header, key: str, separator: str | None) -> list[str]:
    value = header.values.get(key, "")
    return [part.strip() for part in value.split(separator)] if value else []


def _numbers(
    header: _Header, key: str, fields: Sequence[str], separator: str | None
) -> list[float]:
    """Return a number for each field; none if the header has neither the key nor its plural."""
    key = next((candidate for candidate in (key, f"{key}s") if candidate in header.values), key)
    if key not in header.values:
        return []
    numbers = [number_in(part) for part in _header_list(header, key, separator)]
    if len(numbers) != len(fields) or not all(abs(number) < 1e9 for number in numbers):
        raise InputError(
            f"{header.where(key)}: {quoted(header.values[key])}; needed: {len(fields)} numbers"
        )
    return numbers
