"""What the commands print: texts as they are, and tables that stay whole without a terminal."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Iterable
from typing import Any

import click
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from snowshed.base.messages import printable


class PlainConsole(Console):
    """A console on which no text is markup or a command to the terminal, wherever it comes from."""

    def __init__(self, **options: Any) -> None:
        super().__init__(highlight=False, markup=False, **options)

    def on_broken_pipe(self) -> None:
        """Let the command line end, as it does for all that it prints."""
        raise BrokenPipeError(errno.EPIPE, os.strerror(errno.EPIPE))

    def render_str(self, text: str, **options: Any) -> Text:
        """Return a text as it is shown."""
        return super().render_str(printable(text), **options)

    def note(self, text: str) -> None:
        """Print a note, which stands out."""
        self.print(Text.assemble(("note:", "bold yellow"), f" {printable(text)}"))


def say(text: object, *, err: bool = False) -> None:
    """Print a line of text."""
    click.echo(printable(text), err=err)


def write_out(text: str) -> None:
    """Print data: to a file or a pipe exactly as they are, to a terminal as it may show them."""
    click.echo(printable(text) if sys.stdout.isatty() else text, nl=not text.endswith("\n"))


def wide_console(width: int = 100) -> PlainConsole:
    """Return a console for stdout; without a terminal it has `width` columns, not rich's 80."""
    console = PlainConsole()
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
