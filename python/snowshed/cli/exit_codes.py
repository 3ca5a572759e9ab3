"""Exit codes, and errors that have them."""

from __future__ import annotations

import click

BAD_INPUT = 2  # nothing was written
COULD_NOT_GO_ON = 3  # the simulation, the disk or the memory; what is there can be gone on with
INTERRUPTED = 130
PIPE_CLOSED = 141  # who read the output left: as shells report a program that SIGPIPE ended


class Stopped(click.ClickException):
    """An interruption, with a message that says how to go on; click drops that of Ctrl-C itself."""

    exit_code = INTERRUPTED


class Failed(click.ClickException):
    """A failure of runs, or of the command itself."""

    exit_code = COULD_NOT_GO_ON
