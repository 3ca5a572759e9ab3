"""Which format a weather file has, told by its content."""

from __future__ import annotations

import re
import zlib
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple, Optional

from snowshed._core import InputError
from snowshed.io.input_file import read_input
from snowshed.io.limits import MB, TEXT
from snowshed.io.weather import american, energy, ncei, smet, swiss
from snowshed.io.weather.observation import Station

GZIP, ZIP = b"\x1f\x8b", b"PK\x03\x04"


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
    "GHCN-daily, summaries": Format(ncei.is_summaries, ncei.read_summaries),
    "ACIS": Format(american.is_acis, american.read_acis),
    "MeteoSwiss": Format(swiss.is_meteoswiss, swiss.read_meteoswiss),
    "IMIS": Format(swiss.is_imis, swiss.read_imis),
}


def read_station(path: Path) -> Optional[Station]:
    """Return the observations of a weather file; None if its format is none of `FORMATS`.

    A file packed with gzip, as GHCN-daily is published, is read like the file inside.

    Raises
    ------
    InputError
        Naming the file, the line and the column.
    OSError
        If it cannot be read.
    """
    lines = re.split("\r\n|\n|\r", _text(_unpacked(read_input(path, TEXT), path)).rstrip("\r\n"))
    form = next((one for one in FORMATS.values() if one.recognises(lines)), None)
    if form is None:
        return None
    station = form.read(str(path), lines)
    if not station.rows:
        raise InputError(f"{path}: no rows below the header of this {station.format} file")
    return station


def _text(content: bytes) -> str:
    for encoding in ("utf-8-sig", "cp1252"):  # names of places in EPW and MeteoSwiss files
        try:
            return content.decode(encoding)
        except UnicodeDecodeError:
            continue
    return content.decode("latin-1")


def _unpacked(content: bytes, path: Path) -> bytes:
    if content.startswith(ZIP):
        raise InputError(f"{path}: a zip archive; unpack it and give the file of the weather")
    if not content.startswith(GZIP):
        return content
    unpacked = b""
    while content:  # members one after another
        member = zlib.decompressobj(16 + zlib.MAX_WBITS)
        try:
            unpacked += member.decompress(content, TEXT + 1 - len(unpacked))
        except zlib.error as error:
            raise InputError(f"{path}: damaged: gzip: {error}") from None
        if len(unpacked) > TEXT:
            raise InputError(f"{path}: longer than {TEXT // MB} MB when unpacked")
        if not member.eof:
            raise InputError(f"{path}: damaged: gzip: it ends too early")
        content = member.unused_data.lstrip(b"\0")
    return unpacked
