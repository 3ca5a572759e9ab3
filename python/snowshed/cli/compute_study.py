"""Computing a study on the command line: cost, progress, results and failures."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any, Optional

import snowshed._core as _core
from snowshed.base.formatting import about, plural
from snowshed.base.paths import shell_words
from snowshed.base.progress import Progress, Reporter
from snowshed.cli.exit_codes import Failed, Stopped
from snowshed.cli.output.terminal import PlainConsole, say
from snowshed.study.definition import Study
from snowshed.study.errors import StudyInterrupted
from snowshed.study.store import Store, StoredRun

MAX_NAMED_RUNS = 5  # failed runs that an error names; the output lists all


def print_study_cost(study: Study, jobs: Optional[int]) -> None:
    """Print the number of runs of a study, and their expected time."""
    seconds, at_once = study.expected_duration(jobs=jobs)
    count = len(study.runs())
    say(f"{study.name}: {count} runs, {at_once} at once, {about(seconds)}")
    say(f"varying: {', '.join(study.axes) or 'nothing'}")


def compute_study(study: Study, folder: Path, *, quiet: bool, **options: Any) -> None:
    """Compute the missing runs of a study with a progress bar, and print the outcome."""
    with outcome_as_exit_code(), study_progress(quiet) as progress:
        study.compute(folder, progress=progress, **options)
    print_outcome(folder, [study.name], quiet)


@contextmanager
def outcome_as_exit_code() -> Iterator[None]:
    """Turn an interruption of a study into the exit code of the command."""
    try:
        yield
    except StudyInterrupted as interrupted:
        raise Stopped(str(interrupted)) from None


def study_progress(quiet: bool) -> AbstractContextManager[Optional[Reporter]]:
    """Return the progress bar of a study, which begins with the number of runs."""
    from snowshed.cli.output.progress import LONG_PERIOD_S, progress_bar

    return progress_bar(quiet=quiet, announce=announcement, speed_period_s=LONG_PERIOD_S)


def print_outcome(folder: Path, names: list[str], quiet: bool) -> None:
    """Print the number of finished runs, and commands for their results.

    Raises
    ------
    Failed
        If runs have failed.
    """
    with outcome_as_exit_code(), Store.open(folder) as store:
        runs = {run.hash: run for name in names for run in store.runs(name)}
    failed = [run for run in runs.values() if run.status == "failed"]
    if not quiet:
        print_failures(failed, PlainConsole(soft_wrap=True))
        done = len(runs) - len(failed)
        say(f"{done} of {len(runs)} runs done")
        say(f"To write a table: snowshed study export {shell_words(folder)} -o table.csv")
        say(f"To draw a picture: snowshed study picture {shell_words(folder)}")
    if failed:
        listed = ", ".join(run.hash[:12] for run in failed[:MAX_NAMED_RUNS])
        listed += ", ..." if len(failed) > MAX_NAMED_RUNS else ""
        raise Failed(f"{len(failed)} of {len(runs)} runs failed: {listed}")


def announcement(progress: Progress) -> str:
    """Return the announcement before the first run starts."""
    left = progress.count - progress.done - progress.failed
    earlier = f" ({progress.count - left} of {progress.count} are done already)"
    slow = _core.slow_kernels_note()
    return (
        f"{plural(left, 'run')} to compute{earlier if left < progress.count else ''}, "
        f"{progress.at_once} at once; expected time: {about(progress.expected_s or 0.0)}"
        + (f"\nnote: {slow}" if slow else "")
    )


def print_failures(runs: Sequence[StoredRun], console: PlainConsole) -> None:
    """Print the runs that failed, with their errors."""
    for run in runs:
        if run.status == "failed":
            console.print(f"  {run.hash[:12]} failed: {run.error}")
