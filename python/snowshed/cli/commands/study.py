"""The commands ``snowshed study …``."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any, Optional, TypeVar

import click

from snowshed._core import InputError
from snowshed.base.formatting import plural
from snowshed.cli.compute_study import (
    compute_study,
    outcome_as_exit_code,
    print_failures,
    print_outcome,
    print_study_cost,
    study_progress,
)
from snowshed.cli.options.common import (
    PATH,
    ResultsFolder,
    dry_run_option,
    jobs_option,
    quiet_notes_option,
    quiet_option,
    resume_option,
    same_version_option,
)
from snowshed.cli.output.terminal import PlainConsole, say, write_out
from snowshed.io.atomic import write_text
from snowshed.snow.stack.trimming import DEFAULT_TRIMMING, TRIMMINGS
from snowshed.study.definition import Study
from snowshed.study.store import Store, no_study

Command = TypeVar("Command", bound=Callable[..., Any])

FORMATS = ("csv", "parquet", "netcdf")

_format_option = click.option(
    "--format",
    "form",
    type=click.Choice(FORMATS),
    help="Format.  [default: from the suffix .csv, .parquet or .nc]",
)
_name_option = click.option(
    "--study", "name", help="Name of the study, if the folder holds several."
)


def _computing_options(command: Command) -> Command:
    """Add the options of the commands that compute."""
    for option in (
        quiet_option,
        click.option("--retry-failed", is_flag=True, help="Compute failed runs again."),
        click.option(
            "--scheduler",
            metavar="ADDRESS",
            help="Dask scheduler whose workers compute, such as tcp://host:8786, or its .json file."
            " Needs the extra snowshed[cluster].",
        ),
        click.option("--threads", type=int, help="Threads of each run.  [default: fill the cores]"),
        jobs_option("Runs"),
        same_version_option,
    ):
        command = option(command)
    return command


@click.group()
def study() -> None:
    """Compute many runs of one scene whose parameters vary.

    \b
    Example:
      snowshed study template -o study.toml
      snowshed study run study.toml -o results
      snowshed study export results -o table.csv
    """  # noqa: D301 - click wants the control character


@study.command()
@click.option("-o", "--output", "file", type=PATH, help="File to write.  [default: stdout]")
@quiet_notes_option
def template(file: Optional[Path]) -> None:
    """Write a commented study file to start from."""
    from snowshed.study.study_file import TEMPLATE

    if file is None:
        write_out(TEMPLATE)
    else:
        write_text(file, TEMPLATE)


@study.command(hidden=True)
@click.argument("file", type=PATH)
@jobs_option("Runs")
def plan(file: Path, jobs: Optional[int]) -> None:
    """Print the number and the expected time of a study's runs; see ``run --dry-run``."""
    print_study_cost(Study.load(file), jobs)


@study.command()
@click.argument("file", type=PATH)
@click.option(
    *("-o", "--output", "folder"),
    type=PATH,
    required=True,
    cls=ResultsFolder,
    help="Folder of the store, old or new.",
)
@click.option(
    "--keep-particles", is_flag=True, help="Store particles too, for `snowshed study remeasure`."
)
@resume_option
@dry_run_option("Print the number of runs and their estimated time and exit.")
@_computing_options
def run(file: Path, folder: Path, dry_run: bool, quiet: bool, **options: Any) -> None:
    """Compute the missing runs of a study.

    After an interruption, the same command resumes.
    """
    study = Study.load(file)
    if dry_run:
        print_study_cost(study, options["jobs"])
    else:
        compute_study(study, folder, quiet=quiet, **options)


@study.command()
@click.argument("folder", type=PATH)
@click.option("--study", "name", help="Name of the study.  [default: all in the folder]")
@_computing_options
def resume(folder: Path, name: Optional[str], quiet: bool, **options: Any) -> None:
    """Compute the missing runs of the studies in a folder."""
    from snowshed.study import session

    with outcome_as_exit_code(), study_progress(quiet) as progress:
        session.resume(folder, name, progress=progress, **options)
    with Store.open(folder) as store:
        names = [name] if name else store.studies()
    print_outcome(folder, names, quiet)


