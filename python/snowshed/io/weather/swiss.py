"""Swiss data: MeteoSwiss (open data and IDAWEB) and the IMIS stations of the SLF."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from snowshed._core import InputError
from snowshed.io.messages import quoted
from snowshed.io.weather.observation import Observation, Quantity, Station, cells_of, time_of

#: Parameters of MeteoSwiss, daily, hourly and of ten minutes: depths in cm.
METEOSWISS: Mapping[str, Quantity] = {
    "tre200d0": Quantity("temperature", "degrees C"),
    "tre200h0": Quantity("temperature", "degrees C"),
    "tre200s0": Quantity("temperature", "degrees C"),
    "rre150d0": Quantity("precipitation", "mm"),
    "rre150h0": Quantity("precipitation", "mm"),
    "rre150z0": Quantity("precipitation", "mm"),
    "rka150d0": Quantity("precipitation", "mm"),
    "hns000d0": Quantity("snowfall", "cm", 0.01),
    "hto000d0": Quantity("snow_depth", "cm", 0.01),
    "htoautd0": Quantity("snow_depth", "cm", 0.01),
    "htoauts0": Quantity("snow_depth", "cm", 0.01),
}
#: Of the open data, of its forerunner, and of IDAWEB; in small letters.
STATIONS = ("station_abbr", "station/location", "stn")
TIMES = ("reference_timestamp", "date", "time")
MISSING = ("", "-", "NA", "NaN", "null")
FORMATS = ("%d.%m.%Y %H:%M", "%Y%m%d%H%M", "%Y%m%d")
#: Columns of the SLF; depths in cm.
IMIS: Mapping[str, Quantity] = {
    "HS": Quantity("snow_depth", "cm", 0.01),
    "HN_1D": Quantity("snowfall", "cm", 0.01),
    "TA_30MIN_MEAN": Quantity("temperature", "degrees C"),
}


def is_meteoswiss(lines: Sequence[str]) -> bool:
    """Return whether a file is of MeteoSwiss."""
    return _head(lines, ";", STATIONS) is not None


def read_meteoswiss(name: str, lines: Sequence[str]) -> Station:
    """Return the observations of MeteoSwiss; raises InputError naming line and column."""
    return _read("MeteoSwiss", name, lines, ";", STATIONS, TIMES, METEOSWISS, FORMATS)


def is_imis(lines: Sequence[str]) -> bool:
    """Return whether a file is of an IMIS station."""
    return _head(lines, ",", ("station_code",)) is not None


def read_imis(name: str, lines: Sequence[str]) -> Station:
    """Return the observations of an IMIS station; raises InputError naming line and column."""
    return _read("IMIS", name, lines, ",", ("station_code",), ("measure_date",), IMIS, ())


def _head(lines: Sequence[str], separator: str, stations: Sequence[str]) -> int | None:
    """Return the line, from 0, whose first cell is that of a station."""
    for number, line in enumerate(lines[:5]):
        if _title(line.split(separator)[0]).lower() in stations:
            return number
    return None


def _read(
    form: str,
    name: str,
    lines: Sequence[str],
    separator: str,
    stations: Sequence[str],
    times: Sequence[str],
    parameters: Mapping[str, Quantity],
    formats: Sequence[str],
) -> Station:
    start = _head(lines, separator, stations)
    assert start is not None
    head = [_title(cell) for cell in lines[start].split(separator)]
    when = next((i for i, title in enumerate(head) if title.lower() in times), None)
    if when is None:
        raise InputError(f"{name}, line {start + 1}, column {' or '.join(times)}: missing")
    columns = _best(head, parameters)
    if not columns:
        raise InputError(
            f"{name}, line {start + 1}, column {' or '.join(parameters)}: all are missing"
        )
    rows, station = [], ""
    for number, line in enumerate(lines[start + 1 :], start + 2):
        place = f"{name}, line {number}"
        if not line.strip() or [_title(cell) for cell in line.split(separator)] == head:
            continue  # orders of IDAWEB name the columns again above every part
        cells = cells_of(line, head, place, separator)
        if station and cells[0] != station:
            raise InputError(
                f"{place}, column {head[0]}: {quoted(cells[0])} is another station than "
                f"{quoted(station)}"
            )
        station = cells[0]
        values: dict[str, Any] = {
            one.name: one.read(cells[i], f"{place}, column {head[i]}", MISSING)
            for i, one in columns.items()
        }
        time = time_of(cells[when], f"{place}, column {head[when]}", *formats)
        rows.append(Observation(number, time, **values))
    return Station(form, station, rows)


def _title(cell: str) -> str:
    return cell.strip().strip('"')


def _best(head: Sequence[str], parameters: Mapping[str, Quantity]) -> dict[int, Quantity]:
    """Return the columns to read: of several of a quantity the first in the list."""
    found: dict[str, tuple[int, Quantity]] = {}
    for title, quantity in parameters.items():
        if title in head:
            found.setdefault(quantity.name, (head.index(title), quantity))
    return dict(found.values())
