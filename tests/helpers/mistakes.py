"""Texts by which a mistake is told: of an error of the package, or of notes."""

from __future__ import annotations

import warnings
from collections.abc import Callable

from click.testing import CliRunner

from snowshed import InputError, SimulationError, SnowshedNote
from snowshed.cli.main import cli
from snowshed.study import StudyError

#: Errors of the package, and Python's own of a call with a wrong argument.
CLEAR = (InputError, SimulationError, StudyError, TypeError, OSError)


def texts_of(mistake: Callable[[], object]) -> list[str]:
    """Make a mistake; return the error, or the notes; an empty list: it was silent."""
    with warnings.catch_warnings(record=True) as issued:
        warnings.simplefilter("always")
        try:
            mistake()
        except CLEAR as error:
            return [str(error)]
    return [str(each.message) for each in issued if issubclass(each.category, SnowshedNote)]


def texts_of_command(arguments: list[object]) -> list[str]:
    """Run a command; return its error, or its notes; an empty list: it was silent."""

    def run() -> None:
        done = CliRunner().invoke(cli, [str(each) for each in arguments])
        notes.extend(line for line in done.output.splitlines() if "note:" in line)
        if done.exit_code and not isinstance(done.exception, SystemExit):
            raise done.exception
        if done.exit_code:
            raise InputError(done.output)

    notes: list[str] = []
    return texts_of(run) + notes
