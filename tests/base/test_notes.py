"""Notes are warnings of one class, which scripts filter and results record."""

import warnings

import click
import pytest

from snowshed import SnowshedNote
from snowshed.base.notes import issue_note, record_notes
from snowshed.cli.main import main
from snowshed.cli.options.common import quiet_option


@click.command()
@quiet_option
def reading(quiet):
    issue_note("feet became metres")


def test_the_command_line_prints_a_note_unless_quiet(capsys):
    assert main([], command=reading) == 0
    assert capsys.readouterr().err == "note: feet became metres\n"
    assert main(["-q"], command=reading) == 0
    assert capsys.readouterr().err == ""
    assert main([], command=reading) == 0
    assert capsys.readouterr().err == "note: feet became metres\n"


def test_recorded_notes_are_issued_again_and_can_be_errors():
    with pytest.warns(SnowshedNote, match="feet became metres"), record_notes() as notes:
        issue_note("feet became metres")
        issue_note("feet became metres")
    assert notes == ["feet became metres"]
    with warnings.catch_warnings():
        warnings.simplefilter("error", SnowshedNote)
        with pytest.raises(SnowshedNote), record_notes():
            issue_note("feet became metres")


def test_notes_before_an_error_are_recorded():
    raises = pytest.raises(ValueError, match="too far")
    with pytest.warns(SnowshedNote), raises, record_notes() as notes:
        issue_note("feet became metres")
        raise ValueError("too far")
    assert notes == ["feet became metres"]
