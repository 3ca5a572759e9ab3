"""The command ``snowshed maps``."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

import click

from snowshed.cli.options.common import PATH, quiet_option
from snowshed.cli.output.terminal import say


@click.command()
@click.argument("results", type=PATH)
@click.option(
    *("-o", "--output", "file"), type=PATH, help="File to write.  [default: maps.nc in RESULTS]"
)
@quiet_option
def maps(results: Path, file: Optional[Path], quiet: bool) -> None:
    """Write the maps of a slide as NetCDF, with coordinates, units and the map projection.

    \b
    Example:
      snowshed maps slide -o slide.nc
    """  # noqa: D301 - click wants the control character
    from snowshed.results.map_export import write_maps

    written = write_maps(results, file or results / "maps.nc")
    if not quiet:
        say(f"{written}: {written.stat().st_size / 1e6:.1f} MB")
