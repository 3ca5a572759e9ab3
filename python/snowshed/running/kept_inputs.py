"""Arrays in memory that a scene was made from: a run keeps their files beside its results."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from snowshed.base.paths import PathLike
from snowshed.io.array_files import is_array_file
from snowshed.io.atomic import replacing
from snowshed.scene.resolved import ResolvedScene

#: Keys of a scene whose values are paths of files.
FILES = ("file", "thickness_file")


@contextmanager
def kept_inputs(scene: ResolvedScene, folder: PathLike) -> Iterator[ResolvedScene]:
    """Copy the files of arrays in memory into ``FOLDER-inputs``, and yield the scene with these.

    The copies are removed if the block fails and no results are there.
    """
    if not any(is_array_file(path) for path in _paths(scene.data)):
        yield scene
        return
    results = Path(folder).absolute()
    beside = results.with_name(f"{results.name}-inputs")
    was_there = beside.exists()
    beside.mkdir(parents=True, exist_ok=True)
    data = _with_copies(scene.copied_data(), beside)
    try:
        yield ResolvedScene.from_data(data, scene.base_dir)
    except BaseException:
        if not was_there and not results.exists():
            shutil.rmtree(beside)
        raise


def _paths(value: Any) -> Iterator[str]:
    for key, inner in value.items() if hasattr(value, "items") else ():
        if key in FILES and inner:
            yield str(inner)
        else:
            yield from _paths(inner)
    if isinstance(value, (list, tuple)):
        for inner in value:
            yield from _paths(inner)


def _with_copies(value: Any, beside: Path) -> Any:
    if isinstance(value, list):
        return [_with_copies(inner, beside) for inner in value]
    if not isinstance(value, dict):
        return value
    return {
        key: _copy(inner, beside) if key in FILES and inner else _with_copies(inner, beside)
        for key, inner in value.items()
    }


def _copy(path: str, beside: Path) -> str:
    if not is_array_file(path):
        return path
    copy = beside / Path(path).name
    with replacing(copy) as beside_copy:
        beside_copy.write_bytes(Path(path).read_bytes())
    return str(copy)
