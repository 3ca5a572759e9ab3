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
    copies = [copy, copy.with_name(f"{copy.stem}-thickness.asc")]
    new = [file for file in copies if not file.exists()]
    try:
        yield
    except BaseException:
        if not folder.exists():
            for file in new:
                file.unlink(missing_ok=True)
        raise
