"""Refusal of options that would have no effect."""

from __future__ import annotations

from collections.abc import Sequence

import click
from click.core import ParameterSource


def refuse_without_effect(names: Sequence[str], reason: str) -> None:
    """Refuse options of the current command that are given, because they would be ignored.

    Parameters
    ----------
    names
        Parameters of the command.
    reason
        Reason why they are ineffective, such as "without --range".

    Raises
    ------
    click.UsageError
        Naming the first such option.
    """
    refuse_given(names, f"has no effect {reason}")


def refuse_given(names: Sequence[str], complaint: str) -> None:
    """Refuse options of the current command that are given; the complaint follows their name.

    Raises
    ------
    click.UsageError
        Naming the first such option.
    """
    context = click.get_current_context()
    for parameter in context.command.params:
        name = str(parameter.name)
        if name in names and context.get_parameter_source(name) is ParameterSource.COMMANDLINE:
            raise click.UsageError(f"{longest_name(parameter)} {complaint}")


def longest_name(parameter: click.Parameter) -> str:
    """Return the longest name of an option, such as ``--output``."""
    return max(parameter.opts, key=len)
