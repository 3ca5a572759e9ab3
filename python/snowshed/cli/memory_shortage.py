"""Messages after a shortage of memory: the file or the computation at fault."""

from __future__ import annotations

import os
import traceback
from pathlib import Path
from types import FrameType
from typing import Optional

#: Modules whose work grows with the number of particles.
PARTICLE_MODULES = ("snowshed.running.", "snowshed.methods.", "snowshed.study.")
#: Names of file arguments in readers, in the order in which they are tried.
FILE_ARGUMENTS = ("path", "file", "source", "where", "raster", "mesh")


def memory_message(error: MemoryError) -> str:
    """Return the message for an error, according to the code that raised it.

    Examples
    --------
    >>> memory_message(MemoryError())
    'out of memory'
    """
    frames = [
        frame
        for frame, _ in traceback.walk_tb(error.__traceback__)
        if str(frame.f_globals.get("__name__", "")).startswith("snowshed.")
    ]
    for frame in reversed(frames):
        module = str(frame.f_globals["__name__"])
        if file := _read_file(frame):
            return f"out of memory while {file} was read ({module})"
        if module.startswith(PARTICLE_MODULES):
            return f"out of memory ({module}); give fewer particles or a larger dx"
    stage = [str(frame.f_globals["__name__"]) for frame in frames[-1:]]
    return f"out of memory ({stage[0]})" if stage else "out of memory"


def _read_file(frame: FrameType) -> Optional[str]:
    """Return the file that a function works on, by the usual names of its arguments."""
    code = frame.f_code
    for name in code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]:
        value = frame.f_locals.get(name)
        if name in FILE_ARGUMENTS and isinstance(value, (str, Path)) and Path(value).is_file():
            return os.fspath(value)
    return None
