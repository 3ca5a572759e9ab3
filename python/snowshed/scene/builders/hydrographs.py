"""Hydrographs of slides: tables of times, thicknesses and speeds."""

from __future__ import annotations

import csv
import math
from pathlib import Path

from snowshed._core import InputError
from snowshed.base.formatting import number_in
from snowshed.base.messages import quoted
from snowshed.io.input_file import read_input
from snowshed.scene.terrain_components import Pulse

MAX_HYDROGRAPH_BYTES = 1_000_000
MAX_PULSES = 1000
#: Columns, and the fields of a pulse that they hold; the names are AvaFrame's.
COLUMNS = {"timestep": "time", "thickness": "thickness", "velocity": "speed"}


def read_hydrograph(file: Path) -> list[Pulse]:
    """Return the pulses of a table with the columns timestep [s], thickness [m], velocity [m/s].

    Raises
    ------
    InputError
        If the file is not such a table, or a time occurs twice.
    OSError
        If it cannot be read.
    """
    try:
        text = read_input(file, MAX_HYDROGRAPH_BYTES).decode("utf-8-sig")
        rows = [row for row in csv.reader(text.splitlines()) if any(cell.strip() for cell in row)]
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{file}: not a table: {error}") from None
    names = [cell.strip().lower() for cell in rows[0]] if rows else []
    for column in COLUMNS:
        if names.count(column) != 1:
            raise InputError(
                f"{file}: needs one column {column}; allowed: {', '.join(COLUMNS)}, with commas "
                "between them"
            )
    if not 1 <= len(rows) - 1 <= MAX_PULSES:
        raise InputError(f"{file}: {len(rows) - 1} rows; allowed: 1 to {MAX_PULSES}")
    pulses = [_pulse(names, row, f"{file}, row {number}") for number, row in enumerate(rows[1:], 2)]
    pulses.sort(key=lambda pulse: pulse.time or 0.0)
    times = [pulse.time for pulse in pulses]
    if len(set(times)) < len(times):
        raise InputError(f"{file}: a time occurs twice")
    return pulses


def _pulse(names: list[str], row: list[str], where: str) -> Pulse:
    values = {}
    for column, field in COLUMNS.items():
        index = names.index(column)
        text = row[index].strip() if index < len(row) else ""
        value = number_in(text) if text else 0.0  # AvaFrame takes blank cells as 0
        least = "above 0" if field == "thickness" else "at least 0"
        if not math.isfinite(value) or value < 0.0 or (field == "thickness" and value == 0.0):
            raise InputError(f"{where}: {column} {quoted(text)}; allowed: {least}")
        values[field] = value
    return Pulse(**values)
