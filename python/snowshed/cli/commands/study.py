"""The commands ``snowshed study ...``."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any, Optional, TypeVar

import click

from snowshed._core import InputError
from snowshed.base.formatting import about
from snowshed.base.progress import Reporter
from snowshed.cli.exit_codes import Failed, Stopped
from snowshed.cli.quiet import quiet_notes_option, quiet_option
from snowshed.cli.terminal import PlainConsole, say, write_out
from snowshed.io.atomic import write_text
from snowshed.snow.stack.trimming import DEFAULT_TRIMMING, TRIMMINGS
from snowshed.study.definition import Study
from snowshed.study.errors import StudyInterrupted
from snowshed.study.store import NO_STUDY, Store

Command = TypeVar("Command", bound=Callable[..., Any])

PATH = click.Path(path_type=Path)
LISTED = 5  # failed runs that an error names; the output has them all


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
        click.option("--jobs", type=int, help="Runs at once.  [default: the number of cores]"),
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
@click.option("-o", "--output", "file", type=PATH, help="File to write; else stdout.")
@quiet_notes_option
def template(file: Optional[Path]) -> None:
    """Write a study file with comments, to start from."""
    from snowshed.study.study_file import TEMPLATE

    if file is None:
        write_out(TEMPLATE)
    else:
        write_text(file, TEMPLATE)


@study.command()
@click.argument("file", type=PATH)
@click.option("--jobs", type=int, help="Runs at once.  [default: the number of cores]")
def plan(file: Path, jobs: Optional[int]) -> None:
    """Print the number and the expected time of a study's runs."""
    print_plan(Study.load(file), jobs)


@study.command()
@click.argument("file", type=PATH)
@click.option(
    "-o", "--output", "folder", type=PATH, required=True, help="Folder of the store, old or new."
)
@click.option(
    "--keep-particles", is_flag=True, help="Store particles too, for `snowshed study remeasure`."
)
@_computing_options
def run(file: Path, folder: Path, quiet: bool, **options: Any) -> None:
    """Compute the missing runs of a study.

    After an interruption the same command goes on.
    """
    compute_study(Study.load(file), folder, quiet=quiet, **options)


@study.command()
@click.argument("folder", type=PATH)
@click.option("--study", "name", help="Name of the study.  [default: all in the folder]")
@_computing_options
def resume(folder: Path, name: Optional[str], quiet: bool, **options: Any) -> None:
    """Compute the missing runs of the studies in a folder."""
    from snowshed.study import session

    with _outcome_as_exit_code(), _progress(quiet) as progress:
        session.resume(folder, name, progress=progress, **options)
    with Store.open(folder) as store:
        names = [name] if name else store.studies()
    _finish(folder, names, quiet)


@study.command()
@click.argument("folder", type=PATH)
def status(folder: Path) -> None:
    """Print the status of studies, also during their computation."""
    from snowshed.cli.display.study import print_status

    with _outcome_as_exit_code(), Store.open(folder) as store:
        if not store.studies():
            raise InputError(f"{folder}: {NO_STUDY}")
        print_status(store)


@study.command()
@click.argument("folder", type=PATH)
@click.option("-o", "--output", "file", type=PATH, required=True, help="File to write.")
@click.option(
    "--format",
    "form",
    type=click.Choice(["csv", "parquet", "netcdf"]),
    help="[default: by the file's ending .csv, .parquet or .nc]",
)
@click.option("--study", "name", help="Name of the study, if the folder holds several.")
@click.option("--timing", is_flag=True, help="Add wall times and what computed the runs.")
@quiet_option
def export(
    folder: Path, file: Path, form: Optional[str], name: Optional[str], timing: bool, quiet: bool
) -> None:
    """Write a study's table to a file, as far as it is computed."""
    from snowshed.study.formats import export as write

    with _outcome_as_exit_code():
        write(folder, file, study=name, form=form, timing=timing)
        _warn_of_missing(folder, name, quiet)


