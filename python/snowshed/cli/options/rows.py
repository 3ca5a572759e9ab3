"""Options for several rows of panels."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

from snowshed.season.rows import MAX_ROWS

Command = TypeVar("Command", bound=Callable[..., Any])


def rows_options(command: Command) -> Command:
    """Add ``--rows`` and ``--pitch`` to a command."""
    pitch = click.option(
        "--pitch",
        type=click.FloatRange(0.0, 1000.0),
        default=0.0,
        help="Horizontal distance from a row to the next, down the slide direction [m].",
    )
    rows = click.option(
        "--rows",
        type=click.IntRange(1, MAX_ROWS),
        default=1,
        show_default=True,
        help="Rows of equal panels, which all shed their snow; needs --pitch.",
    )
    return rows(pitch(command))
