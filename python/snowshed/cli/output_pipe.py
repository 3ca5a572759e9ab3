"""Standard output whose reader has left, as in ``snowshed schema | head``."""

from __future__ import annotations

import contextlib
import os
import select
import sys


def output_is_closed() -> bool:
    """Return whether standard output or error is a pipe that nobody reads any more."""
    poll = select.poll()
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError, AttributeError):  # of a test, no files
            poll.register(stream.fileno(), select.POLLOUT)
    return any(state & select.POLLERR for _, state in poll.poll(0))


def flush_output() -> None:
    """Write out what is left for standard output.

    Raises
    ------
    BrokenPipeError
        If nobody reads it any more.
    """
    if sys.stdout is not None and not sys.stdout.closed:
        sys.stdout.flush()


def drop_output() -> None:
    """Drop what is left, which Python would otherwise complain about when it ends."""
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError, AttributeError):
            stream.flush()
            continue
        with contextlib.suppress(OSError, ValueError, AttributeError):
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, stream.fileno())
            os.close(nowhere)
