"""Arrays in memory that a scene was made from: a run keeps their files beside its results."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from snowshed.base.paths import PathLike
from snowshed.io.array_files import is_array_file
from snowshed.io.atomic import replacing
from snowshed.results.replacement import inputs_beside
from snowshed.scene.named_files import named_files, with_named_files
from snowshed.scene.resolved import ResolvedScene


@contextmanager
def kept_inputs(scene: ResolvedScene, folder: PathLike) -> Iterator[ResolvedScene]:
    """Copy the files of arrays in memory into ``FOLDER-inputs``, and yield the scene with these.

    The copies are removed if the block fails and no results are there.
    """
    if not any(map(is_array_file, named_files(scene.data))):
        yield scene
        return
    results, beside = Path(folder), inputs_beside(folder)
    was_there = beside.exists()
    beside.mkdir(parents=True, exist_ok=True)
    data = with_named_files(scene.copied_data(), lambda path: copy_array_file(path, beside))
    try:
        yield ResolvedScene.from_data(data, scene.base_dir)
    except BaseException:
        if not was_there and not results.exists():
            shutil.rmtree(beside)
        raise


def copy_array_file(path: str, beside: Path) -> str:
    """Copy the file of an array in memory, and return the copy's path; other paths stay."""
    if not is_array_file(path):
        return path
    copy = beside / Path(path).name
    with replacing(copy) as beside_copy:
        beside_copy.write_bytes(Path(path).read_bytes())
    return str(copy)
