"""What ``snowshed verify`` shows: the progress bar, and which bars hold."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeElapsedColumn
from rich.progress import Progress as Bar
from rich.table import Table

from snowshed.verify import sections, wording
from snowshed.verify.analysis import Bar as Demand
from snowshed.verify.case import Case
from snowshed.verify.runner import Progress, Reporter

STYLES = {"holds": "none", "does not hold": "bold red", "not measured": "dim"}


@contextmanager
def progress_bar() -> Iterator[Callable[[float, str, str], None]]:
    """Show one bar on stderr; what it yields takes the part that is done, 0 to 1, and two texts."""
    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(bar_width=24),
        TaskProgressColumn(),
        TextColumn("{task.fields[left]}"),
        TimeElapsedColumn(),
    )
    bar = Bar(*columns, console=Console(stderr=True), transient=True)
    task = bar.add_task("starting", total=1.0, left="")

    def show(fraction: float, what: str, left: str) -> None:
        bar.start()
        bar.update(task, completed=fraction, description=what, left=left)

    try:
        yield show
    finally:
        if bar.live.is_started:  # else stopping it would print an empty line
            bar.stop()


@contextmanager
def suite_progress() -> Iterator[Reporter]:
    """Show what is being measured, and how long the rest will take."""
    with progress_bar() as show:

        def report(progress: Progress) -> None:
            what = wording.settings(progress.task.settings)
            done = f"{progress.done + 1}/{progress.count}"
            left = "" if progress.left_s is None else f"{wording.duration(progress.left_s)} left"
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
    table = Table(title="What holds", title_justify="left", box=SIMPLE_HEAD, padding=(0, 1, 0, 0))
    for title, align in zip(grid.head, grid.align):
        table.add_column(title, justify="right" if align == "r" else "left")
    for row in grid.rows:
        table.add_row(*row, style=STYLES[row[0]])
    console = Console()
    console.width = console.width if console.is_terminal else 160
    console.print(table)
