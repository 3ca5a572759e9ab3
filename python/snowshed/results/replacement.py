"""Replacing the results of an earlier run, or of a season, in its folder."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Optional

from snowshed._core import InputError
from snowshed.base.paths import PathLike
from snowshed.io.atomic import LEFTOVER
from snowshed.io.locks import is_held
from snowshed.results.folder import RunFolder
from snowshed.results.season_folder import SeasonFolder

#: Entries of a results folder, of runs by any method.
ENTRIES = RunFolder("").names | {
    "contacts.csv", "curve.csv", "energy.png", "energy_history.csv", "film.bin", "flow",
    "forces.csv", "forces.png", "grains.json", "grains.png", "largest_loads.csv",
    "loads.csv", "loads.html", "object_loads.csv", "particles", "particles.pvd", "peaks",
    "peaks.npz", "pressures", "slide.html", "slide.json", "slide.png", "snapshots",
    "solids.vtp", "states", "view.html",
}  # fmt: skip


@contextmanager
def replaced_results(folder: PathLike) -> Iterator[None]:
    """Set aside the results in a folder during a block; they come back if the block fails.

    Parameters
    ----------
    folder
        The folder of an earlier run. Nothing happens if it is new or empty.

    Raises
    ------
    InputError
        If it holds other files than those of a run, or a run writes into it now.
    """
    with _replaced(Path(folder), _check, begun=None):
        yield


@contextmanager
def replaced_season(folder: PathLike) -> Iterator[None]:
    """Set aside the season in a folder during a block; it comes back if no slide-off has begun.

    Slide-offs that have begun stay if the block fails, because they can be resumed.

    Raises
    ------
    InputError
        As for `replaced_results`.
    """
    with _replaced(Path(folder), _check_season, begun=SeasonFolder(folder).run.scene):
        yield


@contextmanager
def _replaced(
    folder: Path, check: Callable[[Path, set[str]], None], begun: Optional[Path]
) -> Iterator[None]:
    """Set aside a folder during a block; it comes back if the block fails before `begun` is there.

    `check` refuses a folder with other files; it is called with the folder and its names.
    """
    names = {path.name for path in folder.iterdir()} if folder.is_dir() else set()
    if not any(not LEFTOVER.match(name) for name in names):
        yield
        return
    check(folder, names)
    aside = folder.with_name(f".{folder.name}.{os.getpid()}.replaced")
    folder.rename(aside)
    try:
        yield
    except BaseException:
        if begun is None or not begun.is_file():
            shutil.rmtree(folder, ignore_errors=True)
            aside.rename(folder)
        else:
            shutil.rmtree(aside)
        raise
    shutil.rmtree(aside)


def _check_season(folder: Path, names: set[str]) -> None:
    files = SeasonFolder(folder)
    results = {files.table.name, files.figure.name, files.summary.name}
    run = files.run.folder
    if not (files.run.scene.is_file() or results & names):
        raise InputError(f"{folder}: holds no season, so it is not overwritten")
    _refuse_foreign(folder, names - results - {run.name}, "a season")
    if run.is_dir():
        _check(run, {path.name for path in run.iterdir()})


def _check(folder: Path, names: set[str]) -> None:
    if "scene.json" not in names:
        raise InputError(f"{folder}: holds no run, so it is not overwritten")
    _refuse_foreign(folder, names - ENTRIES, "a run")
    if is_held(folder):
        raise InputError(f"{folder}: in use: a run writes into this folder")


def _refuse_foreign(folder: Path, others: set[str], what: str) -> None:
    foreign = sorted(name for name in others if not LEFTOVER.match(name))
    if foreign:
        raise InputError(
            f"{folder}: not overwritten, because it holds other files than those of {what}: "
            f"{', '.join(foreign[:5])}"
        )
