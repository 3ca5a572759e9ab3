"""The command ``snowshed extend``."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

import click

from snowshed.cli.exit_codes import Stopped
from snowshed.cli.options.common import PATH, quiet_option


@click.command()
@click.argument("results", type=PATH)
@click.option("--events", type=int, default=1, show_default=True, help="Number of further events.")
@click.option("--snow", metavar="NAME", help="Other snow for their slabs: a name, or a JSON file.")
@click.option("--thickness", type=float, help="Other thickness for their slabs [m].")
@click.option(
    "-o", "--output", "folder", type=PATH, required=True, help="Results folder, new or empty."
)
@quiet_option
def extend(
    results: Path,
    events: int,
    snow: Optional[str],
    thickness: Optional[float],
    folder: Path,
    quiet: bool,
) -> None:
    """Add slide-offs to a finished run, in a new folder; RESULTS stays as it is.

    \b
    Example:
      snowshed extend results --events 3 -o longer
      snowshed extend results --snow reference --thickness 0.03 -o other
    """  # noqa: D301 - click wants the control character
    from snowshed.base.interrupt import Interrupted
    from snowshed.cli.output.progress import progress_bar
    from snowshed.cli.output.results import print_events
    from snowshed.results.reader import Results
    from snowshed.running.extension import extend_run
    from snowshed.scene.components import Snow

    other = None if snow is None else Snow.preset_or_file(snow)
    try:
        with progress_bar(quiet=quiet) as progress:
            extend_run(results, folder, events, snow=other, thickness=thickness, progress=progress)
    except Interrupted as interrupted:
        raise Stopped(str(interrupted)) from None
    if not quiet:
        print_events(Results(folder))
