"""Daily data of the United States: NOAA's GHCN-daily (.dly and by station), and ACIS columns."""

from __future__ import annotations

import calendar
import re
from collections import Counter
from collections.abc import Mapping, Sequence
from datetime import datetime

from snowshed._core import InputError
from snowshed.base.messages import quoted
from snowshed.io.weather.daily import COLUMNS, COUNTS, MISSING, TOTALS, Days, with_totals
from snowshed.io.weather.observation import Quantity, Station, cells_of, split_cells, time_of

#: Elements of GHCN-daily: SNOW and SNWD in mm, PRCP in tenths of mm, temperatures in tenths of C;
#: MDSF and MDPR are new snow and precipitation of several days.
ELEMENTS: Mapping[str, Quantity] = with_totals(
    {
        "SNOW": Quantity("snowfall", "mm", 1e-3),
        "SNWD": Quantity("snow_depth", "mm", 1e-3),
        "PRCP": Quantity("precipitation", "tenths of mm", 0.1),
        "TMAX": Quantity("temperature", "tenths of degrees C", 0.1),
        "TMIN": Quantity("temperature", "tenths of degrees C", 0.1),
        "TAVG": Quantity("temperature", "tenths of degrees C", 0.1),
    }
)
DLY = re.compile(r"^[A-Z0-9_-]{11}\d{6}[A-Z0-9]{4}")
DLY_LINE, DLY_CELL, DLY_DAYS = 21, 8, 31
BY_STATION = re.compile(r'^"?[A-Z0-9_-]{11}"?,"?\d{8}"?,"?[A-Z0-9]{4}"?,')
BY_STATION_HEAD = (
    "ID", "DATE", "ELEMENT", "DATA_VALUE", "M_FLAG", "Q_FLAG", "S_FLAG", "OBS_TIME",
)  # fmt: skip
INCH = 0.0254  # m
FAHRENHEIT = (5.0 / 9.0, -160.0 / 9.0)
_MAXIMUM = ("TMAX", Quantity("temperature", "degrees F", *FAHRENHEIT))
_MINIMUM = ("TMIN", Quantity("temperature", "degrees F", *FAHRENHEIT))
_MEAN = ("TAVG", Quantity("temperature", "degrees F", *FAHRENHEIT))
_WATER = ("PRCP", Quantity("precipitation", "inches", 1e3 * INCH))
_NEW = ("SNOW", Quantity("snowfall", "inches", INCH))
_DEPTH = ("SNWD", Quantity("snow_depth", "inches", INCH))
#: ACIS columns, by their names in lower case without blanks: names in the service, in its data
#: listings, and in tables of NOWData.
ACIS: Mapping[str, tuple[str, Quantity]] = {
    **dict.fromkeys(("maxt", "maxtemp", "maxtemperature", "temperaturemaximum"), _MAXIMUM),
    **dict.fromkeys(("mint", "mintemp", "mintemperature", "temperatureminimum"), _MINIMUM),
    **dict.fromkeys(("avgt", "avgtemp", "avgtemperature", "temperatureaverage"), _MEAN),
    **dict.fromkeys(("pcpn", "precip", "precipitation"), _WATER),
    **dict.fromkeys(("snow", "newsnow", "snowfall"), _NEW),
    **dict.fromkeys(("snwd", "snowdepth"), _DEPTH),
}
SUMMARIES = ("sum", "average", "normal")  # rows at the end of a month of NOWData
BARE_TITLE = re.compile(r'"?[A-Za-z0-9 .&()/-]{1,60}"?')
BARE_ROW = re.compile(r"\d{4}-\d{2}-\d{2}(,[MTS]?-?[0-9.]*A?){2,}")
#: Flag of ACIS for a trace.
TRACE = "T"
#: Flags of ACIS for missing values.
LACKING = ("M", "", "S")
#: Flag of ACIS for an amount that a later one contains.
PART = "S"
#: Flag of ACIS for an amount that contains earlier ones.
GATHERED = "A"


def is_dly(lines: Sequence[str]) -> bool:
    """Return whether a file is GHCN-daily of fixed width."""
    return bool(lines) and bool(DLY.match(lines[0]))


def read_dly(name: str, lines: Sequence[str]) -> Station:
    """Return a .dly file's observations; raises InputError naming line and column."""
    days = Days()
    for number, line in enumerate(lines, 1):
        if not line.strip():
            continue
        place = f"{name}, line {number}"
        if not DLY.match(line):
            raise InputError(
                f"{place}, column 1: {quoted(line[:DLY_LINE])} is not a station, year, month and "
                "element"
            )
        same_station(line[:11], lines[0][:11], f"{place}, column station")
        element = line[17:21]
        if element not in ELEMENTS and element not in COUNTS:
            continue
        year, month = int(line[11:15]), int(line[15:17])
        if not 1 <= month <= 12 or year < 1:
            raise InputError(f"{place}, column month: {line[15:17]!r}; allowed: 01 to 12")
        for day in range(1, calendar.monthrange(year, month)[1] + 1):
            start = DLY_LINE + DLY_CELL * (day - 1)
            if len(line) < start + 5:  # trailing flags may be missing
                raise InputError(
                    f"{place}, column day {day}: the line ends after {len(line)} characters; "
                    f"needed: {DLY_LINE + DLY_CELL * DLY_DAYS}"
                )
            if not days.passes(line[start + 5 : start + 6], line[start + 6 : start + 7]):
                continue
            where, text = f"{place}, column day {day}", line[start : start + 5]
            date = datetime(year, month, day)
            if element in COUNTS:
                days.count(text, date, number, element, where)
            else:
                value = ELEMENTS[element].read(text, where, MISSING)
                days.enter(date, number, element, value, where)
    return ghcn(lines[0][:11], days)


