"""The command ``python -m validation``; slow modules are imported when it runs."""

from __future__ import annotations

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import click

from snowshed.cli.exit_codes import Stopped

if TYPE_CHECKING:
    from snowshed.snow.accuracy.measurements import MeasuredSolution
    from validation.framework.case import Case
    from validation.framework.folder import ValidationFolder
    from validation.framework.report import Stress

PATH = click.Path(path_type=Path)


@click.command()
@click.option(
    "--quick/--full", "quick", default=True, help="About a minute, or some hours.  [default: quick]"
)
@click.option(
    "--case", "names", multiple=True, metavar="NAME", help="Run only this case; repeatable."
)
@click.option(
    "--stress/--no-stress",
    default=None,
    help="Whether to run the stress suite too.  [default: unless there is a --case]",
)
@click.option("--seed", default=1, help="Random seed of the stress suite's scenes.  [default: 1]")
@click.option("--resume", is_flag=True, help="Keep what the folder holds, and measure the rest.")
@click.option(
    "--record", "recorded", type=PATH, help="File to keep the measurements in for --accuracy."
)
@click.option("-q", "--quiet", is_flag=True, help="Print nothing but errors.")
@click.option(
    "-o", "--output", "folder", type=PATH, required=True, help="Results folder, new or empty."
)
def validate(
    quick: bool,
    names: Sequence[str],
    stress: Optional[bool],
    seed: int,
    resume: bool,
    recorded: Optional[Path],
    quiet: bool,
    folder: Path,
) -> int:
    """Solve problems with known answers, and report the errors against run time.

    Writes validation.html, tables and figures. The exit code is 1 if an error is too large, if an
    order of convergence is too small, or if anything failed.

    \b
    Example:
      python -m validation --quick -o validation
    """  # noqa: D301 - click wants the control character
    from snowshed.snow.accuracy.recorded import load_recorded, record
    from validation.framework.cases import load_cases
    from validation.framework.folder import ValidationFolder
    from validation.framework.report import Validation, problems, write_report

    cases = load_cases(names)
    if recorded is not None:
        load_recorded(recorded)  # a damaged file must be reported before hours of computing
    stress = not names if stress is None else stress
    open_folder = ValidationFolder.reopen if resume else ValidationFolder.create
    results = open_folder(folder)
    try:
        measurements = _measure(cases, results, full=not quick, quiet=quiet)
        if recorded is not None:
            record(measurements, recorded)
        stressed = _stress(results, full=not quick, seed=seed, quiet=quiet) if stress else None
    except KeyboardInterrupt:
        command = _resume_command(quick, names, stress, seed, folder)
        raise Stopped(f"interrupted; resume with: {command}") from None
    validation = Validation(cases, measurements, full=not quick, stress=stressed)
    criteria = write_report(validation, folder)
    if not quiet:
        from validation.framework.display import print_criteria

        print_criteria(criteria, cases)
        click.echo(f"report in {folder / 'validation.html'}")
    wrong = problems(validation, criteria)
    for line in wrong:
        click.echo(f"error: {line}", err=True)
    return int(bool(wrong))


def _measure(
    cases: Sequence[Case], results: ValidationFolder, *, full: bool, quiet: bool
) -> list[MeasuredSolution]:
    from snowshed.snow.accuracy.recorded import load_recorded
    from validation.framework.display import validation_bar
    from validation.framework.measure import measure_cases

    durations = {measurement.key: measurement.elapsed_s for measurement in load_recorded()}
    with validation_bar(quiet=quiet) as progress:
        return measure_cases(
            cases, results.measurements, full=full, progress=progress, durations=durations
        )


def _stress(results: ValidationFolder, *, full: bool, seed: int, quiet: bool) -> Stress:
    from validation import stress
    from validation.framework.display import validation_bar
    from validation.framework.report import Stress

    runs = results.kept_stress(full=full, seed=seed)
    if runs is None:
        with validation_bar(quiet=quiet) as progress:
            runs = stress.run(full, seed, progress)
        results.keep_stress(runs, full=full, seed=seed)
    return Stress(runs, stress.summarise(runs))


def _resume_command(
    quick: bool, names: Sequence[str], stress: bool, seed: int, folder: Path
) -> str:
    words = ["python", "-m", "validation", "--quick" if quick else "--full"]
    words += [word for name in names for word in ("--case", name)]
    words += ["--stress", "--seed", str(seed)] if stress else ["--no-stress"]
    return shlex.join([*words, "--resume", "-o", str(folder)])
