"""Commands that are imported on first use."""

from __future__ import annotations

import importlib
from typing import Any, Optional

import click


class Deferred(click.Command):
    """A command, or group of commands, that is imported on first use, so that others start quickly.

    Parameters
    ----------
    name
        Name of the command.
    module
        Module that defines it.
    short_help
        Its line in the list of commands.
    command
        Name of the command in the module. [default: `name`]
    hidden
        Whether the list of commands leaves it out.
    """

    def __init__(
        self,
        name: str,
        module: str,
        short_help: str = "",
        *,
        command: Optional[str] = None,
        hidden: bool = False,
    ) -> None:
        super().__init__(name, short_help=short_help, hidden=hidden)
        self._module = module
        self._function = (command or name).replace("-", "_")

    def make_context(
        self,
        info_name: Optional[str],
        args: list[str],
        parent: Optional[click.Context] = None,
        **extra: Any,
    ) -> click.Context:
        """Return the context of the imported command."""
        return self.load().make_context(info_name, args, parent, **extra)

    def load(self) -> click.Command:
        """Import and return the command."""
        command: click.Command = getattr(importlib.import_module(self._module), self._function)
        return command
