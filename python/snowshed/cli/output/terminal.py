"""The output of commands: plain texts, and tables that are cut only on a terminal."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Iterable, Sequence
from typing import Any

import click
from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from snowshed.base.messages import printable


class PlainConsole(Console):
    """A console that takes texts neither as markup nor as commands to the terminal."""

    def __init__(self, **options: Any) -> None:
        super().__init__(highlight=False, markup=False, **options)

    def on_broken_pipe(self) -> None:
        """Raise the error that ends the command line."""
        raise BrokenPipeError(errno.EPIPE, os.strerror(errno.EPIPE))

    def render_str(self, text: str, **options: Any) -> Text:
        """Return a text without harmful characters."""
        return super().render_str(printable(text), **options)

    def note(self, text: str) -> None:
        """Print a highlighted note."""
        self.print(Text.assemble(("note:", "bold yellow"), f" {printable(text)}"))


def say(text: object, *, err: bool = False) -> None:
    """Print a line of text."""
    click.echo(printable(text), err=err)


def write_out(text: str) -> None:
    """Print data: unchanged to a file or a pipe, made printable to a terminal."""
    click.echo(printable(text) if sys.stdout.isatty() else text, nl=not text.endswith("\n"))


def wide_console(width: int = 100) -> PlainConsole:
    """Return a console for stdout, with `width` columns if it is not a terminal."""
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
        Options of `rich.table.Table`.
    """
    table = Table(title=title or None, title_justify="left", box=SIMPLE_HEAD, **options)
    for heading in headings:
        table.add_column(heading, justify="right", no_wrap=True)
    return table


def narrow_table(title: str, headings: Sequence[str]) -> Table:
    """Return a table whose columns stand close together: a name, then numbers.

    Parameters
    ----------
    title
        Title above the table, at the left; may be empty.
    headings
        Heads of the columns; the first is that of the names.
    """
    first, *numbers = headings
    table = plain_table(title, padding=(0, 1))
    table.add_column(first, no_wrap=True)
    for heading in numbers:
        table.add_column(heading, justify="right", no_wrap=True)
    return table
