"""Exit codes, and errors that have them."""

from __future__ import annotations

import click

BAD_INPUT = 2  # nothing was written
COULD_NOT_FINISH = 3  # simulation failed, disk full, out of memory; the run can be resumed
INTERRUPTED = 130
PIPE_CLOSED = 141  # the reader of the output has left; shells report SIGPIPE with this code


class Stopped(click.ClickException):
    """An interruption, with a message on how to resume; click drops the message of Ctrl-C."""

    exit_code = INTERRUPTED


class Failed(click.ClickException):
    """A failure of runs, or of the command itself."""

    exit_code = COULD_NOT_FINISH
