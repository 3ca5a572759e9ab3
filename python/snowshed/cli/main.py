"""The command line: the list of commands, and their exit codes.

``panel|run|lua`` run a scene, ``slide`` a slide on terrain, ``grains`` a loading test of segmented
snow. ``release-areas`` finds candidates for the release of slides.
``scene|structure|schema`` describe a scene. ``study`` computes many runs, ``season`` a
winter, and ``clearance`` many winters, to find the height that a panel needs.
``compare|sensitivity|calibrate`` answer questions about runs, and ``geometry|regress|predict``
treat the data set of panels.

Exit codes: 0: done; 2: bad input, nothing was written; 3: the run started but could not finish
(simulation failed, disk full, out of memory); 130: interrupted; 141: the reader of the output left,
as `head` does. Errors are one line on stderr.
"""

from __future__ import annotations

import errno
import sys
import warnings
from collections.abc import Sequence
from typing import Optional, TextIO, Union

import click

import snowshed._core as _core
from snowshed.base.callers import called_from_shell
from snowshed.base.messages import printable, shortened
from snowshed.base.notes import SnowshedNote
from snowshed.cli.deferred import Deferred
from snowshed.cli.exit_codes import BAD_INPUT, COULD_NOT_FINISH, INTERRUPTED, PIPE_CLOSED
from snowshed.cli.memory_shortage import memory_message
from snowshed.cli.output.pipe import drop_output, flush_output, output_is_closed

#: Errors in file names that the user gave.
NAME_ERRORS = (
    *(errno.ENOENT, errno.ENOTDIR, errno.EISDIR, errno.EEXIST, errno.ENOTEMPTY, errno.EACCES),
    *(errno.EPERM, errno.ENAMETOOLONG, errno.ELOOP, errno.EINVAL, errno.ENXIO, errno.EROFS),
)
#: Raised by click for a group of commands without arguments; before 8.2 it printed the help.
NO_ARGUMENTS: type = getattr(click.exceptions, "NoArgsIsHelpError", type(None))
MAX_MESSAGE = 4000  # characters


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(_core.version, prog_name="snowshed")
def cli() -> None:
    """Simulate snow that slides off a solar panel, event after event, and measure the stack."""


#: Name of each command, its module in `snowshed.cli.commands`, and its short help.
DEFERRED = (
    ("panel", "panel", "Run slide-offs from a panel described by options."),
    ("run", "run", "Run a scene file."),
    ("repeat", "repeat", "Compute a run, study, season or clearance again from its record."),
    ("extend", "extend", "Add slide-offs to a finished run, in a new folder."),
    ("slide", "slide", "Run a small snow slide on terrain."),
    ("release-areas", "release_areas", "Find candidate release areas by the terrain's shape."),
    ("grains", "grains", "Segment images of snow, and run loading tests of its grains."),
    ("scene", "scene", "Write the scene that the same options of panel would run."),
    ("structure", "structure", "Write scenes of roofs, rows, tables, trackers and terrain."),
    ("schema", "scene", "Print the JSON Schema of a scene."),
    ("compare", "compare", "Compare the stack heights of two results folders."),
    ("lua", "lua", "Run a scene that Lua scripts describe, or write it as JSON."),
    ("study", "study", "Compute many runs of one scene whose parameters vary."),
    ("geometry", "geometry", "Write the study of panel geometries for regress."),
    ("regress", "regress", "Regress stacks on panels: models, tables and figures."),
    ("predict", "predict", "Predict a stack's height and length without a simulation."),
    ("season", "season", "Simulate a winter: snow accumulates, is released and piles up."),
    ("clearance", "clearance", "Find how high a panel's lower edge must be to stay clear."),
    ("loads", "loads", "Find the loads of the snow on structures."),
    ("sensitivity", "sensitivity", "Find the snow parameters that matter for the stack."),
    ("calibrate", "calibrate", "Find the snow whose simulated stacks agree with measured ones."),
    ("view", "view", "Write the moving view of a run as a page, or as a video."),
    ("grid", "grid", "Write the grid's mass, velocity and density for ParaView."),
    ("maps", "maps", "Write the maps of a slide as NetCDF."),
    ("vdb", "vdb", "Write the snow of a run as OpenVDB files."),
    ("self-test", "self_test", "Test this installation against known answers, in seconds."),
    ("reproduce", "reproduce", "Reproduce a publication; needs the source of snowshed."),
)
#: Former names of commands, which the help leaves out.
FORMER_COMMANDS = (("plan", "run", "plan"), ("verify", "self_test", "self-test"))


def _add_commands() -> None:
    for name, module, short_help in DEFERRED:
        cli.add_command(Deferred(name, f"snowshed.cli.commands.{module}", short_help))
    for name, module, command in FORMER_COMMANDS:
        module_name = f"snowshed.cli.commands.{module}"
        cli.add_command(Deferred(name, module_name, hidden=True, command=command))


_add_commands()


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
        The command to run; other programs of the project share the exit codes.
    name
        Name of the program in its help.
    """
    with warnings.catch_warnings(), called_from_shell():
        warnings.showwarning = _note
        try:
            code = _run(command, arguments, name)
            flush_output()
        except BrokenPipeError:  # the reader of stdout, or of stderr with the message, has left
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
        if isinstance(error, NO_ARGUMENTS):  # a group without a command: its help is printed
            click.echo(error.message)
            return 0
        return _fail(error.format_message(), max(error.exit_code, 2))
    except SystemExit:  # click exits so after any broken pipe, not only after that of the output
        sys.stdout, sys.stderr = streams
        if output_is_closed():
            raise BrokenPipeError from None
        return _fail("a helper program ended before it had read its input", COULD_NOT_FINISH)
    except OSError as error:
        message = f"{error.filename}: {error.strerror}" if error.filename else str(error)
        bad_name = not error.errno or error.errno in NAME_ERRORS
        return _fail(message, BAD_INPUT if bad_name else COULD_NOT_FINISH)
    except _core.InputError as error:
        return _fail(str(error), BAD_INPUT)
    except _core.SimulationError as error:
        return _fail(str(error), COULD_NOT_FINISH)
    except MemoryError as error:
        return _fail(memory_message(error), COULD_NOT_FINISH)
    except (KeyboardInterrupt, click.Abort):
        return _fail("interrupted", INTERRUPTED)
    return 0


def _refuse_bytes(arguments: Sequence[str]) -> None:
    """Refuse arguments that are not UTF-8, because scenes and tables cannot hold them."""
    for argument in arguments:
        try:
            argument.encode()
        except UnicodeEncodeError:
            raise _core.InputError(f"{argument}: the name is not UTF-8") from None


def _note(
    message: Union[Warning, str],
    category: type[Warning],
    filename: str,
    lineno: int,
    file: Optional[TextIO] = None,
    line: Optional[str] = None,
) -> None:
    """Print a warning; notes for users come without a line of code."""
    if issubclass(category, (FutureWarning, SnowshedNote)):
        text = f"note: {message}\n"
    else:
        text = warnings.formatwarning(message, category, filename, lineno, line)
    (file or sys.stderr).write(printable(text))


def _fail(message: str, code: int) -> int:
    line = printable(" ".join(message.split()))
    print("error:", shortened(line, MAX_MESSAGE), file=sys.stderr)
    return code
