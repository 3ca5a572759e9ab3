"""What all commands show alike: one progress bar, and tables that are whole without a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.progress import (
    BarColumn,
    Progress,
    ProgressColumn,
    TaskProgressColumn,
    TextColumn,
    TimeRemainingColumn,
)
from rich.table import Table


class OneBar:
    """A progress bar on stderr that appears with the first report, so that errors stand alone.

    Attributes
    ----------
    console
        Where it is shown.
    """

    def __init__(self, bar: Progress, fields: dict[str, Any]) -> None:
        self.console = bar.console
        self._bar = bar
        self._task = bar.add_task("starting", total=1.0, **fields)

    @property
    def started(self) -> bool:
        """Whether it has appeared."""
        return self._bar.live.is_started

    def show(self, fraction: float, what: str, **fields: Any) -> None:
        """Show the part that is done, 0 to 1, and what is being done now."""
        self._bar.start()
        self._bar.update(self._task, completed=fraction, description=what, **fields)


@contextmanager
def one_bar(
    *after: ProgressColumn,
    width: int = 40,
    speed_period_s: float = 30.0,
    transient: bool = False,
    **fields: str,
) -> Iterator[OneBar]:
    """Yield a progress bar, which ends with the block.

    Parameters
    ----------
    *after
        Columns after the percentage.  [default: the time that is left]
    width
        Of the bar, in characters.
    speed_period_s
        Over how many seconds the speed is averaged that says what time is left.
    transient
        Whether the bar vanishes at the end.
    **fields
        First values of the fields that columns show besides.
    """
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(bar_width=width),
        TaskProgressColumn(),
        *(after or (TimeRemainingColumn(),)),
    )
    console = Console(stderr=True, highlight=False)
    bar = Progress(
        *columns, console=console, speed_estimate_period=speed_period_s, transient=transient
    )
    shown = OneBar(bar, fields)
    try:
        yield shown
    finally:
        if shown.started:  # else stopping it would print an empty line
            bar.stop()


def wide_console(width: int = 100) -> Console:
    """Return a console for stdout; what is no terminal gets `width` columns, not rich's 80."""
    console = Console(highlight=False)
    console.width = console.width if console.is_terminal else width
    return console


def plain_table(title: str, headings: Iterable[str] = (), **options: Any) -> Table:
    """Return a table with a line below its head.

    Parameters
    ----------
    title
        Above it, at the left; may be empty.
    headings
        Columns of numbers; all others are added to the table.
    **options
        As of `rich.table.Table`.
    """
    table = Table(title=title or None, title_justify="left", box=SIMPLE_HEAD, **options)
    for heading in headings:
        table.add_column(heading, justify="right", no_wrap=True)
    return table
