"""The output of ``snowshed season``."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from snowshed.cli.display.winters import print_quality
from snowshed.cli.terminal import plain_table, wide_console
from snowshed.season.driver import SeasonResult, verdict

SEASON_TABLE = {
    "date": ("date", "{}"),
    "event": ("event", "{}"),
    "released": ("released", "{}"),
    "snowfall\nm": ("snowfall_m", "{:.2f}"),
    "density\nkg/m3": ("density_kg_m3", "{:.0f}"),
    "on panel\nm": ("panel_snow_m", "{:.3f}"),
    "pull\nPa": ("driving_pa", "{:.0f}"),
    "hold\nPa": ("resisting_pa", "{:.0f}"),
    "stack\nheight, m": ("stack_height_m", "{:.2f}"),
    "stack\nlength, m": ("stack_length_m", "{:.2f}"),
    "cover\nm": ("cover_m", "{:.2f}"),
    "clearance\nm": ("clearance_m", "{:.2f}"),
    "to crest\nm": ("crest_clearance_m", "{:.2f}"),
}
MOST_ROWS = 60  # of the table that is shown whole
SETTLED = {"settled\nheight, m": ("settled_height_m", "{:.2f}")}


def print_season(result: SeasonResult, folder: Path) -> None:
    """Print the table, the event that buries the panel, and notes on their limits."""
    console = wide_console(120)
    columns = dict(SEASON_TABLE)
    if (result.table["settled_height_m"] < result.table["stack_height_m"]).any():
        columns.update(SETTLED)
    shown = plain_table("Season", columns, padding=0)
    rows, left_out = _rows(result)
    for row in rows:
        shown.add_row(*(_cell(row[name], form) for name, form in columns.values()))
    if rows:
        console.print(shown)
    if left_out:
        console.print(f"{left_out} rows without a release are in season.csv")
    print_quality(console, result.winters, judged=False)
    for line in (verdict(result), *(f"note: {note}" for note in result.notes)):
        console.print(line)
    console.print(f"season.csv and season.png in {folder}")
    if result.simulated:
        console.print(f"the snow in motion: snowshed view {folder}")


def _rows(result: SeasonResult) -> tuple[list[dict[str, Any]], int]:
    """Return the rows to show, and how many are left out: of many, those without a release."""
    table = result.table
    if len(table) > MOST_ROWS:
        table = table[table["released"] == "yes"].head(MOST_ROWS)
    rows = [{str(name): value for name, value in row.items()} for row in table.to_dict("records")]
    return rows, len(result.table) - len(table)


def _cell(value: Any, form: str) -> str:
    missing = not isinstance(value, str) and (value is None or not math.isfinite(_number(value)))
    return "" if missing else form.format(value)


def _number(value: Any) -> float:
    try:
        return float(value)
    except TypeError:  # pandas' mark for a missing integer
        return math.nan
