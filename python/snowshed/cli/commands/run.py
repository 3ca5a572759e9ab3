"""The command ``snowshed run``, and ``plan``, the former name of its dry run."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

import click

from snowshed.cli.options.accuracy import accuracy_option
from snowshed.cli.options.check import check_option
from snowshed.cli.options.common import PATH, run_options
from snowshed.cli.options.resolve import with_accuracy
from snowshed.cli.output.dry_run import print_cost
from snowshed.cli.run_scene import run_or_cost
from snowshed.running.recorded_run import note_run_beside, recorded_run
from snowshed.scene.scene import ResolvedScene, Scene


@click.command()
@click.argument("scene", type=PATH)
@run_options
@accuracy_option
@check_option
@click.option("--forces", is_flag=True, help="Record the forces on what the snow meets.")
def run(
    scene: Path,
    folder: Path,
    resume: bool,
    dry_run: bool,
    quiet: bool,
    accuracy: Optional[float],
    check: bool,
    forces: bool,
) -> None:
    """Run a scene file.

    \b
    Examples:
      snowshed run scene.json --dry-run
      snowshed run scene.json -o results
    """  # noqa: D301 - click wants the control character
    resolved = _resolve_file(scene, accuracy, forces=forces, quiet=quiet)
    recorded = recorded_run(scene)
    if recorded is None:
        note_run_beside(scene, as_it_was=resume)
    run_or_cost(
        resolved, folder, resume=resume, dry_run=dry_run, quiet=quiet, check=check,
        recorded=recorded,
    )  # fmt: skip


@click.command(hidden=True)
@click.argument("scene", type=PATH)
@accuracy_option
def plan(scene: Path, accuracy: Optional[float]) -> None:
    """Print the features and the cost of a scene file; see ``run --dry-run``."""
    print_cost(_resolve_file(scene, accuracy, forces=False, quiet=False))


def _resolve_file(
    file: Path, accuracy: Optional[float], *, forces: bool, quiet: bool
) -> ResolvedScene:
    if accuracy is None and not forces:
        return ResolvedScene.load(file)
    scene = Scene.load(file)
    if forces:
        scene.set("output.forces", True)
    return (scene if accuracy is None else with_accuracy(scene, accuracy, quiet=quiet)).resolve()
