"""The printed table of winters: days with observed snow, sources, gaps."""

from __future__ import annotations

from snowshed.cli.output.terminal import PlainConsole, plain_table
from snowshed.season.weather.quality_table import ALIGN, HEAD, console_rows, quality_rows, title
from snowshed.season.weather.season_record import WinterList


def print_quality(console: PlainConsole, winters: WinterList, *, judged: bool = True) -> None:
    """Print a row for each winter: days with observed snow, source, filled days.

    Parameters
    ----------
    console
        The console to print to.
    winters
        The winters of the file.
    judged
        Whether to print which winters count.
    """
    rows, left_out = console_rows(quality_rows(winters))
    columns = range(len(HEAD) if judged else len(HEAD) - 1)
    used = [column for column in columns if any(row[column] for row in rows)]
    table = plain_table(title(winters))
    for column in used:
        table.add_column(HEAD[column], justify="left" if ALIGN[column] == "l" else "right")
    for row in rows:
        table.add_row(*(row[column] for column in used))
    console.print(table)
    if left_out:
        console.print(f"{left_out} more winters are in the page and in clearance.json")
