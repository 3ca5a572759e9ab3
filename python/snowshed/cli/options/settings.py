"""Options for the settings of a method and the parts of its scenes, from the schema."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any, TypeVar

import click

from snowshed.scene.schema import Parameter, scene_parameters

Command = TypeVar("Command", bound=Callable[..., Any])

KINDS = {"number": float, "integer": int}


def settings_options(
    method: str, section: str = "numerics", *, without: Collection[str] = ()
) -> Callable[[Command], Command]:
    """Return a decorator that adds options for the parameters of a section of a method's scenes.

    Parameters
    ----------
    method
        Name of the method.
    section
        Name of the section.
    without
        Names of parameters without an option.
    """

    def decorate(command: Command) -> Command:
        for parameter in reversed(scene_parameters(method)):
            held_in, _, name = parameter.path.rpartition(".")
            if held_in == section and name not in without:
                command = _option(parameter, name)(command)
        return command

    return decorate


def _option(parameter: Parameter, name: str) -> Callable[[Command], Command]:
    unit = f" [{parameter.unit}]" if parameter.unit else ""
    text = f"{parameter.description}{unit}."
    flag = "--" + name.replace("_", "-")
    if parameter.kind == "boolean":
        return click.option(f"{flag}/--no-{flag[2:]}", name, default=None, help=text)
    if parameter.choices:
        return click.option(flag, name, type=click.Choice(parameter.choices), help=text)
    return click.option(flag, name, type=KINDS[parameter.kind], help=text)
