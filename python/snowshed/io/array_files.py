"""Files for arrays in memory: a scene names files, so an array becomes one for this process.

Their folder is removed when the process ends. A run copies the files that it needs beside its
results (`snowshed.running.kept_inputs`).
"""

from __future__ import annotations

import atexit
import hashlib
import shutil
from functools import cache
from pathlib import Path
from tempfile import mkdtemp

import numpy as np
from numpy.typing import NDArray

from snowshed.io.atomic import replacing

FOLDER_PREFIX = "snowshed-arrays-"


@cache
def array_folder() -> Path:
    """Return the folder of this process's files."""
    folder = Path(mkdtemp(prefix=FOLDER_PREFIX))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


def is_array_file(path: str) -> bool:
    """Return whether a path is that of an array in memory."""
    return array_folder.cache_info().currsize > 0 and Path(path).parent == array_folder()


def array_file(values: NDArray[np.generic]) -> Path:
    """Return an NPY file of an array; the same array always has the same file.

    Examples
    --------
    >>> file = array_file(np.zeros((2, 2)))
    >>> file == array_file(np.zeros((2, 2))), np.load(file).shape, is_array_file(str(file))
    (True, (2, 2), True)
    """
    array = np.ascontiguousarray(values)
    facts = f"{array.dtype.str} {array.shape}".encode()
    digest = hashlib.sha256(facts + array.tobytes()).hexdigest()[:16]
    path = array_folder() / f"{digest}.npy"
    if not path.exists():
        with replacing(path) as beside, beside.open("wb") as stream:
            np.save(stream, array)
    return path
