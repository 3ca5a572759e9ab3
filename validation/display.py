"""The output of ``python -m validation``: the progress bar, and which bars hold."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from rich.progress import TextColumn, TimeElapsedColumn

from snowshed.analysis.verification import wording
from snowshed.cli.terminal import one_bar, plain_table, wide_console
from snowshed.io import formatting
from validation import sections
from validation.bars import Bar as Demand
from validation.case import Case
from validation.runner import Progress, Reporter

STYLES = {"holds": "none", "does not hold": "bold red", "not measured": "dim"}


@contextmanager
def progress_bar() -> Iterator[Callable[[float, str, str], None]]:
    """Show one bar on stderr; what it yields takes the part that is done, 0 to 1, and two texts."""
    columns = (TextColumn("{task.fields[left]}"), TimeElapsedColumn())
    with one_bar(*columns, width=24, transient=True, left="") as bar:
        yield lambda fraction, what, left: bar.show(fraction, what, left=left)


@contextmanager
def suite_progress() -> Iterator[Reporter]:
    """Show what is being measured, and how long the rest will take."""
    with progress_bar() as show:

        def report(progress: Progress) -> None:
            what = wording.settings(progress.task.settings)
            done = f"{progress.done + 1}/{progress.count}"
            left = "" if progress.left_s is None else f"{formatting.duration(progress.left_s)} left"
            show(progress.fraction, f"{done} {progress.task.case.name}: {what}"[:70], left)

        yield report


@contextmanager
def stress_progress() -> Iterator[Callable[[int, int, int], None]]:
    """Show how many runs of the stress suite are done, and how many of them failed."""
    with progress_bar() as show:

        def report(done: int, count: int, failed: int) -> None:
            wrong = f"{failed} failed" if failed else ""
            show(done / count if count else 1.0, f"stress suite, {done}/{count} runs", wrong)

        yield report


def print_bars(bars: Sequence[Demand], cases: Sequence[Case]) -> None:
    """Print what was demanded and what was found, if anything was."""
    grid = sections.bars_grid(bars, cases)
    if not grid.rows:
        return
    table = plain_table("What holds", padding=(0, 1, 0, 0))
    for title, align in zip(grid.head, grid.align):
        table.add_column(title, justify="right" if align == "r" else "left")
    for row in grid.rows:
        table.add_row(*row, style=STYLES[row[0]])
    wide_console(160).print(table)
