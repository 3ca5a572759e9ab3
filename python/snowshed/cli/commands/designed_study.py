"""Studies that a command designs, computes and evaluates.

The design is saved as a study file beside the results. Its runs are computed, stored and resumed
like those of ``snowshed study run``. The evaluation needs only the store.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Optional, TypeVar

import click

from snowshed.cli.compute_study import compute_study, print_study_cost
from snowshed.cli.options.common import (
    PATH,
    dry_run_option,
    jobs_option,
    quiet_option,
    resume_option,
    same_version_option,
)
from snowshed.cli.options.no_effect import longest_name, refuse_given, refuse_without_effect
from snowshed.snow.stack.quantities import MEASURES
from snowshed.study.definition import Study

Command = TypeVar("Command", bound=Callable[..., Any])

STUDY = "study.toml"
RUNS = "runs"
#: Options without effect beside another one, by the names of their parameters.
IGNORED_OPTIONS: Mapping[str, Sequence[str]] = {
    "stored": ["file", "dry_run", "quick", "seeds", "samples", "jobs"],
    "file": ["quick", "seeds", "samples"],
}


def measure_help() -> str:
    """Return the help text on the values of ``--measure``."""
    return " or ".join(f"{measure.name} ({measure.label})" for measure in MEASURES.values()) + "."


def design_options(default_seeds: str) -> Callable[[Command], Command]:
    """Return a decorator that adds the options of commands which design and evaluate a study.

    Parameters
    ----------
    default_seeds
        The default of ``--seeds`` in the help.
    """

    def with_options(command: Command) -> Command:
        for option in _options(default_seeds):
            command = option(command)
        return command

    return with_options


def _options(default_seeds: str) -> Sequence[Callable[[Command], Command]]:
    return (
        quiet_option,
        jobs_option("Runs"),
        same_version_option,
        click.option(
            "--measure",
            type=click.Choice(list(MEASURES)),
            default="stack",
            help=f"{measure_help()}  [default: stack]",
        ),
        click.option("--name", help="Name of the stored study, if its folder holds several."),
        click.option(
            "--stored", type=PATH, help="Folder of a stored study: evaluate it, compute nothing."
        ),
        click.option("--study", "file", type=PATH, help="Study file to compute instead."),
        resume_option,
        dry_run_option("Print the number of runs and their estimated time and exit."),
        click.option(
            "--seeds", type=int, help=f"Random seeds per point.  [default: {default_seeds}]"
        ),
        click.option(
            "--quick", is_flag=True, help="A small study on a coarse 2D grid: minutes, not days."
        ),
        click.option("-o", "--output", "folder", type=PATH, help="Results folder, old or new."),
    )


def check_options(context: click.Context) -> Path:
    """Return the results folder; refuse a missing folder and options without effect.

    Raises
    ------
    click.UsageError
        Naming the option.
    """
    folder: Optional[Path] = context.params["folder"]
    if folder is None:
        raise click.UsageError("give -o DIR, the folder of the results")
    names = {parameter.name: longest_name(parameter) for parameter in context.command.params}
    for option, useless in IGNORED_OPTIONS.items():
        if context.params[option] is not None:
            refuse_without_effect(useless, f"with {names[option]}")
    if context.params["stored"] is None:
        refuse_given(["name"], "needs --stored")
    return folder


def chosen_study(context: click.Context, folder: Path, design: Callable[[], Study]) -> Study:
    """Return the study of the given file, or the designed one, which is saved in the folder."""
    file: Optional[Path] = context.params["file"]
    if file is not None:
        return Study.load(file)
    study = design()
    folder.mkdir(parents=True, exist_ok=True)
    study.save(folder / STUDY)
    return study


def compute_missing_runs(
    context: click.Context, study: Study, folder: Path
) -> Optional[tuple[Path, str]]:
    """Compute the missing runs of a study; return the folder of its store, and its name there.

    Returns None after a dry run. If runs fail or are interrupted, the command ends with the exit
    codes of ``snowshed study run``, and the same command resumes.
    """
    jobs, quiet, same_version = (context.params[name] for name in ("jobs", "quiet", "same_version"))
    if context.params["dry_run"]:
        print_study_cost(study, jobs)
        return None
    compute_study(study, folder / RUNS, quiet=quiet, jobs=jobs, same_version=same_version)
    return folder / RUNS, study.name
