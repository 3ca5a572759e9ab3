"""What the commands of studies show: forecast, progress bar, status."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from rich.console import Console

from snowshed.cli.terminal import one_bar
from snowshed.study.owner import is_alive
from snowshed.study.session import Reporter, StudyProgress
from snowshed.study.store import Store, StoredRun

#: Up to how many seconds a duration is told in which unit, of how many seconds, to what digit.
UNITS = (
    (100, 1, "s", 0),
    (6000, 60, "min", 1),
    (172800, 3600, "h", 1),
    (math.inf, 86400, "days", 1),
)
SPEED_PERIOD_S = 3600.0  # runs may take long, and the time left should not jump when one ends


def in_words(seconds: float) -> str:
    """Return an estimated duration for people.

    Examples
    --------
    >>> [in_words(t) for t in (0.4, 42.3, 200, 8000)]
    ['under 1 s', 'about 42 s', 'about 3.3 min', 'about 2.2 h']
    """
    if seconds < 1:
        return "under 1 s"
    unit, name, digits = next(
        (unit, name, digits) for limit, unit, name, digits in UNITS if seconds < limit
    )
    return f"about {seconds / unit:.{digits}f} {name}"


@contextmanager
def progress_bar() -> Iterator[Reporter]:
    """Say what will be computed and how long that should take; then show one bar, on stderr."""
    with one_bar(speed_period_s=SPEED_PERIOD_S) as bar:

        def report(progress: StudyProgress) -> None:
            if not bar.started:
                bar.console.print(announcement(progress))
            bar.show(progress.fraction, description(progress))

        yield report


def announcement(progress: StudyProgress) -> str:
    """Return what is said before the first run starts."""
    left = progress.runs - progress.done - progress.failed
    earlier = f" ({progress.runs - left} of {progress.runs} are there already)"
    return (
        f"{_runs(left)} to compute{earlier if left < progress.runs else ''}, "
        f"{progress.at_once} at once; expected time: {in_words(progress.expected_s)}"
    )


def description(progress: StudyProgress) -> str:
    """Return the text beside the bar."""
    parts = [f"{progress.done}/{progress.runs} runs"]
    parts += [f"{progress.failed} failed"] if progress.failed else []
    parts += [f"{progress.running} running"] if progress.running else []
    parts += [f"{progress.elsewhere} in other processes"] if progress.elsewhere else []
    return ", ".join(parts)


def print_status(store: Store) -> None:
    """Print what is done and what is not, study by study."""
    console = Console(highlight=False, soft_wrap=True)
    for name in store.studies():
        runs = store.runs(name)
        console.print(f"{name}: {_runs(len(runs))}", style="bold", markup=False)
        alive = {run.owner for run in runs if run.owner and is_alive(store, run.owner)}
        kinds = Counter("running" if run.owner in alive else run.status for run in runs)
        for status, meaning in (
            ("done", "done"),
            ("failed", "failed"),
            ("running", "being computed now"),
            ("pending", "to compute"),
        ):
            if kinds[status] or status == "done":
                console.print(f"  {kinds[status]:6} {meaning}")
        print_failures(runs, console)


def print_failures(runs: Sequence[StoredRun], console: Console) -> None:
    """Print the runs that failed, with their errors."""
    for run in runs:
        if run.status == "failed":
            console.print(f"  {run.hash[:12]} failed: {run.error}", markup=False)


def _runs(count: int) -> str:
    return f"{count} run{'' if count == 1 else 's'}"
