"""One progress bar for all commands, on stderr."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Optional

from rich.progress import (
    BarColumn,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)
from rich.progress import Progress as Bar

from snowshed.base.formatting import duration
from snowshed.base.progress import Progress, Reporter
from snowshed.cli.output.terminal import PlainConsole

#: Time over which the speed is averaged, from which the remaining time follows, s.
SPEED_PERIOD_S = 30.0
LONG_PERIOD_S = 3600.0  # for long units, so that the remaining time does not jump when a unit ends

Announcement = Callable[[Progress], str]


@contextmanager
def progress_bar(
    *,
    quiet: bool = False,
    announce: Optional[Announcement] = None,
    speed_period_s: float = SPEED_PERIOD_S,
    width: int = 40,
    transient: bool = False,
) -> Iterator[Optional[Reporter]]:
    """Yield a function that shows a `Progress` as a bar; the bar ends with the block.

    The bar appears with the first report, so that earlier errors stand alone. It shows the
    remaining time from the report, or from the speed so far.

    Parameters
    ----------
    quiet
        Whether to show nothing; then None is yielded.
    announce
        Function that gets the first report and returns a line to print before the bar.
    speed_period_s
        Time over which this speed is averaged, s.
    width
        Width of the bar in characters.
    transient
        Whether the bar disappears at the end.
    """
    if quiet:
        yield None
        return
    bar: Optional[Bar] = None
    console = PlainConsole(stderr=True)

    def report(progress: Progress) -> None:
        nonlocal bar
        has_estimate = progress.left_s is not None
        if bar is None:
            if announce is not None:
                console.print(announce(progress))
            bar = Bar(
                TextColumn("{task.description}"),
                BarColumn(bar_width=width),
                TaskProgressColumn(),
                TimeElapsedColumn() if has_estimate else TimeRemainingColumn(),
                TextColumn("{task.fields[note]}"),
                console=console,
                speed_estimate_period=speed_period_s,
                transient=transient,
            )
            bar.add_task("", total=1.0, note="")
            bar.start()
        bar.update(
            bar.task_ids[0],
            completed=progress.fraction,
            description=progress.description,
            note=_note(progress),
        )

    try:
        yield report
    finally:
        if bar is not None:
            bar.stop()


def _note(progress: Progress) -> str:
    """Return the speed or the time left, if the report has them."""
    if progress.updates_per_s:
        return f"{progress.updates_per_s / 1e6:.1f} M updates/s"
    return "" if progress.left_s is None else f"{duration(progress.left_s)} left"
