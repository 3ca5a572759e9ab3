"""The command of a reproduction, made from its declaration."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Optional

import click

from reproductions.common.display import print_claims, progress_bar
from reproductions.common.report import write_report
from reproductions.common.reproduction import Reproduction
from reproductions.common.stage import Stage, StudyStage, choose, compute
from snowshed.cli.exit_codes import Failed, Stopped
from snowshed.study.errors import StudyError

PATH = click.Path(path_type=Path)


def command_of(package: str, name: str) -> click.Command:
    """Return the command of a package of `reproductions`, under a name."""
    module = importlib.import_module(f"reproductions.{package}.publication")
    reproduction: Reproduction[Any] = module.REPRODUCTION

    def reproduce(
        folder: Path,
        size: str,
        names: Sequence[str],
        report_only: bool,
        quiet: bool,
        jobs: Optional[int] = None,
        **options: Any,
    ) -> None:
        chosen = reproduction.size(size)
        work = reproduction.stages(folder, chosen.settings, **options)
        reproduction.prepare(folder, size, options)
        stages = choose(work.stages, names)
        if not report_only:
            _compute(stages, folder, jobs, quiet=quiet)
        claims = write_report(reproduction, chosen, folder, work)
        if not quiet:
            print_claims(claims, reproduction.author)
            click.echo(f"report in {reproduction.report(folder)}")
        _check_failures(work.stages)

    return click.Command(
        name, callback=reproduce, params=_options(reproduction), help=reproduction.help
    )


def _options(reproduction: Reproduction[Any]) -> list[click.Parameter]:
    sizes = [
        click.Option(
            [f"--{size.name}", "size"],
            flag_value=size.name,
            help=size.help,
            **({"default": True} if size is reproduction.sizes[0] else {}),
        )
        for size in reproduction.sizes
    ]
    jobs = click.Option(["--jobs"], type=int, help=reproduction.jobs_help)
    return [
        click.Option(
            ["-o", "--output", "folder"],
            type=PATH,
            required=True,
            help="Results folder, old or new.",
        ),
        *sizes,
        click.Option(
            ["--stage", "names"], multiple=True, metavar="NAME", help=reproduction.stage_help
        ),
        *reproduction.options,
        click.Option(["--report-only"], is_flag=True, help="Compute nothing, write the report."),
        *([jobs] if reproduction.jobs_help else []),
        click.Option(["-q", "--quiet"], is_flag=True, help="Print nothing but errors."),
    ]


def _compute(stages: Sequence[Stage], folder: Path, jobs: Optional[int], *, quiet: bool) -> None:
    """Compute the rest of some stages; raise Stopped after Ctrl-C, and Failed after an error."""
    try:
        with progress_bar(quiet=quiet) as progress:
            compute(stages, jobs=jobs, progress=progress)
    except StudyError as error:
        raise Failed(str(error)) from None
    except KeyboardInterrupt:
        message = f"interrupted; the same command resumes from {folder}"
        raise Stopped(message) from None


def _check_failures(stages: Sequence[Stage]) -> None:
    """Raise Failed if a simulation of any stage has failed."""
    failures = {stage.name: failure for stage in stages if (failure := stage.failure())}
    if failures:
        stores = {stage.runs for stage in stages if isinstance(stage, StudyStage)}
        advice = "".join(f"; see `snowshed study status {store}`" for store in stores)
        raise Failed(f"simulations failed: {', '.join(failures.values())}{advice}")
