"""Replacing the results of an earlier run in its folder."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from snowshed._core import InputError
from snowshed.base.paths import PathLike
from snowshed.io.atomic import LEFTOVER
from snowshed.io.locks import is_held
from snowshed.results.folder import RunFolder

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
    folder = Path(folder)
    names = {path.name for path in folder.iterdir()} if folder.is_dir() else set()
    if not any(not LEFTOVER.match(name) for name in names):
        yield
        return
    _check(folder, names)
    aside = folder.with_name(f".{folder.name}.{os.getpid()}.replaced")
    folder.rename(aside)
    try:
        yield
    except BaseException:
        shutil.rmtree(folder, ignore_errors=True)
        aside.rename(folder)
        raise
    shutil.rmtree(aside)


def _check(folder: Path, names: set[str]) -> None:
    if "scene.json" not in names:
        raise InputError(f"{folder}: holds no run, so it is not overwritten")
    foreign = sorted(name for name in names - ENTRIES if not LEFTOVER.match(name))
    if foreign:
        raise InputError(
            f"{folder}: not overwritten, because it holds other files than those of a run: "
            f"{', '.join(foreign[:5])}"
        )
    if is_held(folder):
        raise InputError(f"{folder}: in use: a run writes into this folder")
