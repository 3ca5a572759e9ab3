"""SMET and its successor iCSV, the formats of MeteoIO and snow models.

Both name their fields and their value for missing ones in a header. SMET is in SI units (K, m,
mm), with offsets and factors where it is not; iCSV names its units.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from snowshed._core import InputError
from snowshed.io.weather.observation import (
    ZERO_CELSIUS,
    Observation,
    Quantity,
    Station,
    cells_of,
    time_of,
)

#: Fields of MeteoIO: which quantity, and the unit of SMET.
FIELDS: Mapping[str, tuple[str, str]] = {
    "TA": ("temperature", "K"),
    "PSUM": ("precipitation", "mm"),
    "HS": ("snow_depth", "m"),
    "HN": ("snowfall", "m"),
    "HN24": ("snowfall", "m"),
}
#: Units and how they become those of an observation: factor and offset.
UNITS: Mapping[str, tuple[float, float]] = {
    "K": (1.0, -ZERO_CELSIUS),
    "degC": (1.0, 0.0),
    "°C": (1.0, 0.0),
    "m": (1.0, 0.0),
    "cm": (0.01, 0.0),
    "mm": (1.0, 0.0),
    "kg/m2": (1.0, 0.0),
}
MILLIMETRE_DEPTH = 0.001


def is_smet(lines: Sequence[str]) -> bool:
    """Return whether a file is SMET."""
    return bool(lines) and lines[0].startswith("SMET ")


def read_smet(name: str, lines: Sequence[str]) -> Station:
    """Return a SMET file's observations; raises InputError naming line and column."""
    start = _section(name, lines, "[DATA]")
    header = _header(name, [line.strip() for line in lines[:start]])
    fields = header.get("fields", "").split()
    offsets, factors = (
        _numbers(name, header, key, len(fields), default)
        for key, default in (("units_offset", 0.0), ("units_multiplier", 1.0))
    )
    quantities = {}
    for place, one in enumerate(fields):
        if one in FIELDS:
            quantity, unit = FIELDS[one]
            _, shift = UNITS[unit]
            # SI value = multiplier * cell + offset
            quantities[place] = Quantity(quantity, unit, factors[place], offsets[place] + shift)
    return _station("SMET", name, header, lines, start, fields, quantities, None)


def is_icsv(lines: Sequence[str]) -> bool:
    """Return whether a file is iCSV."""
    return bool(lines) and lines[0].lstrip("# ").startswith("iCSV ")


def read_icsv(name: str, lines: Sequence[str]) -> Station:
    """Return an iCSV file's observations; raises InputError naming line and column."""
    plain = [line.lstrip("#").strip() if line.startswith("#") else line.strip() for line in lines]
    start = _section(name, plain, "[DATA]")
    header = _header(name, plain[:start])
    separator = header.get("field_delimiter", ",")
    if len(separator) != 1:
        raise InputError(f"{name}: field_delimiter: {separator!r}; allowed: one character")
    fields = [one.strip() for one in header.get("fields", "").split(separator)]
    units = [one.strip() for one in header.get("units", "").split(separator)]
    if len(units) != len(fields):
        raise InputError(
            f"{name}: units: {len(units)} units for {len(fields)} fields; all are needed"
        )
    quantities = {}
    for place, (one, unit) in enumerate(zip(fields, units)):
        if one not in FIELDS:
            continue
        quantity = FIELDS[one][0]
        if unit not in UNITS or (quantity == "temperature") != (unit in ("K", "degC", "°C")):
            raise InputError(f"{name}: units: {unit!r} of {one}; allowed: {', '.join(UNITS)}")
        factor, shift = UNITS[unit]
        if unit == "mm" and quantity in ("snow_depth", "snowfall"):
            factor = MILLIMETRE_DEPTH
        quantities[place] = Quantity(quantity, unit, factor, shift)
    return _station("iCSV", name, header, lines, start, fields, quantities, separator)


def _station(
    form: str,
    name: str,
    header: Mapping[str, str],
    lines: Sequence[str],
    start: int,
    fields: Sequence[str],
    quantities: Mapping[int, Quantity],
    separator: str | None,
) -> Station:
    if "timestamp" not in fields:
        raise InputError(
            f"{name}: no field timestamp; its fields are {', '.join(fields) or 'none'}"
        )
    when = fields.index("timestamp")
    missing = ("", header.get("nodata", "-999"))
    rows = []
    for number, line in enumerate(lines[start + 1 :], start + 2):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        place = f"{name}, line {number}"
        cells = cells_of(line, len(fields), place, separator)
        values: dict[str, Any] = {
            one.name: one.read(cells[column], f"{place}, column {fields[column]}", missing)
            for column, one in quantities.items()
        }
        rows.append(
            Observation(number, time_of(cells[when], f"{place}, column timestamp"), **values)
        )
    return Station(form, header.get("station_name", header.get("station_id", "")), rows)


def _section(name: str, lines: Sequence[str], title: str) -> int:
    for number, line in enumerate(lines):
        if line.strip() == title:
            return number
    raise InputError(f"{name}, line {len(lines)}: the file ends without its section {title}")


def _header(name: str, lines: Sequence[str]) -> dict[str, str]:
    header = {}
    for number, line in enumerate(lines[1:], 2):
        if not line or line.startswith(("[", "#")):
            continue
        key, equals, value = line.partition("=")
        if not equals:
            raise InputError(f"{name}, line {number}: {line[:40]!r} is no KEY = VALUE of a header")
        header[key.strip()] = value.strip()
    return header


def _numbers(
    name: str, header: Mapping[str, str], key: str, count: int, default: float
) -> list[float]:
    if key not in header:
        return [default] * count
    try:
        found = [float(part) for part in header[key].split()]
    except ValueError:
        found = []
    if len(found) != count:
        raise InputError(f"{name}: {key}: {header[key]!r}; needed: {count} numbers")
    return found
