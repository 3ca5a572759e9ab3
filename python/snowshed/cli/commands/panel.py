"""The command ``snowshed panel``."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Optional

import click

from snowshed.cli.options.accuracy import accuracy_option
from snowshed.cli.options.check import check_option
from snowshed.cli.options.common import run_options
from snowshed.cli.options.resolve import resolve_options
from snowshed.cli.options.scene import scene_options
from snowshed.cli.run_scene import run_or_cost


@click.command()
@run_options
@accuracy_option
@check_option
@scene_options
def panel(
    folder: Path,
    resume: bool,
    dry_run: bool,
    quiet: bool,
    accuracy: Optional[float],
    check: bool,
    preset: Optional[str],
    snow_preset: Optional[str],
    **options: Any,
) -> None:
    """Run slide-offs from a panel described by options.

    \b
    Example:
      snowshed panel --height 0.33 --length 0.245 --width 0.213 --tilt 50 \\
          --thickness 0.02 --events 5 --dim 3 --friction 0.3 -o results
    """  # noqa: D301 - click wants the control character
    scene = resolve_options(preset, snow_preset, options, accuracy, quiet=quiet)
    run_or_cost(scene, folder, resume=resume, dry_run=dry_run, quiet=quiet, check=check)
