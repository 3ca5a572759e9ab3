"""Opening a three-dimensional image."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Optional

from snowshed._core import InputError
from snowshed.base.arguments import checked
from snowshed.base.notes import record_notes
from snowshed.base.paths import PathLike
from snowshed.io.voxels.array_files import open_npy, open_raw
from snowshed.io.voxels.metaimage import open_metaimage
from snowshed.io.voxels.stacks import open_slices, open_stack
from snowshed.io.voxels.voxel_file import VoxelFile

READERS = {
    ".npy": open_npy,
    ".mhd": open_metaimage,
    ".mha": open_metaimage,
    ".tif": open_stack,
    ".tiff": open_stack,
}
RAW = ".raw"


@checked
def open_voxels(
    path: PathLike, shape: Optional[tuple[int, int, int]] = None, kind: Optional[str] = None
) -> VoxelFile:
    """Return an image; its size and type are read, its numbers on demand.

    Parameters
    ----------
    path
        A TIFF stack, a folder of TIFF, PNG or BMP slices, a .mhd, .mha, .raw or .npy file.
    shape
        Voxels (nz, ny, nx) of a .raw file.
    kind
        Type of the numbers of a .raw file, such as "uint16", or "uint16-be" if big-endian.

    Raises
    ------
    InputError
        If the file is damaged, or its name has none of these suffixes.
    OSError
        If it cannot be read.

    Examples
    --------
    >>> import numpy as np
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     np.save(folder + "/snow.npy", np.zeros((2, 3, 4), dtype=np.uint8))
    ...     open_voxels(folder + "/snow.npy").shape
    (2, 3, 4)
    """
    with record_notes() as notes:
        opened = _open_file(Path(path), shape, kind)
    return replace(opened, notes=tuple(notes))


def _open_file(file: Path, shape: Optional[tuple[int, int, int]], kind: Optional[str]) -> VoxelFile:
    ending = file.suffix.lower()
    if (ending == RAW) != (shape is not None and kind is not None):
        raise InputError(
            f"{file}: a .raw file needs the shape and the type of its numbers (or a .mhd header "
            "beside it), and no other file accepts them"
        )
    if file.is_dir():
        return open_slices(file)
    if shape is not None and kind is not None:
        return open_raw(file, shape, kind)
    if ending not in READERS:
        raise InputError(
            f"{file}: not an image that is read: folders of slices, and files that end in "
            f"{', '.join([*READERS, RAW])}"
        )
    return READERS[ending](file)
