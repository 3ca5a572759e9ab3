"""The option ``--check``: the error of a stack, measured on coarser grids and with other seeds."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

import click

from snowshed._core import InputError
from snowshed.cli.compute_study import outcome_as_exit_code, study_progress
from snowshed.cli.output.terminal import say
from snowshed.scene.scene import ResolvedScene

check_option = click.option(
    "--check",
    is_flag=True,
    help="Measure the error of the stack with nine more runs: three grids, three seeds each.",
)


def check_can_be_measured(scene: ResolvedScene) -> None:
    """Raise InputError, before anything is run, if the error of a scene cannot be measured."""
    from snowshed.analysis.accuracy.companions import check_has_companions

    try:
        check_has_companions(scene)
    except InputError as error:
        raise InputError(f"--check: {error}") from None


def check_run(folder: Path, quiet: bool) -> None:
    """Run the companions of the scene in a results folder, and print and store the errors."""
    from snowshed.analysis.accuracy.companions import measured_errors
    from snowshed.io.atomic import write_text
    from snowshed.scene.scene import Scene

    scene = Scene.load(folder / "scene.json")
    with outcome_as_exit_code(), study_progress(quiet) as progress:
        errors = measured_errors(scene, folder / "check", progress=progress)
    data = [{**asdict(error), "bias": error.bias} for error in errors]
    write_text(folder / "check.json", json.dumps(data, indent=2) + "\n")
    if not quiet:
        say("error of the stack, measured on three grids with three seeds each:")
        for error in errors:
            say(f"  {error.sentence}")
