"""Running a scene on the command line, whatever its method is."""

from __future__ import annotations

from pathlib import Path

from snowshed.cli.exit_codes import Stopped
from snowshed.methods.registry import NAME_KEY
from snowshed.run.interrupt import Interrupted
from snowshed.scene.scene import ResolvedScene


def run_scene(ready: ResolvedScene, folder: Path, resume: bool, quiet: bool) -> None:
    """Run a scene into a folder with a progress bar, and print its results."""
    run = _run_slide if ready.data.get(NAME_KEY) == "slide" else _run_events
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
