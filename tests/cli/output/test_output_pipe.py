"""A command ends quietly if its output is not read to the end."""

import subprocess
import sys

import pytest
from conftest import tiny_scene

from snowshed.cli.exit_codes import PIPE_CLOSED


def run_into_closed_pipe(code_or_arguments, *, read: int = 0, unbuffered: bool = False):
    """Run a command whose output is closed after some bytes; return exit code and messages."""
    flags = ["-u"] if unbuffered else []
    command = [sys.executable, *flags, "-m", "snowshed", *map(str, code_or_arguments)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    process.stdout.read(read)
    process.stdout.close()
    messages = process.stderr.read().decode()
    process.stderr.close()
    return process.wait(timeout=60), messages


@pytest.mark.parametrize("unbuffered", [False, True])
@pytest.mark.parametrize(
    "arguments", [["schema"], ["--help"], ["run", "--help"], ["scene", "--preset", "lab-50"]]
)
def test_a_closed_pipe_ends_a_command_quietly(arguments, unbuffered):
    assert run_into_closed_pipe(arguments, unbuffered=unbuffered) == (PIPE_CLOSED, "")


def test_tables_end_quietly_too(tmp_path, finished):
    tiny_scene().resolve().save(tmp_path / "scene.json")
    for arguments in (["plan", tmp_path / "scene.json"], ["compare", finished, finished]):
        assert run_into_closed_pipe(arguments) == (PIPE_CLOSED, "")


def test_files_are_complete_although_the_pipe_is_closed(tmp_path, finished):
    """Only the message is lost."""
    code, messages = run_into_closed_pipe(["view", finished, "-o", tmp_path / "page.html"])
    assert (code, messages) == (PIPE_CLOSED, "")
    assert (tmp_path / "page.html").read_text().rstrip().endswith("</html>")


def test_output_that_is_read_is_complete():
    done = subprocess.run([sys.executable, "-m", "snowshed", "schema"], capture_output=True)
    assert done.returncode == 0 and done.stderr == b""


def test_errors_into_a_closed_pipe(tmp_path):
    command = [sys.executable, "-m", "snowshed", "plan", str(tmp_path / "nothing.json")]
    process = subprocess.Popen(command, stderr=subprocess.PIPE)
    process.stderr.close()
    assert process.wait(timeout=60) in (2, PIPE_CLOSED)


def test_a_broken_pipe_of_a_helper_program_is_an_error(capsys):
    import click

    from snowshed.cli.main import main

    @click.command()
    def broken():
        raise BrokenPipeError(32, "Broken pipe")

    assert main([], command=broken) == 3
    assert "a helper program ended before" in capsys.readouterr().err
