"""Standard output whose reader has left, as in ``snowshed schema | head``."""

from __future__ import annotations

import contextlib
import os
import select
import sys


def output_is_closed() -> bool:
    """Return whether standard output or error is a pipe whose reader has left."""
    poll = select.poll()
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError, AttributeError):  # a test's stream
            poll.register(stream.fileno(), select.POLLOUT)
    return any(state & select.POLLERR for _, state in poll.poll(0))


def flush_output() -> None:
    """Flush standard output.

    Raises
    ------
    BrokenPipeError
        If the reader of the pipe has left.
    """
    if sys.stdout is not None and not sys.stdout.closed:
        sys.stdout.flush()


def drop_output() -> None:
    """Drop unwritten output, because Python would report errors for it when it ends."""
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError, AttributeError):
            stream.flush()
            continue
        with contextlib.suppress(OSError, ValueError, AttributeError):
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, stream.fileno())
            os.close(nowhere)
