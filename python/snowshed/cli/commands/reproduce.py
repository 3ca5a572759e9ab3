"""The command ``snowshed reproduce``: publications whose reproduction comes with the source."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import click

from snowshed.cli.deferred import Deferred

#: Folder of the source, if the package is imported from there.
SOURCE = Path(__file__).parents[4]
COMMON = "reproductions.common.command"
#: The packages in the source, their former names, and their lines in the list of commands.
PUBLICATIONS = (
    ("frischholz2023", "thesis", "Chapters 3 to 5 of the thesis on snow that slides off panels."),
    (
        "hagenmuller2015",
        "hagenmuller",
        "Claims of a paper on discrete elements about the compression of snow.",
    ),
    ("saito2012", "saito", "Claims of a paper on the moving particle method about avalanches."),
)


class FromSource(Deferred):
    """A command that a package of the source declares, if the source is available.

    Parameters
    ----------
    name
        Name of the command.
    package
        Name of the package in ``reproductions``.
    short_help
        Its line in the list of commands; empty: not in the list.
    """

    def __init__(self, name: str, package: str, short_help: str = "") -> None:
        super().__init__(name, COMMON, short_help)
        self.hidden = not short_help
        self._package = package

    def load(self) -> click.Command:
        """Import and return the command.

        Raises
        ------
        click.UsageError
            If the source is not available.
        """
        if (SOURCE / "reproductions" / "__init__.py").is_file() and str(SOURCE) not in sys.path:
            sys.path.append(str(SOURCE))
        try:
            common = importlib.import_module(COMMON)
        except ModuleNotFoundError as error:
            if not COMMON.startswith(str(error.name)):
                raise
            raise click.UsageError(
                f"reproduce {self.name} comes with the source of snowshed, not with the installed "
                "package: run `make build` there"
            ) from None
        command: click.Command = common.command_of(self._package, str(self.name))
        return command


@click.group()
def reproduce() -> None:
    """Reproduce a publication: its tables and figures, and verdicts on its claims.

    \b
    Examples:
      snowshed reproduce frischholz2023 --quick -o thesis
      snowshed reproduce hagenmuller2015 --quick -o grains
      snowshed reproduce saito2012 --quick -o avalanches
    """  # noqa: D301 - click wants the control character


for package, former, short_help in PUBLICATIONS:
    reproduce.add_command(FromSource(package, package, short_help))
    reproduce.add_command(FromSource(former, package))
