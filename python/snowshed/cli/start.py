"""The command ``snowshed``, whose imports can be interrupted, too."""

from __future__ import annotations

import sys
from typing import Optional


def main() -> int:
    """Run the command line of this process and return its exit code."""
    try:
        from snowshed.cli.main import main as run

        return run()
    except BaseException as error:
        if not is_interrupt(error):
            raise
        print("error: interrupted", file=sys.stderr)
        return 130


def is_interrupt(error: Optional[BaseException]) -> bool:
    """Return whether an interrupt caused an error: Python makes a RuntimeError of some.

    An interrupt while a class is created, which happens during imports, ends in such an error.
    """
    while error is not None and not isinstance(error, KeyboardInterrupt):
        error = error.__cause__
    return error is not None
