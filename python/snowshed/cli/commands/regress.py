"""The command ``snowshed regress``: slow modules are imported when it runs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Optional

import click

from snowshed.cli.commands.designed_study import measure_help
from snowshed.cli.exit_codes import Stopped
from snowshed.cli.options.common import PATH, jobs_option, quiet_option, resume_option
from snowshed.cli.options.number_texts import named_once
from snowshed.cli.output.terminal import narrow_table, say, wide_console

if TYPE_CHECKING:
    from rich.table import Table

    from snowshed.analysis.regression.pipeline import TargetReport


@click.command()
@click.argument("table", type=PATH)
@click.option(
    "-o", "--output", "folder", type=PATH, required=True, help="Results folder, old or new."
)
@click.option(
    "--target",
    "targets",
    multiple=True,
    metavar="NAME",
    help="Target: ratio, height or length. Repeatable.  [default: all]",
)
@click.option(
    "--kind",
    "kinds",
    multiple=True,
    metavar="NAME",
    help="Model: linear, rbf, gaussian-process or gradient-boosting. Repeatable.  [default: all]",
)
@click.option(
    "--measure",
    default="stack",
    help=f"{measure_help()}  [default: stack]",
)
@click.option(
    "--input",
    "inputs",
    multiple=True,
    metavar="PATH",
    help="Further regression input: a parameter varied in the study, such as snow.cohesion. "
    "Repeatable.  [default: panel.height, panel.length, panel.tilt]",
)
@click.option(
    "--where",
    "conditions",
    multiple=True,
    metavar="COLUMN=VALUE",
    help="Use only rows with this value. Repeatable.",
)
@click.option(
    "--one-seed",
    is_flag=True,
    help="Use the first stack of each panel and event, as the thesis does, not the mean.",
)
@click.option(
    "--split",
    default="rows",
    help="Cross-validate by rows, or by panels (all events of a panel together).  [default: rows]",
)
@click.option("--rounds", default=10, help="Repetitions of the outer loop.  [default: 10]")
@click.option("--folds", default=10, help="Outer folds.  [default: 10]")
@click.option("--inner-folds", default=5, help="Inner folds.  [default: 5]")
@click.option("--seed", default=1, help="Random seed of the splits.  [default: 1]")
@jobs_option("Processes")
@click.option(
    "--title", help="Title of the data, which predict prints.  [default: table name and rows]"
)
@resume_option
@quiet_option
def regress(
    table: Path,
    folder: Path,
    targets: Sequence[str],
    kinds: Sequence[str],
    measure: str,
    inputs: Sequence[str],
    conditions: Sequence[str],
    one_seed: bool,
    split: str,
    rounds: int,
    folds: int,
    inner_folds: int,
    seed: int,
    jobs: Optional[int],
    title: Optional[str],
    quiet: bool,
) -> None:
    """Regress stacks on panels: models, tables and figures from a study's table.

    Cross-validates (nested) support vector machines, a Gaussian process and boosted trees for the
    stack's height, length and their ratio. After an interruption, the same command resumes.
    """
    from snowshed.analysis.regression.folds import CrossValidation
    from snowshed.analysis.regression.nested import RegressionInterrupted
    from snowshed.analysis.regression.pipeline import MODEL
    from snowshed.analysis.regression.pipeline import regress as run
    from snowshed.analysis.regression.rows import INPUTS, read_rows
    from snowshed.cli.output.progress import LONG_PERIOD_S, progress_bar

    where = named_once("--where", map(_condition, conditions))
    rows = read_rows(table, measure, where, inputs or INPUTS[1:])
    rows = rows.of_one_seed() if one_seed else rows
    scheme = CrossValidation(rounds, folds, inner_folds, seed, split)
    try:
        with progress_bar(quiet=quiet, speed_period_s=LONG_PERIOD_S) as progress:
            reports = run(
                rows,
                folder,
                targets=targets,
                models=kinds,
                scheme=scheme,
                jobs=jobs,
                title=title or f"{table.stem}, {len(rows)} rows",
                measure=measure,
                progress=progress,
            )
    except RegressionInterrupted as interrupted:
        raise Stopped(str(interrupted)) from None
    if not quiet:
        print_reports(reports)
        model = f" and {MODEL}" if (folder / MODEL).is_file() else ""
        say(f"tables, figures{model} in {folder}")


def _condition(text: str) -> tuple[str, str]:
    column, equals, value = text.partition("=")
    if not equals:
        raise click.BadParameter(f"{text}: not COLUMN=VALUE", param_hint="--where")
    return column, value


def print_reports(reports: Sequence[TargetReport]) -> None:
    """Print errors and quartiles for each target."""
    from snowshed.analysis.regression.rows import TARGETS
    from snowshed.analysis.regression.summary import QUARTILES

    for report in reports:
        unit = f", {TARGETS[report.target]}" if TARGETS[report.target] else ""
        wide_console().print(_error_table(report, unit))
        scatter = report.errors["seeding_scatter"].max()
        if scatter == scatter:
            wide_console().print(f" stacks of single seeds scatter by {scatter:.4f} about the mean")
        title = f"Quartiles of the predicted {report.target}{unit}"
        quartiles = narrow_table(title, ["model", *QUARTILES])
        for model, row in report.quartiles.iterrows():
            quartiles.add_row(str(model), *(f"{row[name]:.3f}" for name in QUARTILES))
        wide_console().print(quartiles)
        if report.expression:
            wide_console().print(f" {report.expression}\n")


def _error_table(report: TargetReport, unit: str) -> Table:
    headings = ["model", "all rows", "not trained\non", "unseen\npanels", "fits", "cpu time\ns"]
    table = narrow_table(f"Mean absolute error of the {report.target}{unit}", headings)
    for model, row in report.errors.iterrows():
        cells = [f"{row['mean_absolute_error']:.4f} ± {row['standard_deviation']:.4f}"]
        cells += [f"{row['held_out_error']:.4f}", _or_nothing(row["unseen_panel_error"])]
        cells += [f"{row['fits']:,.0f}", f"{row['cpu_s']:,.1f}"]
        table.add_row(str(model), *cells)
    return table


def _or_nothing(value: float) -> str:
    return f"{value:.4f}" if value == value else ""
