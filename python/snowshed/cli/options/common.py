"""Options that many commands share: --quiet, --resume, --dry-run and the results folder."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Optional, TypeVar

import click

from snowshed.base.notes import SnowshedNote
from snowshed.base.paths import with_home

Command = TypeVar("Command", bound=Callable[..., Any])


class HomePath(click.Path):
    """A file or folder; ``~`` is the user's home also where the shell does not replace it.

    Public functions replace it, too (`snowshed.base.arguments.checked`), but commands look at files
    before they call functions.
    """

    name = "path"

    def convert(
        self, value: Any, param: Optional[click.Parameter], ctx: Optional[click.Context]
    ) -> Any:
        """Return the path; an empty one, such as that of an unset variable, is refused."""
        if not os.fspath(value):
            self.fail("the path is empty", param, ctx)
        return super().convert(with_home(os.fspath(value)), param, ctx)


PATH = HomePath(path_type=Path)


def _silence(context: click.Context, parameter: click.Parameter, quiet: bool) -> bool:
    """Drop notes, too; `main` restores the filters of warnings when the command ends."""
    if quiet:
        warnings.simplefilter("ignore", SnowshedNote)
    return quiet


quiet_option = click.option(
    "-q", "--quiet", is_flag=True, callback=_silence, help="Print nothing but errors."
)
#: The same option for a command that prints only its result.
quiet_notes_option = click.option(
    *("-q", "--quiet"),
    is_flag=True,
    callback=_silence,
    expose_value=False,
    help="Print no notes.",
)
#: For commands that always resume: they accept the option, because other commands need it.
resume_option = click.option(
    "--resume",
    is_flag=True,
    expose_value=False,
    help="Continue an interrupted computation.  [always on]",
)


def resume_flag(text: str) -> Callable[[Command], Command]:
    """Return the decorator that adds ``--resume`` to a command that resumes only on request."""
    return click.option("--resume", is_flag=True, help=text)


def jobs_option(units: str) -> Callable[[Command], Command]:
    """Return the decorator that adds ``--jobs``, the number of `units` in parallel."""
    text = f"{units} at once.  [default: the number of cores]"
    return click.option("--jobs", type=int, help=text)


same_version_option = click.option(
    "--same-version-is-enough",
    "same_version",
    is_flag=True,
    help="Use results of another build of this version.  [default: compute them again]",
)


class Renamed(click.Option):
    """An option whose help shows only its first spelling; the others are former spellings."""

    def get_help_record(self, ctx: click.Context) -> Optional[tuple[str, str]]:
        """Return the line of the help."""
        spellings = self.opts
        self.opts = spellings[:1]
        try:
            return super().get_help_record(ctx)
        finally:
            self.opts = spellings


def dry_run_option(
    text: str = "Print the estimated run time and exit.",
) -> Callable[[Command], Command]:
    """Return the decorator that adds ``--dry-run``; ``--plan`` is its former spelling."""
    return click.option(
        "--dry-run", "--plan", "dry_run", is_flag=True, is_eager=True, cls=Renamed, help=text
    )


class ResultsFolder(click.Option):
    """A results folder that must be given, except for a dry run."""

    def process_value(self, ctx: click.Context, value: Any) -> Any:
        """Return the folder; None if a dry run needs none."""
        if ctx.params.get("dry_run") and self.value_is_missing(value):
            return None
        return super().process_value(ctx, value)


def run_options(command: Command, *, required: bool = True) -> Command:
    """Add the options of commands that run a scene; `required` says whether -o must be given."""
    for option in (
        quiet_option,
        dry_run_option("Print the features, memory and run time of the scene and exit."),
        resume_flag("Resume from the checkpoint in the folder."),
        click.option(
            "-o",
            "--output",
            "folder",
            type=PATH,
            required=required,
            cls=ResultsFolder,
            help="Results folder, new or empty.",
        ),
    ):
        command = option(command)
    return command


def given_values(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options that are given, by their names.

    Examples
    --------
    >>> given_values({"seed": 0, "density": None})
    {'seed': 0}
    """
    return {name: value for name, value in values.items() if value is not None}
