"""Exit codes of commands that fail for other reasons than bad input."""

from __future__ import annotations

import click


class Stopped(click.ClickException):
    """Interrupted; the message says how to go on. Click would swallow that of Ctrl-C itself."""

    exit_code = 130


class Failed(click.ClickException):
    """Runs have failed, or it cannot go on."""

    exit_code = 3
