"""Running a scene on the command line, whatever its method is."""

from __future__ import annotations

from pathlib import Path

from snowshed.cli.exit_codes import Stopped
from snowshed.methods.registry import NAME_KEY
from snowshed.run.interrupt import Interrupted
from snowshed.scene.scene import ResolvedScene


def run_scene(ready: ResolvedScene, folder: Path, resume: bool, quiet: bool) -> None:
    """Run a scene into a folder with a progress bar, and print its results."""
    run = RUNS.get(str(ready.data.get(NAME_KEY)), _run_events)
    try:
        run(ready, folder, resume, quiet)
    except Interrupted as interrupted:
        raise Stopped(str(interrupted)) from None


def _run_events(ready: ResolvedScene, folder: Path, resume: bool, quiet: bool) -> None:
    from snowshed.cli import console
    from snowshed.cli.progress import progress_bar
    from snowshed.run.events import run_events

    with progress_bar(quiet=quiet) as progress:
        table = run_events(ready, folder, resume=resume, progress=progress)
    if not quiet:
        console.print_events(table, folder)


def _run_slide(ready: ResolvedScene, folder: Path, resume: bool, quiet: bool) -> None:
    from snowshed.cli.display.slide import print_slide
    from snowshed.cli.progress import progress_bar
    from snowshed.run.slides import run_slide

    with progress_bar(quiet=quiet) as progress:
        summary = run_slide(ready, folder, resume=resume, progress=progress)
    if not quiet:
        print_slide(summary, folder)


def _run_grains(ready: ResolvedScene, folder: Path, resume: bool, quiet: bool) -> None:
    from snowshed.cli.display.grains import print_grains
    from snowshed.cli.progress import progress_bar
    from snowshed.run.grains import run_grains

    with progress_bar(quiet=quiet) as progress:
        summary = run_grains(ready, folder, resume=resume, progress=progress)
    if not quiet:
        print_grains(summary, folder)


#: How scenes are run whose method does not make stacks.
RUNS = {"slide": _run_slide, "grains": _run_grains}
