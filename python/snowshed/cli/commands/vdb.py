"""The command ``snowshed vdb``."""

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
    help="Folder for the files.  [default: vdb in the results folder]",
)
@click.option(
    "--snapshots", is_flag=True, help="Write the snapshots instead of the stack after events."
)
@click.option("--width", type=float, help="Width of the strip for 2D results [m].")
@quiet_option
def vdb(
    results: Path, output: Optional[Path], snapshots: bool, width: Optional[float], quiet: bool
) -> None:
    """Write the snow of a results folder as OpenVDB files.

    Each file holds the stack as a level set, its density as a fog volume, and the particles as
    points.
    """
    from snowshed.results.vdb_export import Exported, export_folder

    def show(exported: Exported) -> None:
        content = exported.content
        say(
            f"{exported.file}: {content.mass:.4g} kg in {content.volume:.4g} m3, "
            f"{content.density:.0f} kg/m3, {content.surface_voxels:,} + "
            f"{content.density_voxels:,} voxels"
        )

    report = None if quiet else show
    export_folder(results, output, snapshots=snapshots, width=width, report=report)
