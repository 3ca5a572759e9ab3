"""The command ``snowshed reproduce``, which comes with the source and not with the package."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path
from typing import Any, Optional

import click

#: Where the source lies, of a package that is used in place.
SOURCE = Path(__file__).parents[4]
PACKAGE = "thesis"


class FromSource(click.Command):
    """A command that a package of the source defines, and that takes over if it is there."""

    def make_context(
        self,
        info_name: Optional[str],
        args: list[str],
        parent: Optional[click.Context] = None,
        **extra: Any,
    ) -> click.Context:
        """Return the context of the command itself."""
        return self.load().make_context(info_name, args, parent, **extra)

    def load(self) -> click.Command:
        """Return the command itself.

        Raises
        ------
        click.UsageError
            If the source is not at hand.
        """
        if (SOURCE / PACKAGE / "__init__.py").is_file() and str(SOURCE) not in sys.path:
            sys.path.append(str(SOURCE))
        try:
            module = importlib.import_module(f"{PACKAGE}.command")
        except ModuleNotFoundError as error:
            if error.name not in (PACKAGE, f"{PACKAGE}.command"):
                raise
            raise click.UsageError(
                f"{self.name} comes with the source of snowshed, not with the installed package: "
                f"run `make {PACKAGE}` there"
            ) from None
        command: click.Command = getattr(module, str(self.name))
        return command


reproduce = FromSource("reproduce")
