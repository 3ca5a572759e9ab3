"""The command ``snowshed lua``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Optional

import click

from snowshed._core import InputError
from snowshed.cli.options.common import PATH, run_options
from snowshed.cli.output.dry_run import issue_notes, print_cost
from snowshed.cli.output.terminal import say
from snowshed.cli.run_scene import run_scene
from snowshed.io.folders import check_empty
from snowshed.scene.lua.builder import LuaRun
from snowshed.scene.lua.loading import load_lua


@click.command()
@click.argument("init", type=PATH)
@click.argument("update", type=PATH, required=False)
@click.option(
    "--to-json",
    "file",
    type=PATH,
    help="Write the scene to this file; if the scripts name runs, write a folder with their files.",
)
@click.option("--threads", type=click.IntRange(0, 4096), help="Threads; 0: all.")
@partial(run_options, required=False)
def lua(
    init: Path,
    update: Optional[Path],
    file: Optional[Path],
    threads: Optional[int],
    folder: Optional[Path],
    resume: bool,
    dry_run: bool,
    quiet: bool,
) -> None:
    """Run a scene that Lua scripts describe, or write it as JSON.

    UPDATE runs after INIT, and its values override those of INIT. Needs the extra snowshed[lua].
    """
    if file is None and folder is None and not dry_run:
        raise click.UsageError("give -o DIR to run the scene, or --to-json FILE to write it")
    runs = _load(init, update, quiet=quiet)
    if threads is not None:
        runs = [replace(run, scene=run.scene.with_threads(threads)) for run in runs]
    if file is not None:
        _save_all(runs, file)
    if dry_run:
        for run in runs:
            print_cost(run.scene)
    elif folder is not None:
        _run_all(runs, folder, resume=resume, quiet=quiet)
    else:
        for run in runs:
            issue_notes(run.scene)


def _load(init: Path, update: Optional[Path], *, quiet: bool) -> list[LuaRun]:
    """Load the scenes; the output of the scripts goes to stderr."""

    def echo(line: str) -> None:
        say(line, err=True)

    return load_lua(init, update, echo=None if quiet else echo)


def _save_all(runs: Sequence[LuaRun], path: Path) -> None:
    """Write the scene to the file `path`; named runs are written to a folder of that name."""
    if not runs[0].name:
        runs[0].scene.save(path)
        return
    if path.exists() and not path.is_dir():
        raise InputError(f"--to-json: {path} is a file; {len(runs)} named runs need a folder")
    path.mkdir(parents=True, exist_ok=True)
    for run in runs:
        run.scene.save(path / f"{run.name}.json")


def _run_all(runs: Sequence[LuaRun], folder: Path, *, resume: bool, quiet: bool) -> None:
    """Run the scene into `folder`; named runs have folders of their names inside it.

    Resuming also starts named runs that have not begun.
    """
    if not runs[0].name:
        run_scene(runs[0].scene, folder, resume, quiet)
        return
    if not resume:
        check_empty(folder)
    for i, run in enumerate(runs, start=1):
        if not quiet:
            say(f"run {i} of {len(runs)}: {run.name}")
        target = folder / run.name
        run_scene(run.scene, target, resume and target.exists(), quiet)
