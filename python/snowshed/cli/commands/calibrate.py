"""The command ``snowshed calibrate``: slow modules are imported when it runs."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional

import click

from snowshed.cli.commands.designed_study import (
    check_options,
    chosen_study,
    compute_missing_runs,
    design_options,
)
from snowshed.cli.options.common import PATH
from snowshed.cli.output.terminal import plain_table, say, wide_console

if TYPE_CHECKING:
    from rich.table import Table

    from snowshed.analysis.calibration.report import Calibration

BEST_SETS = 5  # number of printed parameter sets
OPEN_RANGES = {
    "below": "open below",
    "above": "open above",
    "both": "undecided",
    "": "",
}


@click.command()
@click.argument("measurements", type=PATH, required=False)
@click.option("--template", type=PATH, help="Write an empty measurements file to fill in.")
@click.option(
    "--quantity",
    "quantities",
    multiple=True,
    metavar="NAME",
    help="Quantity to fit: height, length, head or tail. Repeatable.  [default: height, length]",
)
@design_options("2")
@click.pass_context
def calibrate(
    context: click.Context,
    /,
    measurements: Optional[Path],
    template: Optional[Path],
    quantities: Sequence[str],
    folder: Optional[Path],
    quick: bool,
    seeds: Optional[int],
    stored: Optional[Path],
    name: Optional[str],
    measure: str,
    quiet: bool,
    **options: Any,
) -> None:
    """Find the snow whose simulated stacks agree with measured ones.

    Computes the missing runs into DIR/runs, ranks the parameter sets, and gives the ranges that the
    measurements allow. After an interruption, the same command resumes. With --stored it evaluates
    the store of another study.

    \b
    Example:
      snowshed calibrate --template stacks.csv
      snowshed calibrate stacks.csv --quick -o calibration
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.calibration import measurements as reading
    from snowshed.analysis.calibration.grid_study import calibration_study
    from snowshed.analysis.calibration.misfit import RANKING_QUANTITIES
    from snowshed.analysis.calibration.report import check_libraries, evaluate_calibration
    from snowshed.io.atomic import write_text

    if template is not None:
        write_text(template, reading.measurements_template())
        return
    if measurements is None:
        raise click.UsageError("give a MEASUREMENTS file, or --template FILE to write an empty one")
    folder = check_options(context)
    measured = reading.read_measurements(measurements)
    if not context.params["dry_run"]:
        check_libraries()
    if stored is None:
        design = partial(calibration_study, measured, quick=quick, seeds=seeds)
        runs = compute_missing_runs(context, chosen_study(context, folder, design), folder)
        if runs is None:
            return
        stored, name = runs
    calibration = evaluate_calibration(
        measured,
        stored,
        folder,
        study=name,
        measure=measure,
        quantities=quantities or RANKING_QUANTITIES,
    )
    if not quiet:
        print_calibration(calibration)
        say(f"tables and figures in {folder}")


def print_calibration(calibration: Calibration) -> None:
    """Print the ranking and the ranges; notes on their limits were issued."""
    console = wide_console()
    console.print(_ranking(calibration))
    console.print(_ranges(calibration))
    posterior = calibration.posterior
    diagnostics, sample_size = posterior.diagnostics, posterior.effective_samples
    largest_r_hat = diagnostics["r_hat"].max()
    console.print(f" chains: ESS {sample_size:.0f} or more, r_hat {largest_r_hat:.3f} or less")
    if any(calibration.ranges["open"]):
        console.print(" open, undecided: the range continues beyond the grid")


def _ranking(calibration: Calibration) -> Table:
    from snowshed.analysis.calibration.misfit import RANKING_QUANTITIES
    from snowshed.scene.labels import label

    paths = calibration.stacks.parameters
    measured = [q for q in RANKING_QUANTITIES if f"{q}_rmse_m" in calibration.ranked]
    headings = ["rank", *(label(path).axis for path in paths)]
    headings += [f"{q}\nRMSE, m" for q in measured] + [f"{q}\nerror" for q in measured]
    table = plain_table(
        "Parameter sets by mean rescaled RMSE", [*headings, "rescaled\nRMSE"], padding=(0, 1)
    )
    for _, row in calibration.ranked.head(BEST_SETS).iterrows():
        cells = [f"{row['rank']:.0f}", *(label(path).value(row[path]) for path in paths)]
        cells += [f"{row[f'{q}_rmse_m']:.4f}" for q in measured]
        cells += [f"{100 * row[f'{q}_relative_error']:+.1f} %" for q in measured]
        table.add_row(*cells, f"{row['rescaled_rmse']:.3f}")
    return table


def _ranges(calibration: Calibration) -> Table:
    from snowshed.scene.labels import label

    headings = ["parameter", "best set", "median", "68 %", "95 %"]
    table = plain_table("Parameters that the measurements allow", headings, padding=(0, 1))
    table.add_column("", no_wrap=True)
    for _, row in calibration.ranges.iterrows():
        parameter = label(str(row["parameter"]))
        cells = [parameter.axis]
        cells += [parameter.value(row["best_set"]), parameter.value(row["median"])]
        cells += [_interval(row, level, parameter.scale) for level in ("68", "95")]
        table.add_row(*cells, OPEN_RANGES[str(row["open"])])
    return table


def _interval(row: Any, level: str, scale: float) -> str:
    return " to ".join(f"{row[f'{end}_{level}'] / scale:.3g}" for end in ("lower", "upper"))
