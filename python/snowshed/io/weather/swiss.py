"""Swiss data: MeteoSwiss (open data and IDAWEB) and the IMIS stations of the SLF."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from snowshed._core import InputError
from snowshed.base.messages import quoted
from snowshed.io.weather.columns import Cells, Column, Reading, observations
from snowshed.io.weather.observation import Quantity, Station, cells_of, time_of

TEN_MINUTES, HOURLY, DAILY = 1.0 / 6.0, 1.0, 24.0  # hours over which amounts gather
TEMPERATURE = Quantity("temperature", "degrees C")
DEPTH = Quantity("snow_depth", "cm", 0.01)
#: Daily, hourly and ten-minute parameters of MeteoSwiss, in order of preference; depths in cm. The
#: time is the end of hours and of ten minutes, but the beginning of days, which for water and snow
#: begin at 6 UTC.
METEOSWISS: Mapping[str, Quantity] = {
    **dict.fromkeys(("tre200d0", "tre200h0", "tre200s0"), TEMPERATURE),
    "rre150d0": Quantity("precipitation", "mm", hours=DAILY),
    "rre150h0": Quantity("precipitation", "mm", hours=HOURLY),
    "rre150z0": Quantity("precipitation", "mm", hours=TEN_MINUTES),
    "rka150d0": Quantity("precipitation", "mm", hours=DAILY),
    "rre003i0": Quantity("precipitation", "mm", hours=3.0),
    "rre006i0": Quantity("precipitation", "mm", hours=6.0),
    "rre012i0": Quantity("precipitation", "mm", hours=12.0),
    "rre024i0": Quantity("precipitation", "mm", hours=DAILY),
    "hns000d0": Quantity("snowfall", "cm", 0.01, hours=DAILY),
    **dict.fromkeys(("hto000d0", "htoautd0", "htoauths", "htoauts0"), DEPTH),
}
SNOWY = ("rre", "rka", "hns", "hto")  # beginnings of the names of parameters of water and snow
#: Column names in the open data, in its predecessor, and in IDAWEB, in lower case.
STATIONS = ("station_abbr", "station/location", "stn")
TIMES = ("reference_timestamp", "date", "time")
MISSING = ("", "-", "NA", "NaN", "null")
FORMATS = ("%d.%m.%Y %H:%M", "%Y%m%d%H%M", "%Y%m%d")
#: Columns of the SLF; depths in cm.
IMIS: Mapping[str, Quantity] = {
    "HS": DEPTH,
    "HN_1D": Quantity("snowfall", "cm", 0.01, hours=DAILY),
    "TA_30MIN_MEAN": TEMPERATURE,
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
    """Return the index of the first line that begins with the name of the station's column."""
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
    columns = [
        Column(i, head[i], quantity)
        for title, quantity in parameters.items()
        for i in range(len(head))
        if head[i] == title
    ]
    if not columns:
        raise InputError(
            f"{name}, line {start + 1}, column {' or '.join(parameters)}: all are missing"
        )
    of_columns, begin = Cells(columns, MISSING), lines[start].split(separator)[0]
    readings, station = [], ""
    for number, line in enumerate(lines[start + 1 :], start + 2):
        place = f"{name}, line {number}"
        if not line.strip():
            continue
        if line.startswith(begin) and [_title(cell) for cell in line.split(separator)] == head:
            continue  # files ordered from IDAWEB repeat the names of the columns above every part
        cells = cells_of(line, head, place, separator)
        if station and cells[0] != station:
            raise InputError(
                f"{place}, column {head[0]}: {quoted(cells[0])} is another station than "
                f"{quoted(station)}"
            )
        station = cells[0]
        values = of_columns.read(cells, place)
        time = time_of(cells[when], f"{place}, column {head[when]}", *formats)
        readings.append(Reading(number, time, values))
    rows, titles, notes = observations(columns, readings)
    unread = [title for title in head if title.startswith(SNOWY) and title not in parameters]
    if unread:
        notes.append(f"not read: {', '.join(unread)}")
    return Station(form, station, rows, notes, utc_offset=0.0, columns=titles)


def _title(cell: str) -> str:
    return cell.strip().strip('"')
