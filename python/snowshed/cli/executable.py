"""The command ``snowshed-run``: the core's own program, without the rest of the package."""

from __future__ import annotations

import os
import sys


def main() -> int:
    """Run ``snowshed-run`` with the arguments of this process and return its exit code."""
    from snowshed._core import run_program

    code = run_program([b"snowshed-run", *map(os.fsencode, sys.argv[1:])])
    sys.stdout.flush()
    return code