@study.command()
@click.argument("folder", type=PATH)
def status(folder: Path) -> None:
    """Print the status of studies, also during their computation."""
    with outcome_as_exit_code(), Store.open(folder) as store:
        if not store.studies():
            raise InputError(f"{folder}: {no_study()}")
        print_status(store)


@study.command()
@click.argument("folder", type=PATH)
@click.option("-o", "--output", "file", type=PATH, required=True, help="File to write.")
@_format_option
@_name_option
@click.option("--timing", is_flag=True, help="Add wall times and the machine of each run.")
@quiet_option
def export(
    folder: Path, file: Path, form: Optional[str], name: Optional[str], timing: bool, quiet: bool
) -> None:
    """Write the table of the computed runs of a study to a file."""
    from snowshed.study.formats import export as write

    with outcome_as_exit_code():
        write(folder, file, study=name, form=form, timing=timing)
        _warn_of_missing(folder, name, quiet)


@study.command()
@click.argument("folder", type=PATH)
@click.option(
    "-o", "--output", "file", type=PATH, help="File to write.  [default: study.png in the folder]"
)
@_name_option
@quiet_option
def picture(folder: Path, file: Optional[Path], name: Optional[str], quiet: bool) -> None:
    """Draw the results of a study over each parameter that varies."""
    with outcome_as_exit_code():
        drawn = _draw(folder, file, name)
        if not quiet:
            say(drawn)
        _warn_of_missing(folder, name, quiet)


@study.command()
@click.argument("folder", type=PATH)
@click.option("-o", "--output", "file", type=PATH, required=True, help="File to write.")
@click.option(
    "--trimming",
    type=click.Choice(list(TRIMMINGS)),
    default=DEFAULT_TRIMMING,
    show_default=True,
    help="Trimming rule (thesis A.4.2) used for height_m, length_m, …",
)
@_format_option
@_name_option
@quiet_option
def remeasure(
    folder: Path, file: Path, trimming: str, form: Optional[str], name: Optional[str], quiet: bool
) -> None:
    """Measure the stacks of a study again, and write its table.

    The study must have been computed with --keep-particles.
    """
    from snowshed.study import remeasuring
    from snowshed.study.formats import write_table

    with outcome_as_exit_code():
        write_table(lambda: remeasuring.remeasure(folder, name, trimming=trimming), file, form)
        _warn_of_missing(folder, name, quiet)


@study.command()
@click.argument("folder", type=PATH)
@click.argument("hash_", metavar="HASH")
@click.option("-o", "--output", "file", type=PATH, help="File to write.  [default: stdout]")
@quiet_notes_option
def scene(folder: Path, hash_: str, file: Optional[Path]) -> None:
    """Write the scene of one run, to repeat it alone.

    HASH is the beginning of the run's hash.
    """
    with outcome_as_exit_code(), Store.open(folder) as store:
        text = store.find(hash_).scene
    if file is None:
        write_out(text)
    else:
        write_text(file, text + "\n")


def _draw(folder: Path, file: Optional[Path], name: Optional[str]) -> Path:
    """Write the picture of a study, and return its file."""
    from snowshed.plot.figure_style import save_figure
    from snowshed.plot.study_figure import study_figure
    from snowshed.study.table import read_table

    with Store.open(folder) as store:
        study_name = store.named(name)
        axes = store.axes(study_name)
    picture_file = file or folder / "study.png"
    save_figure(study_figure(read_table(folder, study_name), axes, study_name), picture_file)
    return picture_file


def _warn_of_missing(folder: Path, name: Optional[str], quiet: bool) -> None:
    if quiet:
        return
    with Store.open(folder) as store:
        runs = store.runs(store.named(name))
    missing = sum(run.status == "pending" for run in runs)
    if missing:
        say(f"note: {missing} of {len(runs)} runs are not computed yet", err=True)


def print_status(store: Store) -> None:
    """Print the status of the runs, study by study."""
    from snowshed.study.owner import is_alive

    console = PlainConsole(soft_wrap=True)
    for name in store.studies():
        runs = store.runs(name)
        console.print(f"{name}: {plural(len(runs), 'run')}", style="bold")
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
