"""Computing stages for a command: progress, and how failures end it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import click

from snowshed.cli.exit_codes import Failed, Stopped

if TYPE_CHECKING:
    from reproduction.hypothesis_tests import Judged
    from reproduction.stage import Stage


def compute_and_report(
    stages: Sequence[Stage],
    folder: Path,
    report: Callable[[], list[Judged]],
    *,
    publication: str,
    file: Path,
    jobs: Optional[int],
    quiet: bool,
) -> None:
    """Compute what is left of some stages, write the report, and print its verdicts.

    Parameters
    ----------
    stages, folder
        What to compute, if anything, and the folder of all.
    report
        Writes the report; returns the claims with their findings.
    publication, file
        What verdicts and report are of, such as "the paper", and the report's file.
    jobs, quiet
        Simulations at once, and whether to print nothing.
    """
    from reproduction.display import print_claims

    if stages:
        _compute_stages(stages, folder, jobs, quiet)
    claims = report()
    if not quiet:
        print_claims(claims, publication)
        click.echo(f"report in {file}")


def _compute_stages(
    stages: Sequence[Stage], folder: Path, jobs: Optional[int], quiet: bool
) -> None:
    """Compute what is left of some stages; end as commands do after Ctrl-C or a full disk."""
    from reproduction.display import progress_bar
    from reproduction.stage import compute
    from snowshed.study.errors import StudyError

    try:
        with progress_bar(quiet=quiet) as progress:
            compute(stages, jobs=jobs, progress=progress)
    except StudyError as error:
        raise Failed(str(error)) from None
    except KeyboardInterrupt:
        message = f"interrupted; the same command goes on with what {folder} holds"
        raise Stopped(message) from None


def check_failures(stages: Mapping[str, Stage], runs: Path) -> None:
    """End the command if simulations of some stages have failed."""
    failed = {name: stage.state().failed for name, stage in stages.items()}
    listed = ", ".join(f"{count} of {name}" for name, count in failed.items() if count)
    if listed:
        raise Failed(f"simulations failed: {listed}; see `snowshed study status {runs}`")
