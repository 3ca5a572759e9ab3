"""The command line: the list of commands, and their exit codes.

``panel|run|lua`` run a scene, ``slide`` a slide on terrain, ``grains`` a loading test of segmented
snow, ``scene|structure|plan|schema`` describe a scene, ``study`` computes many runs, ``season`` a
winter, and ``clearance`` many of them, to the height a panel needs.
``compare|sensitivity|calibrate`` answer questions about runs, and ``geometry|regress|predict``
treat the data set of panels.

Exit codes: 0 done; 2 bad input, nothing was written; 3 what was begun could not go on, for the
simulation failed, the disk is full or memory is short; 130 interrupted; 141 whoever read the output
left, as `head` does. Errors are one line on stderr.
"""

from __future__ import annotations

import errno
import sys
import warnings
from collections.abc import Sequence
from typing import Optional, TextIO, Union

import click

import snowshed._core as _core
from snowshed.base.messages import printable, shortened
from snowshed.base.notes import SnowshedNote
from snowshed.cli.deferred import Deferred
from snowshed.cli.exit_codes import BAD_INPUT, COULD_NOT_GO_ON, INTERRUPTED, PIPE_CLOSED
from snowshed.cli.memory_shortage import memory_message
from snowshed.cli.output_pipe import drop_output, flush_output, output_is_closed

#: What is wrong with files as the user named them.
OF_NAMES = (
    *(errno.ENOENT, errno.ENOTDIR, errno.EISDIR, errno.EEXIST, errno.ENOTEMPTY, errno.EACCES),
    *(errno.EPERM, errno.ENAMETOOLONG, errno.ELOOP, errno.EINVAL, errno.ENXIO, errno.EROFS),
)
#: What click raises where a group of commands is called alone; before 8.2 it printed its help.
NO_ARGUMENTS: type = getattr(click.exceptions, "NoArgsIsHelpError", type(None))
LONGEST_MESSAGE = 4000  # characters


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(_core.version, prog_name="snowshed")
def cli() -> None:
    """Simulate snow that slides off a solar panel, event after event, and measure the stack."""


#: Name of each command, the module in `snowshed.cli.commands` that has it, and what it does.
DEFERRED = (
    ("panel", "run", "Run slide-offs from a panel described by options."),
    ("run", "run", "Run a scene file."),
    ("extend", "extend", "Let more slabs slide off after a finished run, into a new folder."),
    ("slide", "slide", "Run a small snow slide on terrain."),
    ("grains", "grains", "Load segmented snow grain by grain."),
    ("plan", "scene", "Print the features and the cost of a scene file, without running it."),
    ("scene", "scene", "Write the scene that the same options of panel would run."),
    ("structure", "structure", "Write scenes of roofs, rows, tables, trackers and terrain."),
    ("schema", "scene", "Print the JSON Schema of a scene."),
    ("compare", "scene", "Compare the stack heights of two results folders."),
    ("lua", "lua", "Run a scene that Lua scripts describe, or write it as JSON."),
    ("study", "study", "Compute many runs of one scene whose parameters vary."),
    ("geometry", "regression", "Write the study of panel geometries that regress takes."),
    ("regress", "regression", "Regress stacks on panels: models, tables and figures."),
    ("predict", "regression", "Predict a stack's height and length without simulating it."),
    ("season", "season", "Simulate a winter: snow accumulates, is released and piles up."),
    ("clearance", "clearance", "Find how high a panel's lower edge must be to stay clear."),
    ("sensitivity", "sensitivity", "Find the snow parameters that matter for the stack."),
    ("calibrate", "calibration", "Find the snow whose simulated stacks agree with measured ones."),
    ("view", "view", "Write the moving view of a run as a page, or as a video."),
    ("grid", "grid", "Write the grid's mass, velocity and density for ParaView."),
    ("vdb", "vdb", "Write the snow of a run as OpenVDB files."),
    ("verify", "verify", "Check this installation against known answers, in seconds."),
    ("reproduce", "reproduce", "Reproduce a publication; needs the source of snowshed."),
)
for name, module, short_help in DEFERRED:
    cli.add_command(Deferred(name, f"snowshed.cli.commands.{module}", short_help))


def main(
    arguments: Optional[Sequence[str]] = None,
    *,
    command: click.Command = cli,
    name: str = "snowshed",
) -> int:
    """Run a command line and return its exit code.

    Parameters
    ----------
    arguments
        Arguments after the program's name. [default: those of the process]
    command
        The command to run; other programs of the project end in the same ways.
    name
        Name of the program in its help.
    """
    with warnings.catch_warnings():
        warnings.showwarning = _note
        try:
            code = _run(command, arguments, name)
            flush_output()
        except BrokenPipeError:  # of stdout, or of stderr with the message
            drop_output()
            code = PIPE_CLOSED
        return code


def _run(command: click.Command, arguments: Optional[Sequence[str]], name: str) -> int:
    streams = sys.stdout, sys.stderr
    given = sys.argv[1:] if arguments is None else arguments
    if not given and isinstance(command, click.Group):
        arguments = ["--help"]
    try:
        settings = cli.context_settings
        _refuse_bytes(sys.argv[1:] if arguments is None else arguments)
        return command.main(arguments, prog_name=name, standalone_mode=False, **settings) or 0
    except click.ClickException as error:
        if isinstance(error, NO_ARGUMENTS):  # of a group of commands: its help is the answer
            click.echo(error.message)
            return 0
        return _fail(error.format_message(), max(error.exit_code, 2))
    except SystemExit:  # of click, where a pipe broke, which it takes for that of the output
        sys.stdout, sys.stderr = streams
        if output_is_closed():
            raise BrokenPipeError from None
        return _fail("a helper program ended before it had read all", COULD_NOT_GO_ON)
    except OSError as error:
        said = f"{error.filename}: {error.strerror}" if error.filename else str(error)
        named = not error.errno or error.errno in OF_NAMES
        return _fail(said, BAD_INPUT if named else COULD_NOT_GO_ON)
    except _core.InputError as error:
        return _fail(str(error), BAD_INPUT)
    except _core.SimulationError as error:
        return _fail(str(error), COULD_NOT_GO_ON)
    except MemoryError as error:
        return _fail(memory_message(error), COULD_NOT_GO_ON)
    except (KeyboardInterrupt, click.Abort):
        return _fail("interrupted", INTERRUPTED)
    return 0


def _refuse_bytes(arguments: Sequence[str]) -> None:
    """Refuse names that are no UTF-8 before any work: scenes and tables could not hold them."""
    for argument in arguments:
        try:
            argument.encode()
        except UnicodeEncodeError:
            raise _core.InputError(f"{argument}: this name is not UTF-8") from None


def _note(
    message: Union[Warning, str],
    category: type[Warning],
    filename: str,
    lineno: int,
    file: Optional[TextIO] = None,
    line: Optional[str] = None,
) -> None:
    """Print a warning; one for users needs no place in the code."""
    if issubclass(category, (FutureWarning, SnowshedNote)):
        text = f"note: {message}\n"
    else:
        text = warnings.formatwarning(message, category, filename, lineno, line)
    (file or sys.stderr).write(printable(text))


def _fail(message: str, code: int) -> int:
    line = printable(" ".join(message.split()))
    print("error:", shortened(line, LONGEST_MESSAGE), file=sys.stderr)
    return code
