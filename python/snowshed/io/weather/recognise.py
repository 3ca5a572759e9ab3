"""The format of a weather file, recognised by its content."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple, Optional

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.limits import KB, MAX_WEATHER_LINE_BYTES, MAX_WEATHER_LINES
from snowshed.io.input_file import is_utf16, read_input
from snowshed.io.packed import unpacked
from snowshed.io.weather import american, energy, ncei, smet, swiss
from snowshed.io.weather.clock import on_one_clock
from snowshed.io.weather.gathering import with_hours
from snowshed.io.weather.observation import Station
from snowshed.io.weather.plausible import with_plausible_units


class Format(NamedTuple):
    """A format, with the functions that recognise and read its lines.

    Attributes
    ----------
    recognises, read
        Called with the lines.
    logged
        Whether rows are readings of a logger: amounts may overlap, or come from a counter.
    """

    recognises: Callable[[Sequence[str]], bool]
    read: Callable[[str, Sequence[str]], Station]
    logged: bool = False


FORMATS: Mapping[str, Format] = {
    "SMET": Format(smet.is_smet, smet.read_smet, logged=True),
    "iCSV": Format(smet.is_icsv, smet.read_icsv, logged=True),
    "EPW": Format(energy.is_epw, energy.read_epw),
    "TMY3": Format(energy.is_tmy3, energy.read_tmy3),
    "GHCN-daily, fixed width": Format(american.is_dly, american.read_dly),
    "GHCN-daily, by station": Format(american.is_by_station, american.read_by_station),
    "GHCN-daily, summaries": Format(ncei.is_summaries, ncei.read_summaries),
    "ACIS": Format(american.is_acis, american.read_acis),
    "MeteoSwiss": Format(swiss.is_meteoswiss, swiss.read_meteoswiss, logged=True),
    "IMIS": Format(swiss.is_imis, swiss.read_imis, logged=True),
}


@checked
def read_station(path: Path) -> Optional[Station]:
    """Return the observations of a weather file; None if it matches none of `FORMATS`.

    Files packed with gzip or xz, such as those of GHCN-daily, are unpacked. The times of the
    observations are on one clock, their amounts do not overlap, and their units are plausible.

    Raises
    ------
    InputError
        Naming the file, the line and the column.
    OSError
        If it cannot be read.
    """
    lines = _lines(unpacked(read_input(path), path), path)
    form = next((candidate for candidate in FORMATS.values() if candidate.recognises(lines)), None)
    if form is None:
        if lines[0].lstrip().startswith("{"):
            raise InputError(
                f"{path}: JSON; the weather of a station is read from tables, such as the CSV "
                "that the same services give"
            )
        return None
    station = form.read(str(path), lines)
    if not station.rows:
        raise InputError(f"{path}: no rows below the header of this {station.format} file")
    station = on_one_clock(station, str(path))
    if form.logged:
        station = with_hours(station)
    present = station.quantities
    columns = {name: title for name, title in station.columns.items() if name in present}
    return with_plausible_units(replace(station, columns=columns), str(path))


def _lines(content: bytes, path: Path) -> list[str]:
    """Return the lines of a text; raises InputError for binary or too long files."""
    if is_utf16(content):
        raise InputError(f"{path}: text in UTF-16; save it in UTF-8")
    if b"\0" in content:
        line = content[: content.index(b"\0")].count(b"\n") + 1
        raise InputError(f"{path}, line {line}: not text: it contains NUL bytes")
    if max(content.count(b"\n"), content.count(b"\r")) > MAX_WEATHER_LINES:
        raise InputError(f"{path}: more than {MAX_WEATHER_LINES} lines; cut it into parts")
    lines = re.split("\r\n|\n|\r", _decoded(content).rstrip("\r\n"))
    longest = max(range(len(lines)), key=lambda i: len(lines[i]))
    if len(lines[longest]) > MAX_WEATHER_LINE_BYTES:
        raise InputError(
            f"{path}, line {longest + 1}: longer than {MAX_WEATHER_LINE_BYTES // KB} KB"
        )
    return lines


def _decoded(content: bytes) -> str:
    for encoding in ("utf-8-sig", "cp1252"):  # names of places in EPW and MeteoSwiss files
        try:
            return content.decode(encoding)
        except UnicodeDecodeError:
            continue
    return content.decode("latin-1")
