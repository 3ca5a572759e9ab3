"""The commands ``snowshed reproduce`` and ``python -m thesis``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import click

from snowshed.cli.exit_codes import Failed, Stopped

if TYPE_CHECKING:
    from snowshed.scene.components import Condition
    from thesis.reproduction import Reproduction
    from thesis.stage import Stage

PATH = click.Path(path_type=Path)


@click.group()
def reproduce() -> None:
    """Reproduce a publication: its tables and figures, and verdicts on its claims.

    \b
    Example:
      snowshed reproduce thesis --quick -o reproduction
    """  # noqa: D301 - click wants the control character


@reproduce.command()
@click.option(
    "-o", "--output", "folder", type=PATH, required=True, help="Results folder, old or new."
)
@click.option(
    "--quick",
    "size",
    flag_value="quick",
    default=True,
    help="Minutes: in 2D, a coarse grid (default).",
)
@click.option(
    "--middle", "size", flag_value="middle", help="Hours: the thesis's settings, few seedings."
)
@click.option("--full", "size", flag_value="full", help="Days: all of it, several seedings.")
@click.option(
    "--stage",
    "names",
    multiple=True,
    metavar="NAME",
    help="Compute only this: lab, s-index, fixation, calibration, deviations, variations, "
    "geometry (with --full) or regression; may be repeated.",
)
@click.option(
    "--table", type=PATH, help="Rows of panels to use for chapter 5 instead of simulating them."
)
@click.option(
    "--condition",
    type=click.Choice(["separate", "slip"]),
    default="separate",
    help="Contact with the panel: snow may leave it, or, as in the thesis (SLIP), only over its "
    "edge.  [default: separate]",
)
@click.option("--report-only", is_flag=True, help="Compute nothing, write the report.")
@click.option("--jobs", type=int, help="Processes at once.  [default: the number of cores]")
@click.option("-q", "--quiet", is_flag=True, help="Print nothing but errors.")
def thesis(
    folder: Path,
    size: str,
    names: Sequence[str],
    table: Optional[Path],
    condition: Condition,
    report_only: bool,
    jobs: Optional[int],
    quiet: bool,
) -> None:
    """Reproduce chapters 3 to 5 of the thesis and its lab experiment, and judge its claims.

    Writes thesis.html. After an interruption the same command goes on.

    \b
    Example:
      snowshed reproduce thesis --quick -o reproduction
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.regression.rows import read_rows
    from thesis.folder import ReproductionFolder
    from thesis.report import write_report
    from thesis.reproduction import Reproduction
    from thesis.size import SIZES
    from thesis.stage import choose

    chosen = replace(SIZES[size], condition=condition)
    if table is not None:  # so that a wrong table is known before anything is computed
        chosen.folds.check(read_rows(table))
    results = ReproductionFolder.claim(folder, chosen.name, condition)
    all_of_it = Reproduction(results, chosen, table)
    if not report_only:
        _compute(choose(all_of_it.stages, names), folder, jobs, quiet)
    claims = write_report(all_of_it)
    if not quiet:
        from thesis.display import print_claims

        print_claims(claims)
        click.echo(f"report in {results.report}")
    _check_failures(all_of_it)


def _compute(stages: Sequence[Stage], folder: Path, jobs: Optional[int], quiet: bool) -> None:
    from snowshed.study.errors import StudyError
    from thesis.display import progress_bar
    from thesis.reproduction import compute

    try:
        with progress_bar(quiet=quiet) as progress:
            compute(stages, jobs=jobs, progress=progress)
    except StudyError as error:
        raise Failed(str(error)) from None
    except KeyboardInterrupt:
        message = f"interrupted; the same command goes on with what {folder} holds"
        raise Stopped(message) from None


def _check_failures(found: Reproduction) -> None:
    failed = {name: stage.state().failed for name, stage in found.study_stages.items()}
    listed = ", ".join(f"{count} of {name}" for name, count in failed.items() if count)
    if listed:
        raise Failed(
            f"simulations failed: {listed}; see `snowshed study status {found.folder.runs}`"
        )
