"""Replacing the results of an earlier run, or of a season, in its folder."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Optional

from snowshed._core import InputError, SimulationError
from snowshed.base.interrupt import Interrupted
from snowshed.base.notes import SnowshedNote
from snowshed.base.paths import PathLike, beside
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


def inputs_beside(folder: PathLike) -> Path:
    """Return the folder beside a results folder that holds arrays in memory of its scene."""
    return beside(Path(folder).absolute(), suffix="-inputs")


@contextmanager
def new_results(folder: PathLike, *, overwrite: bool) -> Iterator[Callable[[], None]]:
    """Clear up if the new run of a block cannot begin.

    A run that a note refuses, where notes are errors, leaves nothing. Results that were to be
    replaced come back.

    Parameters
    ----------
    folder
        The folder of the run.
    overwrite
        Whether to replace the results of an earlier run in it.

    Yields
    ------
    callable
        To be called when the run can be resumed; from then on its results stay.

    Raises
    ------
    InputError
        If the folder holds other files than those of a run, or a run writes into it now.
    """
    folder, inputs = Path(folder), inputs_beside(folder)
    aside = _set_aside(folder, _check) if overwrite else None
    is_new, has_inputs, has_begun = not folder.exists(), inputs.exists(), False

    def begin() -> None:
        nonlocal has_begun
        has_begun = True
        if aside is not None:
            shutil.rmtree(aside, ignore_errors=True)

    try:
        yield begin
    except BaseException as error:
        has_begun |= isinstance(error, (SimulationError, Interrupted))  # they can be looked into
        if not has_begun and (aside is not None or isinstance(error, SnowshedNote)):
            _clear(folder, is_new=is_new)
            if not has_inputs:
                shutil.rmtree(inputs, ignore_errors=True)
            if aside is not None:
                aside.rename(folder)
        else:
            begin()
        raise
    begin()


@contextmanager
def replaced_season(folder: PathLike) -> Iterator[None]:
    """Set aside the season in a folder during a block; it comes back if no slide-off has begun.

    Slide-offs that have begun stay if the block fails, because they can be resumed.

    Raises
    ------
    InputError
        As for `new_results`.
    """
    folder = Path(folder)
    aside = _set_aside(folder, _check_season)
    try:
        yield
    except BaseException:
        if aside is not None and not SeasonFolder(folder).run.scene.is_file():
            shutil.rmtree(folder, ignore_errors=True)
            aside.rename(folder)
        raise
    finally:
        if aside is not None:
            shutil.rmtree(aside, ignore_errors=True)


def _set_aside(folder: Path, check: Callable[[Path, set[str]], None]) -> Optional[Path]:
    """Rename a folder that is not empty, and return its new path; `check` may refuse its names."""
    names = {path.name for path in folder.iterdir()} if folder.is_dir() else set()
    if not any(not LEFTOVER.match(name) for name in names):
        return None
    check(folder, names)
    aside = beside(folder, ".", f".{os.getpid()}.replaced")
    folder.rename(aside)
    return aside


def _clear(folder: Path, *, is_new: bool) -> None:
    """Remove the results in a folder that was new, or else empty."""
    if is_new:
        shutil.rmtree(folder, ignore_errors=True)
        return
    for path in folder.iterdir():
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)


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
