"""The commands ``snowshed scene`` and ``snowshed schema``, which describe a scene."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Optional

import click

import snowshed._core as _core
from snowshed.cli.options.accuracy import accuracy_option
from snowshed.cli.options.common import PATH, quiet_option
from snowshed.cli.options.resolve import resolve_options
from snowshed.cli.options.scene import scene_options
from snowshed.cli.output.dry_run import issue_notes
from snowshed.cli.output.terminal import write_out


@click.command()
@click.option("-o", "--output", "file", type=PATH, help="File to write.  [default: stdout]")
@quiet_option
@accuracy_option
@scene_options
def scene(
    file: Optional[Path],
    quiet: bool,
    accuracy: Optional[float],
    preset: Optional[str],
    snow_preset: Optional[str],
    **options: Any,
) -> None:
    """Write the scene that the same options of ``panel`` would run."""
    resolved = resolve_options(preset, snow_preset, options, accuracy, quiet=quiet)
    issue_notes(resolved)
    if file is None:
        write_out(resolved.json)
    else:
        resolved.save(file)


@click.command()
def schema() -> None:
    """Print the JSON Schema of a scene."""
    write_out(_core.scene_schema())
