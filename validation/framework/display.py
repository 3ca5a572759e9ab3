"""The output of ``python -m validation``: the progress bar, and which bars hold."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import Optional

from snowshed.base.progress import Reporter
from snowshed.cli.progress import progress_bar
from snowshed.cli.terminal import plain_table, wide_console
from validation.framework import sections
from validation.framework.bars import Bar as Demand
from validation.framework.case import Case

STYLES = {"holds": "none", "does not hold": "bold red", "not measured": "dim"}


def validation_bar(*, quiet: bool) -> AbstractContextManager[Optional[Reporter]]:
    """Show one bar on stderr, which vanishes at the end."""
    return progress_bar(quiet=quiet, width=24, transient=True)


def print_bars(bars: Sequence[Demand], cases: Sequence[Case]) -> None:
    """Print the demands and their results, if there are any."""
    grid = sections.bars_grid(bars, cases)
    if not grid.rows:
        return
    table = plain_table("What holds", padding=(0, 1, 0, 0))
    for title, align in zip(grid.head, grid.align):
        table.add_column(title, justify="right" if align == "r" else "left")
    for row in grid.rows:
        table.add_row(*row, style=STYLES[row[0]])
    wide_console(160).print(table)
