"""The option of the commands that read weather files."""

from __future__ import annotations

from pathlib import Path

import click

temperature_option = click.option(
    "--temperature",
    metavar="FILE",
    type=click.Path(path_type=Path),
    help="Another weather file of the station, whose temperatures come first; or a table with the "
    "columns date and temperature_c.",
)
