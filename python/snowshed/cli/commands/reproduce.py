"""The command ``snowshed reproduce``; the reproductions come with the source."""

from __future__ import annotations

import sys
from pathlib import Path

import click

from snowshed.cli.deferred import Deferred

#: Folder of the source, if the package is imported from there.
SOURCE = Path(__file__).parents[4]


class FromSource(Deferred):
    """A command that a package of the source defines."""

    def load(self) -> click.Command:
        """Import and return the command.

        Raises
        ------
        click.UsageError
            If the source is not available.
        """
        package = str(self.name)
        if (SOURCE / package / "__init__.py").is_file() and str(SOURCE) not in sys.path:
            sys.path.append(str(SOURCE))
        try:
            return super().load()
        except ModuleNotFoundError as error:
            if error.name not in (package, f"{package}.command"):
                raise
            raise click.UsageError(
                f"reproduce {package} comes with the source of snowshed, not with the installed "
                "package: run `make build` there"
            ) from None


@click.group()
def reproduce() -> None:
    """Reproduce a publication: its tables and figures, and verdicts on its claims.

    \b
    Examples:
      snowshed reproduce thesis --quick -o thesis
      snowshed reproduce hagenmuller --quick -o grains
      snowshed reproduce saito --quick -o avalanches
    """  # noqa: D301 - click wants the control character


for name, short_help in (
    ("thesis", "Chapters 3 to 5 of the thesis on snow that slides off panels."),
    ("hagenmuller", "Claims of a paper on discrete elements about the compression of snow."),
    ("saito", "Claims of a paper on the moving particle method about avalanches."),
):
    reproduce.add_command(FromSource(name, f"{name}.command", short_help))