def ghcn(station: str, days: Days, *more: str) -> Station:
    """Return a station of GHCN-daily, with more notes."""
    rows, notes = days.rows()
    return Station("GHCN-daily", station, rows, (*notes, *more), columns=COLUMNS)


def is_by_station(lines: Sequence[str]) -> bool:
    """Return whether a file is GHCN-daily from the folder by_station."""
    return bool(BY_STATION.match(lines[0])) or _is_head(lines[0])


def read_by_station(name: str, lines: Sequence[str]) -> Station:
    """Return a by_station file's observations; raises InputError naming line and column."""
    days = Days()
    start = 1 if _is_head(lines[0]) else 0  # copies from cloud services name the columns
    station = ""
    for number, line in enumerate(lines[start:], start + 1):
        if not line.strip():
            continue
        place = f"{name}, line {number}"
        own, date, element, text, measurement, quality, *_ = cells_of(line, BY_STATION_HEAD, place)
        station = station or own
        same_station(own, station, f"{place}, column ID")
        counts = element in COUNTS
        if not (counts or element in ELEMENTS) or not days.passes(measurement, quality):
            continue
        where = f"{place}, column DATA_VALUE ({element})"
        day = time_of(date, f"{place}, column DATE", "%Y%m%d")
        if counts:
            days.count(text, day, number, element, where)
        else:
            value = ELEMENTS[element].read(text, where, MISSING)
            days.enter(day, number, element, value, where)
    return ghcn(station, days)


def is_acis(lines: Sequence[str]) -> bool:
    """Return whether a file has columns of ACIS, with or without their names."""
    return _acis_head(lines) is not None or _is_bare_acis(lines)


def read_acis(name: str, lines: Sequence[str]) -> Station:
    """Return ACIS columns as observations; raises InputError naming line and column."""
    layout = _acis_head(lines)
    if layout is None:
        raise InputError(
            f"{name}, line 2, column 1: rows of ACIS without the names of their columns; add a "
            "line above, such as Date,maxt,mint,pcpn,snow,snwd, in the order of your request"
        )
    start, separator = layout
    head = split_cells(lines[start], f"{name}, line {start + 1}", separator)
    columns = {i: ACIS[key] for i, key in enumerate(map(_key, head)) if key in ACIS}
    days = Days()
    parts: Counter[str] = Counter()  # days whose amount follows on a later day, by element
    for number, line in enumerate(lines[start + 1 :], start + 2):
        if not line.strip() or line.startswith("#") or _key(line).startswith(SUMMARIES):
            continue
        place = f"{name}, line {number}"
        cells = cells_of(line, head, place, separator)
        day = time_of(cells[0], f"{place}, column {head[0]}", "%Y-%m-%d", "%m/%d/%Y")
        for i, (element, quantity) in columns.items():
            cell, where = cells[i].removesuffix(GATHERED), f"{place}, column {head[i]}"
            value = 0.0 if cell == TRACE else quantity.read(cell, where, LACKING)
            several = TOTALS.get(element) if cells[i].endswith(GATHERED) else None
            if several and value is not None:
                days.enter(day, number, several[0], value, where)
                days.enter(day, number, several[1], 1 + parts[element], where)
            else:
                days.enter(day, number, element, value, where)
            parts[element] = parts[element] + 1 if cell == PART else 0
    rows, notes = days.rows()
    title = lines[0].strip().strip('"') if start else ""
    notes.append("temperatures in °F, depths in inches")
    titles: dict[str, list[str]] = {}
    for i, (_, quantity) in columns.items():
        titles.setdefault(quantity.name, []).append(head[i])
    named = {name: " and ".join(own) for name, own in titles.items()}
    return Station("ACIS", title, rows, notes, columns=named)


def _is_head(line: str) -> bool:
    return tuple(re.sub('[" ]', "", line).split(",")) == BY_STATION_HEAD


def same_station(own: str, station: str, where: str) -> None:
    """Raise InputError if a row is of another station than the rows before."""
    if own != station:
        raise InputError(
            f"{where}: {quoted(own)} is another station than {quoted(station)}; a file has the "
            "data of one"
        )


def _acis_head(lines: Sequence[str]) -> tuple[int, str] | None:
    """Return the line, from 0, that names ACIS columns, and their separator."""
    for number, line in enumerate(lines[:3]):
        for separator in (",", "\t", ";"):
            keys = [_key(cell) for cell in line.split(separator)]
            if keys[0] == "date" and len([key for key in keys if key in ACIS]) >= 2:
                return number, separator
    return None


def _is_bare_acis(lines: Sequence[str]) -> bool:
    """Return whether a file is an answer of the service: a station's name, then rows."""
    bare = len(lines) > 1 and BARE_TITLE.fullmatch(lines[0]) and BARE_ROW.fullmatch(lines[1])
    return bool(bare)


def _key(text: str) -> str:
    return re.sub(r"[^a-z]", "", text.lower())
