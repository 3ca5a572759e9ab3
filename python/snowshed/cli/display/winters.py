"""How well the snow of winters is known, as commands print it."""

from __future__ import annotations

from snowshed.cli.terminal import PlainConsole, plain_table
from snowshed.season.quality_table import ALIGN, HEAD, quality_rows, shortened, title
from snowshed.season.record import WinterList


def print_quality(console: PlainConsole, winters: WinterList, *, judged: bool = True) -> None:
    """Print a row for each winter: days on which its snow was observed, source, what was filled.

    Parameters
    ----------
    console
        Where to.
    winters
        Of the file.
    judged
        Whether to say which of them count.
    """
    rows, left_out = shortened(quality_rows(winters))
    columns = range(len(HEAD) if judged else len(HEAD) - 1)
    used = [place for place in columns if any(row[place] for row in rows)]
    table = plain_table(title(winters))
    for place in used:
        table.add_column(HEAD[place], justify="left" if ALIGN[place] == "l" else "right")
    for row in rows:
        table.add_row(*(row[place] for place in used))
    console.print(table)
    if left_out:
        console.print(f"{left_out} more winters are in the page and in clearance.json")
