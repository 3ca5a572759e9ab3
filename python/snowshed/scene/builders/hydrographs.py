"""Hydrographs of slides: tables of times, thicknesses and speeds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from snowshed._core import InputError
from snowshed.base.formatting import number_in
from snowshed.base.messages import quoted
from snowshed.io.csv_table import TableRow, read_text_table
from snowshed.scene.terrain_components import Pulse

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
    table = read_text_table(file, f"needed: columns {', '.join(COLUMNS)}", _check_columns)
    rows = [row for row in table.rows if any(row.cells.values())]
    if not 1 <= len(rows) <= MAX_PULSES:
        raise InputError(f"{file}: {len(rows)} rows; allowed: 1 to {MAX_PULSES}")
    pulses = [_pulse(row) for row in rows]
    pulses.sort(key=lambda pulse: pulse.time or 0.0)
    times = [pulse.time for pulse in pulses]
    if len(set(times)) < len(times):
        raise InputError(f"{file}: a time occurs twice")
    return pulses


def _check_columns(names: Sequence[str], where: str) -> None:
    plain = [name.lower() for name in names]
    for column in COLUMNS:
        if plain.count(column) != 1:
            raise InputError(
                f"{where}: needs one column {column}; allowed: {', '.join(COLUMNS)}, with commas "
                "between them"
            )


def _pulse(row: TableRow) -> Pulse:
    cells = {name.lower(): text for name, text in row.cells.items()}
    values = {}
    for column, field in COLUMNS.items():
        text = cells[column]
        value = number_in(text) if text else 0.0  # AvaFrame takes blank cells as 0
        least = "above 0" if field == "thickness" else "at least 0"
        if not math.isfinite(value) or value < 0.0 or (field == "thickness" and value == 0.0):
            raise InputError(f"{row.where}: {column} {quoted(text)}; allowed: {least}")
        values[field] = value
    return Pulse(**values)
