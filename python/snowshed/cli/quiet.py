"""The option `--quiet`, the same for every command."""

from __future__ import annotations

import warnings

import click

from snowshed.base.notes import SnowshedNote


def _silence(context: click.Context, parameter: click.Parameter, quiet: bool) -> bool:
    """Drop notes, too; `main` restores the filters of warnings when the command ends."""
    if quiet:
        warnings.simplefilter("ignore", SnowshedNote)
    return quiet


quiet_option = click.option(
    "-q", "--quiet", is_flag=True, callback=_silence, help="Print nothing but errors."
)
#: The same of a command that prints nothing itself, except what it is asked for.
quiet_notes_option = click.option(
    *("-q", "--quiet"),
    is_flag=True,
    callback=_silence,
    expose_value=False,
    help="Print no notes.",
)
