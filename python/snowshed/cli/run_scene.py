"""Running a scene of any method on the command line."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Optional

import snowshed._core as _core
from snowshed.base.formatting import about
from snowshed.base.interrupt import Interrupted
from snowshed.base.progress import Progress, Reporter
from snowshed.cli.exit_codes import Stopped
from snowshed.cli.options.check import check_can_be_measured, check_run
from snowshed.cli.output.dry_run import print_cost
from snowshed.cli.output.terminal import say
from snowshed.io.raster.output import MapFormat
from snowshed.methods.registry import DEFAULT, SETTINGS_KEY, method_of
from snowshed.running.recorded_run import RecordedRun
from snowshed.scene.scene import ResolvedScene

ANNOUNCED_FROM_S = 600.0  # s; longer runs are announced


def run_scene(
    resolved: ResolvedScene,
    folder: Path,
    resume: bool,
    quiet: bool,
    map_format: MapFormat = "ascii",
    recorded: Optional[RecordedRun] = None,
) -> None:
    """Run a scene into a folder with a progress bar, and print its results."""
    from snowshed.cli.output.progress import progress_bar
    from snowshed.running.method_run import RunOptions
    from snowshed.running.run import run_resolved

    if not quiet and (slow := _core.slow_kernels_note()):
        say(f"note: {slow}", err=True)
    try:
        with progress_bar(quiet=quiet) as show:
            progress = None if show is None else announcing_long_run(resolved, show)
            options = RunOptions(resume, map_format=map_format)
            results = run_resolved(resolved, folder, options, recorded, progress=progress)
    except Interrupted as interrupted:
        raise Stopped(str(interrupted)) from None
    if not quiet:
        from snowshed.cli.output.results import print_results

        print_results(results)


def run_or_cost(
    resolved: ResolvedScene,
    folder: Path,
    *,
    resume: bool,
    dry_run: bool,
    quiet: bool,
    check: bool = False,
    map_format: MapFormat = "ascii",
    recorded: Optional[RecordedRun] = None,
) -> None:
    """Run a scene as `run_scene` does; a dry run prints its cost only.

    Parameters
    ----------
    check
        Whether to measure the error of the stack, too.
    map_format
        Format of the maps, if the method has them.
    recorded
        The earlier run that this one repeats.
    """
    if check:
        check_can_be_measured(resolved)
    if dry_run:
        print_cost(resolved)
        return
    run_scene(resolved, folder, resume, quiet, map_format, recorded)
    if check:
        check_run(folder, quiet)


def announcing_long_run(resolved: ResolvedScene, show: Reporter) -> Reporter:
    """Return a reporter that announces a long run as soon as its speed is known.

    Only runs with a stack are announced; all others have one event, whose time limit is known.

    Parameters
    ----------
    resolved
        The scene that runs.
    show
        Reporter that receives each progress.
    """
    unknown = "stack" in method_of(resolved.data).results

    def report(progress: Progress) -> None:
        nonlocal unknown
        show(progress)
        if unknown and progress.updates_per_s:
            unknown = False
            with suppress(_core.InputError):  # a file that the run has read may be gone
                work = _core.expected_work(resolved.core, resolved.base_dir)
                if (seconds := work / progress.updates_per_s) >= ANNOUNCED_FROM_S:
                    say(_long_run(resolved, seconds), err=True)

    return report


def _long_run(resolved: ResolvedScene, seconds: float) -> str:
    method = method_of(resolved.data)
    path = f"{SETTINGS_KEY}.{method.settings.RESOLUTION}"
    size = "--dx" if method.name == DEFAULT else path
    return (
        f"note: this takes {about(seconds)}; Ctrl-C stops it, --resume resumes it. A larger {size} "
        "is faster: twice the size takes a sixteenth of the time in 3D, an eighth in 2D"
    )
