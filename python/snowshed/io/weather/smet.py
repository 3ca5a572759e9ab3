"""SMET and its successor iCSV, the formats of MeteoIO and snow models.

Both name their fields and their value for missing ones in a header. Their units are SI (K, m, mm),
or become SI with the offsets and factors that the header gives; iCSV may name its units instead.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime, timedelta
from typing import Any

from snowshed._core import InputError
from snowshed.io.messages import quoted
from snowshed.io.number_text import number_in
from snowshed.io.weather.observation import (
    ZERO_CELSIUS,
    Observation,
    Quantity,
    Station,
    cells_of,
    time_of,
)

#: Fields of MeteoIO: which quantity, and its SI unit. HNW is the former name of PSUM.
FIELDS: Mapping[str, tuple[str, str]] = {
    "TA": ("temperature", "K"),
    "PSUM": ("precipitation", "mm"),
    "HNW": ("precipitation", "mm"),
    "HS": ("snow_depth", "m"),
    "HN": ("snowfall", "m"),
    "HN24": ("snowfall", "m"),
}
#: Units of each quantity, and how they become those of an observation: factor and offset.
KELVIN, CELSIUS = (1.0, -ZERO_CELSIUS), (1.0, 0.0)
DEPTHS = {"m": (1.0, 0.0), "cm": (0.01, 0.0), "mm": (0.001, 0.0)}
UNITS: Mapping[str, Mapping[str, tuple[float, float]]] = {
    "temperature": {"K": KELVIN, "degC": CELSIUS, "°C": CELSIUS, "C": CELSIUS},
    "precipitation": dict.fromkeys(("mm", "kg/m2", "kg/m^2", "kg m-2"), (1.0, 0.0)),
    "snowfall": DEPTHS,
    "snow_depth": DEPTHS,
}
JULIAN_NOON, NOON = 2451545.0, datetime(2000, 1, 1, 12)
PROFILES = "2DTIMESERIES"


@dataclass(frozen=True)
class _Header:
    """The keys of a header, where each stands, and where the data begins."""

    name: str
    start: int
    values: Mapping[str, str]
    lines: Mapping[str, int]

    def where(self, key: str) -> str:
        """Return the place of a key for messages; of one that lacks, the line below the header."""
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
    quantities = _by_factors(header, fields, None) or _by_units(header, fields, None)
    return _station("SMET", header, lines, fields, quantities, None)


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
    fields = _listed(header, "fields", separator)
    quantities = _by_factors(header, fields, separator) or _by_units(header, fields, separator)
    return _station("iCSV", header, lines, fields, quantities, separator)


def _by_factors(
    header: _Header, fields: Sequence[str], separator: str | None
) -> dict[int, Quantity]:
    """Return the fields to read with factors and offsets to SI; none if the header has neither."""
    offsets, factors = (
        _numbers(header, one, fields, separator) for one in ("units_offset", "units_multiplier")
    )
    if not offsets and not factors:
        return {}
    quantities = {}
    for place, one in enumerate(fields):
        if one in FIELDS:
            quantity, unit = FIELDS[one]
            shift = UNITS[quantity][unit][1]
            factor, offset = factors[place] if factors else 1.0, offsets[place] if offsets else 0.0
            if factor == 0.0:
                raise InputError(f"{header.where('units_multiplier')}: 0 for {one}")
            quantities[place] = Quantity(quantity, unit, factor, offset + shift)
    return quantities


def _by_units(header: _Header, fields: Sequence[str], separator: str | None) -> dict[int, Quantity]:
    """Return the fields to read in the units that the header names, or else in SI units."""
    units = _listed(header, "units", separator) if "units" in header.values and separator else []
    if units and len(units) != len(fields):
        raise InputError(f"{header.where('units')}: {len(units)} units for {len(fields)} fields")
    quantities = {}
    for place, one in enumerate(fields):
        if one not in FIELDS:
            continue
        quantity, unit = FIELDS[one]
        unit = units[place] if units else unit
        if unit not in UNITS[quantity]:
            raise InputError(
                f"{header.where('units')}: {quoted(unit)} of {one}; allowed: "
                f"{', '.join(UNITS[quantity])}"
            )
        quantities[place] = Quantity(quantity, unit, *UNITS[quantity][unit])
    return quantities


def _station(
    form: str,
    header: _Header,
    lines: Sequence[str],
    fields: Sequence[str],
    quantities: Mapping[int, Quantity],
    separator: str | None,
) -> Station:
    clock = next((one for one in ("timestamp", "julian") if one in fields), None)
    if clock is None or not quantities:
        needed = f"none of {', '.join(FIELDS)}" if clock else "neither timestamp nor julian"
        raise InputError(
            f"{header.where('fields')}: {needed} among {', '.join(fields) or 'no fields'}"
        )
    when = fields.index(clock)
    missing = ("", header.values.get("nodata", "-999"), "nan", "NaN", "NA")
    rows = []
    for number, line in enumerate(lines[header.start + 1 :], header.start + 2):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        place = f"{header.name}, line {number}"
        cells = cells_of(line, fields, place, separator)
        if cells == fields:  # some writers of iCSV name the columns once more
            continue
        values: dict[str, Any] = {
            one.name: one.read(cells[column], f"{place}, column {fields[column]}", missing)
            for column, one in quantities.items()
        }
        rows.append(Observation(number, _time(cells[when], place, clock), **values))
    title = header.values.get("station_name") or header.values.get("station_id", "")
    return Station(form, title, rows)


def _time(cell: str, place: str, clock: str) -> datetime:
    where = f"{place}, column {clock}"
    if clock == "timestamp":
        return time_of(cell, where)
    try:  # to the second: a Julian date in double precision has 40 microseconds
        seconds = round(86400 * (number_in(cell) - JULIAN_NOON))
        return NOON + timedelta(seconds=seconds)
    except (ValueError, OverflowError):
        raise InputError(
            f"{where}: {quoted(cell)} is not a Julian date such as 2460676.5"
        ) from None


def _header(name: str, lines: Sequence[str]) -> _Header:
    """Return the header above [DATA], of lines without comments."""
    values: dict[str, str] = {}
    places: dict[str, int] = {}
    for number, line in enumerate(lines, 1):
        if line == "[DATA]":
            return _Header(name, number - 1, values, places)
        if number == 1 or not line or line.startswith(("[", "#", ";")):
            continue
        key, equals, value = (part.strip() for part in line.partition("="))
        if not equals:
            raise InputError(
                f"{name}, line {number}, column 1: {quoted(line)} is no KEY = VALUE of a header"
            )
        values[key], places[key] = value, number
    raise InputError(
        f"{name}, line {len(lines)}, column 1: the file ends without its section [DATA]"
    )


def _listed(header: _Header, key: str, separator: str | None) -> list[str]:
    value = header.values.get(key, "")
    return [one.strip() for one in value.split(separator)] if value else []


def _numbers(
    header: _Header, key: str, fields: Sequence[str], separator: str | None
) -> list[float]:
    """Return a number for each field; none if the header lacks the key, or its plural of iCSV."""
    key = next((one for one in (key, f"{key}s") if one in header.values), key)
    if key not in header.values:
        return []
    found = [number_in(part) for part in _listed(header, key, separator)]
    if len(found) != len(fields) or not all(abs(one) < 1e9 for one in found):
        raise InputError(
            f"{header.where(key)}: {quoted(header.values[key])}; needed: {len(fields)} numbers"
        )
    return found
