"""Commands that are imported when they are used."""

from __future__ import annotations

import importlib
from typing import Any, Optional

import click


class Deferred(click.Command):
    """A command, or group of commands, that is imported when it is used; all others start quickly.

    Parameters
    ----------
    name
        As of the command it stands for, and of the function that makes it.
    module
        The module that defines it.
    short_help
        What the list of commands says of it, which does not import it.
    """

    def __init__(self, name: str, module: str, short_help: str) -> None:
        super().__init__(name, short_help=short_help)
        self._module = module

    def make_context(
        self,
        info_name: Optional[str],
        args: list[str],
        parent: Optional[click.Context] = None,
        **extra: Any,
    ) -> click.Context:
        """Return the context of the command itself, which takes over from here."""
        return self.load().make_context(info_name, args, parent, **extra)

    def load(self) -> click.Command:
        """Return the command itself."""
        command: click.Command = getattr(importlib.import_module(self._module), str(self.name))
        return command
