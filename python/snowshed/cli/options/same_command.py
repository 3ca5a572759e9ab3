"""The command line of this process, so that a hint can repeat it."""

from __future__ import annotations

from collections.abc import Iterator

import click
from click.core import ParameterSource

from snowshed.base.paths import shell_words
from snowshed.cli.options.no_effect import longest_name


def same_command(*more: str) -> str:
    """Return the current command with further options, quoted for a shell.

    Options are not repeated. Outside a command, the result has only the program and the options.
    """
    context = click.get_current_context(silent=True)
    if context is None:
        return shell_words("snowshed", *more)
    arguments = context.command_path.split()
    for parameter in context.command.params:
        source = context.get_parameter_source(str(parameter.name))
        if source is ParameterSource.COMMANDLINE:
            arguments += _argument_texts(parameter, context.params.get(str(parameter.name)))
    return shell_words(*arguments, *(word for word in more if word not in arguments))


def _argument_texts(parameter: click.Parameter, value: object) -> Iterator[str]:
    """Return the arguments that give a parameter its value."""
    if isinstance(parameter, click.Option) and parameter.is_flag:
        yield (
            parameter.opts if value or not parameter.secondary_opts else parameter.secondary_opts
        )[0]
        return
    values = value if isinstance(value, (tuple, list)) else [value]
    for each in values:
        if isinstance(parameter, click.Option):
            yield longest_name(parameter)
        yield str(each)
