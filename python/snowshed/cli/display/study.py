"""The output of the commands of studies: expected times, and status."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import snowshed._core as _core
from snowshed.base.formatting import about
from snowshed.base.progress import Progress
from snowshed.cli.terminal import PlainConsole
from snowshed.study.owner import is_alive
from snowshed.study.store import Store, StoredRun


def announcement(progress: Progress) -> str:
    """Return the announcement before the first run starts."""
    left = progress.count - progress.done - progress.failed
    earlier = f" ({progress.count - left} of {progress.count} are there already)"
    slow = _core.slow_kernels_note()
    return (
        f"{_runs(left)} to compute{earlier if left < progress.count else ''}, "
        f"{progress.at_once} at once; expected time: {about(progress.expected_s or 0.0)}"
        + (f"\nnote: {slow}" if slow else "")
    )


def print_status(store: Store) -> None:
    """Print the status of the runs, study by study."""
    console = PlainConsole(soft_wrap=True)
    for name in store.studies():
        runs = store.runs(name)
        console.print(f"{name}: {_runs(len(runs))}", style="bold")
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


def print_failures(runs: Sequence[StoredRun], console: PlainConsole) -> None:
    """Print the runs that failed, with their errors."""
    for run in runs:
        if run.status == "failed":
            console.print(f"  {run.hash[:12]} failed: {run.error}")


def _runs(count: int) -> str:
    return f"{count} run{'' if count == 1 else 's'}"
