"""The commands that run one scene: ``snowshed panel|run``."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, Optional, TypeVar

import click

from snowshed.cli.accuracy import accuracy_option
from snowshed.cli.commands.scene import resolve_options
from snowshed.cli.quiet import quiet_option
from snowshed.cli.run_scene import run_scene
from snowshed.cli.scene_options import scene_options
from snowshed.scene.scene import ResolvedScene

Command = TypeVar("Command", bound=Callable[..., Any])

PATH = click.Path(path_type=Path)


def run_options(command: Command, *, required: bool = True) -> Command:
    """Add the options of commands that run a scene; `required` says whether -o must be given."""
    for option in (
        quiet_option,
        click.option("--resume", is_flag=True, help="Go on from the checkpoint in the folder."),
        click.option(
            "-o",
            "--output",
            "folder",
            type=PATH,
            required=required,
            help="Results folder, new or empty.",
        ),
    ):
        command = option(command)
    return command


@click.command()
@run_options
@accuracy_option
@scene_options
def panel(
    folder: Path,
    resume: bool,
    quiet: bool,
    accuracy: Optional[float],
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
    ready = resolve_options(preset, snow_preset, options, accuracy, quiet=quiet)
    run_scene(ready, folder, resume, quiet)


@click.command()
@click.argument("scene", type=PATH)
@run_options
def run(scene: Path, folder: Path, resume: bool, quiet: bool) -> None:
    """Run a scene file."""
    run_scene(ResolvedScene.load(scene), folder, resume, quiet)
