"""Commands that are imported when they are used."""

from __future__ import annotations

import importlib
from typing import Any, Optional

import click


class Deferred(click.Command):
    """A command, or group of commands, that is imported when it is used, so that others start fast.

    Parameters
    ----------
    name
        Name of the command, and of its function in the module.
    module
        The module that defines it.
    short_help
        Its line in the list of commands, for which it is not imported.
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
