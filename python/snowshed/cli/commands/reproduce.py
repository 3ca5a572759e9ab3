"""The command ``snowshed reproduce``, which comes with the source and not with the package."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from snowshed.cli.deferred import Deferred

#: Folder of the source, if the package is used in place.
SOURCE = Path(__file__).parents[4]
PACKAGE = "thesis"


class FromSource(Deferred):
    """A command that a package of the source defines, where the source is at hand."""

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
            return super().load()
        except ModuleNotFoundError as error:
            if error.name not in (PACKAGE, f"{PACKAGE}.command"):
                raise
            raise click.UsageError(
                f"{self.name} comes with the source of snowshed, not with the installed package: "
                f"run `make {PACKAGE}` there"
            ) from None


reproduce = FromSource("reproduce", f"{PACKAGE}.command", "")
