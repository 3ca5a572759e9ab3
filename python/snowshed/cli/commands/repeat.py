"""The command ``snowshed repeat``: slow modules are imported when it runs."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

import click

from snowshed._core import InputError
from snowshed.cli.options.common import PATH, jobs_option, quiet_option
from snowshed.io.input_file import read_input
from snowshed.results.computed_record import (
    CLEARANCE,
    SEASON,
    is_computed_record,
    read_record,
)


@click.command()
@click.argument("record", type=PATH)
@click.option(
    *("-o", "--output", "folder"), type=PATH, required=True, help="Results folder, new or empty."
)
@click.option("--resume", is_flag=True, help="Resume after an interruption.")
@jobs_option("Runs")
@quiet_option
def repeat(record: Path, folder: Path, resume: bool, jobs: Optional[int], quiet: bool) -> None:
    """Compute a run, a study, a season or a clearance again from its record alone.

    RECORD is the run.json of a run, the NAME.json of a study, the season.json of a season, or the
    clearance.json of a clearance. A note says if the build, or a file that it names, has changed.

    \b
    Examples:
      snowshed repeat results/run.json -o again
      snowshed repeat study/cohesion-and-slope.json -o again
    """  # noqa: D301 - click wants the control character
    if not is_computed_record(read_input(record)):
        _repeat_run(record, folder, resume=resume, quiet=quiet)
        return
    kind, content = read_record(record)
    if kind == CLEARANCE:
        from snowshed.analysis.clearance.inputs import recorded_clearance
        from snowshed.cli.commands.clearance import answer_and_report

        inputs = recorded_clearance(content, record)
        notes = [*inputs.weather.notes, *inputs.weather.winters(inputs.coverage).notes]
        answer_and_report(inputs, folder, notes, quiet=quiet, jobs=jobs)
    elif kind == SEASON:
        from snowshed.cli.commands.season import print_season, simulate_with_progress
        from snowshed.season.repeated import recorded_season

        plan, settings = recorded_season(content, record)
        result = simulate_with_progress(plan, folder, settings, resume=resume, quiet=quiet)
        if not quiet:
            print_season(result, folder, plan.panel)
    else:
        from snowshed.cli.compute_study import compute_study
        from snowshed.study.definition import Study

        compute_study(Study.load(record), folder, quiet=quiet, jobs=jobs)


def _repeat_run(record: Path, folder: Path, *, resume: bool, quiet: bool) -> None:
    from snowshed.cli.run_scene import run_scene
    from snowshed.running.recorded_run import recorded_run
    from snowshed.scene.scene import ResolvedScene

    recorded = recorded_run(record)
    if recorded is None:
        raise InputError(f"{record}: no record of a run, a study, a season or a clearance")
    run_scene(ResolvedScene.load(record), folder, resume, quiet, recorded=recorded)
