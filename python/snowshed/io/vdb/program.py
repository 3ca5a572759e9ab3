"""The program snowshed-vdb, the only part of snowshed that needs OpenVDB."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

from snowshed._core import InputError
from snowshed._core import __file__ as core_file

PROGRAM = Path(core_file).with_name("snowshed-vdb")
REFUSAL_CODE = 2  # exit code; the reason is on standard output


def vdb_available() -> bool:
    """Return whether this snowshed was built with OpenVDB."""
    return os.access(PROGRAM, os.X_OK)


def run_writer(path: Path, request: bytes) -> bytes:
    """Write a file with the program, and return its answer.

    Raises
    ------
    InputError
        If the program is missing or refuses the request.
    OSError
        If the program cannot be run or dies.
    """
    if not vdb_available():
        raise InputError(
            "writing OpenVDB files needs OpenVDB, without which this snowshed was built; install "
            "it (Debian, Ubuntu: libopenvdb-dev libboost-dev) and build snowshed again"
        )
    done = subprocess.run(
        [PROGRAM, "write", path], input=request, stdout=subprocess.PIPE, check=False
    )
    if done.returncode == REFUSAL_CODE:
        raise InputError(done.stdout.decode(errors="replace"))
    if done.returncode != 0:
        raise OSError(f"{PROGRAM} ended with exit code {done.returncode}")
    return done.stdout
