"""Output of ``python -m validation``: the progress display, and the results of the criteria."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import Optional

from snowshed.base.progress import Reporter
from snowshed.cli.output.progress import progress_bar
from snowshed.cli.output.terminal import plain_table, wide_console
from validation.framework import sections
from validation.framework.case import Case
from validation.framework.criteria import Criterion

STYLES = {"holds": "none", "does not hold": "bold red", "not measured": "dim"}


def validation_bar(*, quiet: bool) -> AbstractContextManager[Optional[Reporter]]:
    """Show a progress display on stderr, which is cleared at the end."""
    return progress_bar(quiet=quiet, width=24, transient=True)


def print_criteria(criteria: Sequence[Criterion], cases: Sequence[Case]) -> None:
    """Print the criteria and their results, if there are any."""
    grid = sections.criteria_grid(criteria, cases)
    if not grid.rows:
        return
    table = plain_table("What holds", padding=(0, 1, 0, 0))
    for title, align in zip(grid.head, grid.align):
        table.add_column(title, justify="right" if align == "r" else "left")
    for row in grid.rows:
        table.add_row(*row, style=STYLES[row[0]])
    wide_console(160).print(table)
