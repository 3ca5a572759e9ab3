"""Running a scene on the command line, whatever its method is."""

from __future__ import annotations

from pathlib import Path

import snowshed._core as _core
from snowshed.base.formatting import about
from snowshed.base.interrupt import Interrupted
from snowshed.cli.exit_codes import Stopped
from snowshed.cli.terminal import say
from snowshed.methods.registry import DEFAULT, SETTINGS_KEY, method_of
from snowshed.scene.scene import ResolvedScene

LONG = 600.0  # s; longer runs are announced


def run_scene(ready: ResolvedScene, folder: Path, resume: bool, quiet: bool) -> None:
    """Run a scene into a folder with a progress bar, and print its results."""
    from snowshed.cli.progress import progress_bar
    from snowshed.running.run import run

    if not quiet:
        _tell_beforehand(ready)
    try:
        with progress_bar(quiet=quiet) as progress:
            results = run(ready, folder, resume=resume, progress=progress)
    except Interrupted as interrupted:
        raise Stopped(str(interrupted)) from None
    if not quiet:
        from snowshed.cli.run_output import print_results

        print_results(results)


def _tell_beforehand(ready: ResolvedScene) -> None:
    """Announce slow kernels and long runs."""
    seconds = 0.0
    if "stack" in method_of(ready.data).results:  # what has one event has a time limit, too
        seconds = _core.plan(ready.core, ready.base_dir)["expected_wall_s"]
    if slow := _core.slow_kernels_note():
        say(f"note: {slow}", err=True)
    if seconds >= LONG:
        say(_long_run(ready, seconds), err=True)


def _long_run(ready: ResolvedScene, seconds: float) -> str:
    method = method_of(ready.data)
    path = f"{SETTINGS_KEY}.{method.settings.RESOLUTION}"
    size = "--dx" if method.name == DEFAULT else path
    return (
        f"note: this takes {about(seconds)}; Ctrl-C stops it, --resume resumes it. A larger {size} "
        "is faster: twice the size takes a sixteenth of the time in 3D, an eighth in 2D"
    )
