"""Running a scene on the command line, whatever its method is."""

from __future__ import annotations

from pathlib import Path

import snowshed._core as _core
from snowshed.base.formatting import about
from snowshed.base.interrupt import Interrupted
from snowshed.cli.exit_codes import Stopped
from snowshed.cli.terminal import say
from snowshed.methods.registry import DEFAULT, NAME_KEY
from snowshed.scene.scene import ResolvedScene

LONG = 600.0  # s; longer runs are announced


def run_scene(ready: ResolvedScene, folder: Path, resume: bool, quiet: bool) -> None:
    """Run a scene into a folder with a progress bar, and print its results."""
    run = RUNS.get(str(ready.data.get(NAME_KEY)), _run_events)
    if not quiet:
        _tell_of_slow_kernels(ready)
    try:
        run(ready, folder, resume, quiet)
    except Interrupted as interrupted:
        raise Stopped(str(interrupted)) from None


def _tell_of_slow_kernels(ready: ResolvedScene) -> None:
    """Say what kernels without AVX2 cost, where these are used and the scene is not refused."""
    if slow := _core.slow_kernels_note():
        _core.Simulation(ready.json, ready.base_dir)
        say(f"note: {slow}", err=True)


def _run_events(ready: ResolvedScene, folder: Path, resume: bool, quiet: bool) -> None:
    from snowshed.cli.progress import progress_bar
    from snowshed.cli.run_output import print_events
    from snowshed.running.events import run_events

    if not quiet:
        _tell_of_long_run(ready)
    with progress_bar(quiet=quiet) as progress:
        table = run_events(ready, folder, resume=resume, progress=progress)
    if not quiet:
        print_events(table, folder)


def _tell_of_long_run(ready: ResolvedScene) -> None:
    """Say how long a run takes that takes long: a hint for the terminal, not for its results."""
    seconds = _core.plan(ready.json, ready.base_dir)["expected_wall_s"]
    if seconds < LONG:
        return
    size = "--dx" if ready.data.get(NAME_KEY, DEFAULT) == DEFAULT else "numerics.spacing"
    say(
        f"note: this takes {about(seconds)}; Ctrl-C stops it, --resume goes on. A larger {size} is "
        "faster: twice the size takes a sixteenth of the time in 3D, an eighth in 2D",
        err=True,
    )


def _run_slide(ready: ResolvedScene, folder: Path, resume: bool, quiet: bool) -> None:
    from snowshed.cli.progress import progress_bar
    from snowshed.cli.run_output import print_slide
    from snowshed.running.slides import run_slide

    with progress_bar(quiet=quiet) as progress:
        summary = run_slide(ready, folder, resume=resume, progress=progress)
    if not quiet:
        print_slide(summary, folder)


def _run_grains(ready: ResolvedScene, folder: Path, resume: bool, quiet: bool) -> None:
    from snowshed.cli.progress import progress_bar
    from snowshed.cli.run_output import print_grains
    from snowshed.running.grains import run_grains

    with progress_bar(quiet=quiet) as progress:
        summary = run_grains(ready, folder, resume=resume, progress=progress)
    if not quiet:
        print_grains(summary, folder)


#: How scenes are run whose method does not make stacks.
RUNS = {"slide": _run_slide, "grains": _run_grains}
