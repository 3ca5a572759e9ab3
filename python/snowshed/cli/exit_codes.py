"""Exit codes of commands that fail for other reasons than bad input."""

from __future__ import annotations

import click


class Stopped(click.ClickException):
    """An interruption, with a message that says how to go on; click drops that of Ctrl-C itself."""

    exit_code = 130


class Failed(click.ClickException):
    """A failure of runs, or of the command itself."""

    exit_code = 3
