"""What the command ``snowshed lua`` does with the scenes of scripts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Optional

import click

from snowshed._core import InputError
from snowshed.run.results import check_empty
from snowshed.scene.lua.builder import LuaRun
from snowshed.scene.lua.loading import load_lua
from snowshed.scene.scene import ResolvedScene


def load(init: Path, update: Optional[Path], *, quiet: bool) -> list[LuaRun]:
    """Load the scenes; what the scripts print goes to stderr."""

    def echo(line: str) -> None:
        click.echo(line, err=True)

    return load_lua(init, update, echo=None if quiet else echo)


def save_all(runs: Sequence[LuaRun], path: Path) -> None:
    """Write the scene to the file `path`; runs that have names go to a folder of that name."""
    if not runs[0].name:
        runs[0].scene.save(path)
        return
    if path.exists() and not path.is_dir():
        raise InputError(
            f"--to-json: {path} is a file; the scripts name {len(runs)} run(s), which need a folder"
        )
    path.mkdir(parents=True, exist_ok=True)
    for run in runs:
        run.scene.save(path / f"{run.name}.json")


def run_all(
    runs: Sequence[LuaRun],
    folder: Path,
    run_one: Callable[[ResolvedScene, Path, bool], None],
    *,
    resume: bool,
    quiet: bool,
) -> None:
    """Run the scene into `folder`; runs that have names go to folders of these names inside it.

    Resuming also starts the named runs that had not begun.
    """
    if not runs[0].name:
        run_one(runs[0].scene, folder, resume)
        return
    if not resume:
        check_empty(folder)
    for i, run in enumerate(runs, start=1):
        if not quiet:
            click.echo(f"run {i} of {len(runs)}: {run.name}")
        target = folder / run.name
        run_one(run.scene, target, resume and target.exists())
