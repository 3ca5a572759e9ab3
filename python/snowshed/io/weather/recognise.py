"""Which format a weather file has, told by its content."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple, Optional

from snowshed._core import InputError
from snowshed.io.input_file import LARGEST, read_input
from snowshed.io.weather import american, energy, smet, swiss
from snowshed.io.weather.observation import Station


class Format(NamedTuple):
    """How a format is recognised by its lines, and read."""

    recognises: Callable[[Sequence[str]], bool]
    read: Callable[[str, Sequence[str]], Station]


FORMATS: Mapping[str, Format] = {
    "SMET": Format(smet.is_smet, smet.read_smet),
    "iCSV": Format(smet.is_icsv, smet.read_icsv),
    "EPW": Format(energy.is_epw, energy.read_epw),
    "TMY3": Format(energy.is_tmy3, energy.read_tmy3),
    "GHCN-daily, fixed width": Format(american.is_dly, american.read_dly),
    "GHCN-daily, by station": Format(american.is_by_station, american.read_by_station),
    "ACIS": Format(american.is_acis, american.read_acis),
    "MeteoSwiss": Format(swiss.is_meteoswiss, swiss.read_meteoswiss),
    "IMIS": Format(swiss.is_imis, swiss.read_imis),
}


def read_station(path: Path) -> Optional[Station]:
    """Return the observations of a weather file; None if its format is none of `FORMATS`.

    Raises
    ------
    InputError
        Naming the file, the line and the column.
    OSError
        If it cannot be read.
    """
    content = read_input(path, LARGEST)
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = content.decode("latin-1")  # names of places in EPW and MeteoSwiss files
    lines = text.splitlines()
    form = next((one for one in FORMATS.values() if one.recognises(lines)), None)
    if form is None:
        return None
    station = form.read(str(path), lines)
    if not station.rows:
        raise InputError(f"{path}: no rows below the header of this {station.format} file")
    return station
