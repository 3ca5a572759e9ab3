"""The commands ``snowshed geometry|regress|predict``; slow imports are made when they run."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Optional

import click
from click.core import ParameterSource

from snowshed._core import InputError
from snowshed.analysis.regression.deviations import ALL, DEVIATIONS
from snowshed.analysis.regression.geometry import FRICTION
from snowshed.cli.commands.designed_study import measure_help
from snowshed.cli.exit_codes import Stopped
from snowshed.cli.quiet import quiet_notes_option, quiet_option
from snowshed.cli.terminal import say, write_out

PATH = click.Path(path_type=Path)


@click.command()
@click.option(
    "--between",
    default="carry",
    help="What happens to the stack between events: carry or reseed.  [default: carry]",
)
@click.option(
    "--friction",
    type=click.FloatRange(0.0, 10.0),
    default=FRICTION,
    show_default=True,
    help="Coulomb coefficient of the panel.",
)
@click.option(
    "--dx",
    type=click.FloatRange(1e-4, 1.0),
    default=0.01,
    show_default=True,
    help="Size of the grid cells, m.",
)
@click.option(
    "--seeds",
    type=click.IntRange(1, 1000),
    default=1,
    show_default=True,
    help="Stacks for each panel up to 1 m, whose means are regressed; up to 2 m a third of them, "
    "up to 4 m a sixth, beyond a sixteenth, rounded up.",
)
@click.option(
    "--deviation",
    "deviations",
    multiple=True,
    type=click.Choice([*DEVIATIONS, ALL]),
    help="Use the thesis's choice for this setting. Repeatable; `all` for every setting. Goes "
    "before --between and --dx.",
)
@click.option("--trial", is_flag=True, help="A few panels on a coarse grid, which take seconds.")
@click.option("-o", "--output", "file", type=PATH, help="File to write; else stdout.")
@quiet_notes_option
@click.pass_context
def geometry(
    context: click.Context,
    between: str,
    friction: float,
    dx: float,
    seeds: int,
    deviations: Sequence[str],
    trial: bool,
    file: Optional[Path],
) -> None:
    """Write the study of panel geometries whose table ``regress`` takes.

    \b
    Example:
      snowshed geometry -o geometry.toml
      snowshed study run geometry.toml -o runs
      snowshed study export runs -o rows.csv
      snowshed regress rows.csv -o regression
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.regression.geometry import geometry_study

    if trial and context.get_parameter_source("dx") == ParameterSource.COMMANDLINE:
        raise click.UsageError("--dx does nothing with --trial, which has cells of its own")
    if trial and deviations:
        raise click.UsageError("--deviation does nothing with --trial")
    study = geometry_study(
        between, friction=friction, dx=dx, seeds=seeds, deviations=deviations, trial=trial
    )
    if file is None:
        write_out(study.to_toml())
    else:
        study.save(file)


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
    help="ratio, height or length; may be repeated.  [default: all]",
)
@click.option(
    "--kind",
    "kinds",
    multiple=True,
    metavar="NAME",
    help="linear, rbf, gaussian-process or gradient-boosting; may be repeated.  [default: all]",
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
    help="What stacks depend on besides the event: a parameter that the study varied, such as "
    "snow.cohesion; may be repeated.  [default: panel.height, panel.length, panel.tilt]",
)
@click.option(
    "--where",
    "conditions",
    multiple=True,
    metavar="COLUMN=VALUE",
    help="Only rows that have this value; may be repeated.",
)
@click.option(
    "--one-seed",
    is_flag=True,
    help="Take the first stack of each panel and event only, as the thesis has one, not the mean.",
)
@click.option(
    "--split",
    default="rows",
    help="What the folds split: rows, or panels with all their events.  [default: rows]",
)
@click.option("--rounds", default=10, help="Repetitions of the outer loop.  [default: 10]")
@click.option("--folds", default=10, help="Outer folds.  [default: 10]")
@click.option("--inner-folds", default=5, help="Inner folds.  [default: 5]")
@click.option("--seed", default=1, help="Of the random splits.  [default: 1]")
@click.option("--jobs", type=int, help="Processes.  [default: the number of cores]")
@click.option(
    "--title", help="What the data are; predict shows it.  [default: the table's name and its rows]"
)
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

    Nested cross-validation of support vector machines, a Gaussian process and boosted trees for the
    stack's height, length and their ratio. After an interruption the same command goes on.
    """
    from snowshed.analysis.regression.folds import CrossValidation
    from snowshed.analysis.regression.nested import RegressionInterrupted
    from snowshed.analysis.regression.pipeline import MODEL
    from snowshed.analysis.regression.pipeline import regress as run
    from snowshed.analysis.regression.rows import INPUTS, read_rows
    from snowshed.cli.display.regression import print_reports
    from snowshed.cli.progress import LONG_PERIOD_S, progress_bar

    where = dict(map(_condition, conditions))
    rows = read_rows(table, measure, where, inputs or INPUTS[1:])
    rows = rows.of_one_seed() if one_seed else rows
    scheme = CrossValidation(rounds, folds, inner_folds, seed, split)
    if rows.left_out and not quiet:
        say(f"note: {rows.left_out} rows have no stack and are left out", err=True)
    if rows.moving and not quiet:
        say(f"note: {rows.moving} stacks were not at rest when their time was over", err=True)
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


@click.command()
@click.option("--height", type=float, help="Panel's lower edge above ground, m.")
@click.option("--length", type=float, help="Panel along the slope, m.")
@click.option("--tilt", type=float, help="Panel from the horizontal, degrees.")
@click.option(
    "--input",
    "inputs",
    multiple=True,
    metavar="PATH=VALUE",
    help="Another input of the model, such as snow.cohesion=0.2; may be repeated.",
)
@click.option("--events", type=int, default=5, help="Slide-offs.  [default: 5]")
@click.option("--model", type=PATH, help="Model file of regress.  [default: the one shipped]")
@click.option("--kind", help="rbf, gaussian-process or linear.  [default: the first there is]")
@click.option(
    "--extrapolate", is_flag=True, help="Answer outside the data too, with a mark on every answer."
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def predict(
    height: Optional[float],
    length: Optional[float],
    tilt: Optional[float],
    inputs: Sequence[str],
    events: int,
    model: Optional[Path],
    kind: Optional[str],
    extrapolate: bool,
    as_json: bool,
) -> None:
    """Predict a stack's height and length, with their spread, without simulating it.

    Questions outside the data of the model are refused (exit code 2).

    \b
    Example:
      snowshed predict --height 2 --length 4 --tilt 60 --events 5
    """  # noqa: D301 - click wants the control character
    from snowshed.analysis.regression.predictor import predict as ask
    from snowshed.cli.display.regression import prediction_json, print_prediction

    asked: dict[str, Any] = {"height": height, "length": length, "tilt": tilt, "events": events}
    others = dict(map(_input, inputs))
    try:
        found = ask(**asked, inputs=others, model=model, kind=kind, extrapolate=extrapolate)
    except InputError as error:
        named = str(error).partition(":")[0] in asked
        raise type(error)(f"--{error}") if named else error from None
    for objection in found.objections:
        say(f"warning: EXTRAPOLATED, do not rely on it: {objection}", err=True)
    if as_json:
        write_out(prediction_json(found))
    else:
        print_prediction(
            found, f"Stack below the panel: {found.asked}\n{found.kind}, {found.title}"
        )


def _input(text: str) -> tuple[str, float]:
    path, equals, value = text.partition("=")
    try:
        if not equals:
            raise ValueError
        return path, float(value)
    except ValueError:
        raise click.BadParameter(f"{text}: not PATH=NUMBER", param_hint="--input") from None


def _condition(text: str) -> tuple[str, str]:
    column, equals, value = text.partition("=")
    if not equals:
        raise click.BadParameter(f"{text}: not COLUMN=VALUE", param_hint="--where")
    return column, value
