"""Copies of terrain beside a results folder, because a scene needs a text raster."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from snowshed.base.paths import beside


def terrain_copy(folder: Path) -> Path:
    """Return the file of the terrain's copy, beside the results folder."""
    return beside(folder, suffix="-terrain.asc")


@contextmanager
def copies_removed_on_failure(folder: Path) -> Iterator[None]:
    """Remove new copies of files beside a results folder if no run begins there."""
    copy = terrain_copy(folder)
    earlier = set(_copies(copy))
    try:
        yield
    except BaseException:
        if not folder.exists():
            for file in _copies(copy):
                if file not in earlier:
                    file.unlink(missing_ok=True)
        raise


def thickness_copy(copy: Path, release: str = "") -> Path:
    """Return the file of the copy of a raster of thickness, beside that of the terrain.

    `release` tells apart the rasters of a project.
    """
    return copy.with_name(f"{copy.stem}-thickness{release and '-' + release}.asc")


def _copies(copy: Path) -> list[Path]:
    """Return the existing copies of terrain and thickness."""
    start = f"{copy.stem}-thickness"
    if not copy.parent.is_dir():
        return []
    return [
        file
        for file in copy.parent.iterdir()
        if file == copy or (file.name.startswith(start) and file.suffix == ".asc")
    ]
