"""Tables that stay whole without a terminal."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table


def wide_console(width: int = 100) -> Console:
    """Return a console for stdout; without a terminal it has `width` columns, not rich's 80."""
    console = Console(highlight=False)
    console.width = console.width if console.is_terminal else width
    return console


def plain_table(title: str, headings: Iterable[str] = (), **options: Any) -> Table:
    """Return a table with a line below its head.

    Parameters
    ----------
    title
        Title above the table, at the left; may be empty.
    headings
        Heads of columns of numbers; other columns are added to the table.
    **options
        As of `rich.table.Table`.
    """
    table = Table(title=title or None, title_justify="left", box=SIMPLE_HEAD, **options)
    for heading in headings:
        table.add_column(heading, justify="right", no_wrap=True)
    return table
