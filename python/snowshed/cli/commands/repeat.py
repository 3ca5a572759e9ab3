"""The command ``snowshed repeat``: slow modules are imported when it runs."""

from __future__ import annotations

from pathlib import Path
from typing import Optional

import click

from snowshed._core import InputError
from snowshed.cli.options.common import (
    PATH,
    ResultsFolder,
    dry_run_option,
    jobs_option,
    quiet_option,
    resume_flag,
)
from snowshed.io.input_file import read_input
from snowshed.results.computed_record import CLEARANCE, SEASON, record_kind

#: Names of records; that of a study has the study's name.
RECORDS = ("clearance.json", "season.json", "run.json")


@click.command()
@click.argument("record", type=PATH)
@click.option(
    *("-o", "--output", "folder"),
    type=PATH,
    required=True,
    cls=ResultsFolder,
    help="Results folder, new or empty.",
)
@resume_flag("Resume after an interruption.")
@dry_run_option()
@jobs_option("Runs")
@quiet_option
def repeat(
    record: Path, folder: Path, resume: bool, dry_run: bool, jobs: Optional[int], quiet: bool
) -> None:
    """Compute a run, a study, a season or a clearance again from its record alone.

    RECORD is the run.json of a run, the NAME.json of a study, the season.json of a season, or the
    clearance.json of a clearance. A note says if the build, or a file that it names, has changed.

    \b
    Examples:
      snowshed repeat results/run.json -o again
      snowshed repeat study/cohesion-and-slope.json -o again
    """  # noqa: D301 - click wants the control character
    _check_is_file(record)
    kind = record_kind(read_input(record))
    if kind is None:
        _repeat_run(record, folder, resume=resume, dry_run=dry_run, quiet=quiet)
    elif kind == CLEARANCE:
        _repeat_clearance(record, folder, dry_run=dry_run, jobs=jobs, quiet=quiet)
    elif kind == SEASON:
        _repeat_season(record, folder, resume=resume, dry_run=dry_run, quiet=quiet)
    else:
        from snowshed.cli.compute_study import compute_study, print_study_cost
        from snowshed.study.definition import Study

        study = Study.load(record)
        if dry_run:
            print_study_cost(study, jobs)
        else:
            compute_study(study, folder, quiet=quiet, jobs=jobs)


def _check_is_file(record: Path) -> None:
    """Raise an InputError for a folder, which names the records in it."""
    if not record.is_dir():
        return
    records = [name for name in RECORDS if (record / name).is_file()]
    advice = f"give {record / records[0]}" if records else "give the record of a result"
    raise InputError(f"{record}: a folder; {advice}")


def _repeat_run(record: Path, folder: Path, *, resume: bool, dry_run: bool, quiet: bool) -> None:
    from snowshed.cli.run_scene import run_or_cost
    from snowshed.running.recorded_run import recorded_run
    from snowshed.scene.scene import ResolvedScene

    recorded = recorded_run(record)
    if recorded is None:
        raise InputError(f"{record}: no record of a run, a study, a season or a clearance")
    scene = ResolvedScene.load(record)
    run_or_cost(scene, folder, resume=resume, dry_run=dry_run, quiet=quiet, recorded=recorded)


def _repeat_season(record: Path, folder: Path, *, resume: bool, dry_run: bool, quiet: bool) -> None:
    from snowshed.cli.commands.season import (
        print_plan_cost,
        print_season,
        simulate_with_progress,
    )
    from snowshed.season.repeated import recorded_season

    plan, settings = recorded_season(record)
    if dry_run:
        print_plan_cost(plan, quiet=quiet)
        return
    result = simulate_with_progress(plan, folder, settings, resume=resume, quiet=quiet)
    if not quiet:
        print_season(result, folder, plan.panel)


def _repeat_clearance(
    record: Path, folder: Path, *, dry_run: bool, jobs: Optional[int], quiet: bool
) -> None:
    from snowshed.analysis.clearance.inputs import recorded_clearance
    from snowshed.cli.commands.clearance import answer_and_report, print_expected

    inputs = recorded_clearance(record)
    if dry_run or not quiet:
        print_expected(inputs, jobs)
    if not dry_run:
        notes = [*inputs.weather.notes, *inputs.winter_list.notes]
        answer_and_report(inputs, folder, notes, quiet=quiet, jobs=jobs)