@study.command()
@click.argument("folder", type=PATH)
@click.option(
    "-o", "--output", "file", type=PATH, help="File to write.  [default: study.png in the folder]"
)
@click.option("--study", "name", help="Name of the study, if the folder holds several.")
@quiet_option
def picture(folder: Path, file: Optional[Path], name: Optional[str], quiet: bool) -> None:
    """Draw what a study's runs measured over each parameter that varies."""
    with _outcome_as_exit_code():
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
    help="How A.4.2 is read: what height_m, length_m and the like are of.",
)
@click.option(
    "--format",
    "form",
    type=click.Choice(["csv", "parquet", "netcdf"]),
    help="[default: by the file's ending .csv, .parquet or .nc]",
)
@click.option("--study", "name", help="Name of the study, if the folder holds several.")
@quiet_option
def remeasure(
    folder: Path, file: Path, trimming: str, form: Optional[str], name: Optional[str], quiet: bool
) -> None:
    """Measure the stacks of a study again, and write its table.

    The study must have been computed with --keep-particles.
    """
    from snowshed.study import remeasuring
    from snowshed.study.formats import write_table

    with _outcome_as_exit_code():
        write_table(lambda: remeasuring.remeasure(folder, name, trimming=trimming), file, form)
        _warn_of_missing(folder, name, quiet)


@study.command()
@click.argument("folder", type=PATH)
@click.argument("hash_", metavar="HASH")
@click.option("-o", "--output", "file", type=PATH, help="File to write; else stdout.")
@quiet_notes_option
def scene(folder: Path, hash_: str, file: Optional[Path]) -> None:
    """Write the scene of one run, to repeat it alone.

    HASH is the beginning of its hash.
    """
    with _outcome_as_exit_code(), Store.open(folder) as store:
        text = store.find(hash_).scene
    if file is None:
        write_out(text)
    else:
        write_text(file, text + "\n")


def print_plan(study: Study, jobs: Optional[int]) -> None:
    """Print the number of runs of a study, and their expected time."""
    seconds, at_once = study.expected_duration(jobs=jobs)
    count = len(study.runs())
    say(f"{study.name}: {count} runs, {at_once} at once, {about(seconds)}")
    say(f"varying: {', '.join(study.axes) or 'nothing'}")


def compute_study(study: Study, folder: Path, *, quiet: bool, **options: Any) -> None:
    """Compute what is missing of a study, with a progress bar, and say where its results are."""
    with _outcome_as_exit_code(), _progress(quiet) as progress:
        study.compute(folder, progress=progress, **options)
    _finish(folder, [study.name], quiet)


@contextmanager
def _outcome_as_exit_code() -> Iterator[None]:
    try:
        yield
    except StudyInterrupted as interrupted:
        raise Stopped(str(interrupted)) from None


def _progress(quiet: bool) -> AbstractContextManager[Optional[Reporter]]:
    from snowshed.cli.display.study import announcement
    from snowshed.cli.progress import LONG_PERIOD_S, progress_bar

    return progress_bar(quiet=quiet, announce=announcement, speed_period_s=LONG_PERIOD_S)


def _draw(folder: Path, file: Optional[Path], name: Optional[str]) -> Path:
    """Write the picture of a study, and return its file."""
    from snowshed.plot.figure_style import save
    from snowshed.plot.study_figure import study_figure
    from snowshed.study.table import read_table

    with Store.open(folder) as store:
        found = store.named(name)
        axes = store.axes(found)
    picture_file = file or folder / "study.png"
    save(study_figure(read_table(folder, found), axes, found), picture_file)
    return picture_file


def _finish(folder: Path, names: list[str], quiet: bool) -> None:
    """Print where the results are; fail if runs have failed."""
    from snowshed.cli.display.study import print_failures

    with _outcome_as_exit_code(), Store.open(folder) as store:
        runs = {run.hash: run for name in names for run in store.runs(name)}
    failed = [run for run in runs.values() if run.status == "failed"]
    if not quiet:
        print_failures(failed, PlainConsole(soft_wrap=True))
        done = len(runs) - len(failed)
        say(f"{done} of {len(runs)} runs done")
        say(f"their table: snowshed study export {folder} -o table.csv")
        say(f"their picture: snowshed study picture {folder}")
    if failed:
        listed = ", ".join(run.hash[:12] for run in failed[:LISTED])
        listed += ", ..." if len(failed) > LISTED else ""
        raise Failed(f"{len(failed)} of {len(runs)} runs failed: {listed}")


def _warn_of_missing(folder: Path, name: Optional[str], quiet: bool) -> None:
    if quiet:
        return
    with Store.open(folder) as store:
        runs = store.runs(store.named(name))
    missing = sum(run.status == "pending" for run in runs)
    if missing:
        say(f"note: {missing} of {len(runs)} runs are not computed yet", err=True)
