"""The command ``snowshed grid``."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

import click

from snowshed.cli.options.common import PATH, quiet_option
from snowshed.cli.output.terminal import say


@click.command()
@click.argument("results", type=PATH)
@click.option(
    "-o",
    "--output",
    type=PATH,
    help="Folder for the files.  [default: grid in the results folder]",
)
@click.option(
    "--snapshots", is_flag=True, help="Write the snapshots instead of the ends of events."
)
@quiet_option
def grid(results: Path, output: Optional[Path], snapshots: bool, quiet: bool) -> None:
    """Write mass, velocity and density at the nodes of the grid as VTK images (.vti).

    The fields are computed from the stored particles of a run by the material point method.
    """
    from snowshed.results.grid_export import export_grids

    for file in export_grids(results, output, snapshots=snapshots):
        if not quiet:
            say(f"{file}: {file.stat().st_size / 1e6:.1f} MB")
