"""The command ``snowshed reproduce thesis``, which is also ``python -m thesis``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import click
from reproduction.computing import check_failures, compute_and_report

if TYPE_CHECKING:
    from snowshed.scene.components import Condition

PATH = click.Path(path_type=Path)


@click.command()
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
      snowshed reproduce thesis --quick -o report
    """  # noqa: D301 - click wants the control character
    from reproduction.stage import choose

    from snowshed.analysis.regression.rows import read_rows
    from thesis.folder import ReproductionFolder
    from thesis.report import write_report
    from thesis.reproduction import Reproduction
    from thesis.size import SIZES

    chosen = replace(SIZES[size], condition=condition)
    if table is not None:  # so that a wrong table is known before anything is computed
        chosen.folds.check(read_rows(table))
    results = ReproductionFolder.claim(folder, chosen.name, condition)
    all_of_it = Reproduction(results, chosen, table)
    compute_and_report(
        [] if report_only else choose(all_of_it.stages, names), folder,
        lambda: write_report(all_of_it),
        publication="the thesis", file=results.report, jobs=jobs, quiet=quiet,
    )  # fmt: skip
    check_failures(all_of_it.study_stages, results.runs)
