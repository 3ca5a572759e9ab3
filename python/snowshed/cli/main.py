"""The command line: which commands there are, and how they end.

One event loop: ``snowshed panel|run|lua``; scenes and forecasts: ``scene|plan|schema``; many runs:
``study``; a winter: ``season``; questions about them: ``compare|sensitivity|calibrate``; the data
set of panels: ``geometry|regress|predict``.

Exit codes: 0 done, 2 bad input, 3 the simulation could not go on, 130 interrupted. Errors are one
line on stderr.
"""

from __future__ import annotations

import importlib
import sys
import warnings
from collections.abc import Sequence
from typing import Any, Optional, Union

import click

import snowshed._core as _core


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(_core.version, prog_name="snowshed")
def cli() -> None:
    """Simulate snow that slides off a solar panel, event after event, and measure the stack."""


class Deferred(click.Command):
    """A command, or group of commands, that is imported when it is used; all others start quickly.

    Parameters
    ----------
    name
        As of the command it stands for, and of the function that makes it.
    module
        The module that defines it.
    short_help
        What the list of commands says of it, which does not import it.
    """

    def __init__(self, name: str, module: str, short_help: str) -> None:
        super().__init__(name, short_help=short_help)
        self._module = module

    def make_context(
        self,
        info_name: Optional[str],
        args: list[str],
        parent: Optional[click.Context] = None,
        **extra: Any,
    ) -> click.Context:
        """Return the context of the command itself, which takes over from here."""
        return self.load().make_context(info_name, args, parent, **extra)

    def load(self) -> click.Command:
        """Return the command itself."""
        command: click.Command = getattr(importlib.import_module(self._module), str(self.name))
        return command


#: Name of each command, the module in `snowshed.cli.commands` that has it, and what it does.
DEFERRED = (
    ("panel", "run", "Run slide-offs from a panel described by options."),
    ("run", "run", "Run a scene file."),
    ("plan", "scene", "Say what running a scene file would use and cost, without running it."),
    ("scene", "scene", "Write the scene that the same options of panel would run."),
    ("schema", "scene", "Print the JSON Schema of a scene."),
    ("compare", "scene", "Compare the stack heights of a 3D and a 2D results folder."),
    ("lua", "lua", "Run a scene that Lua scripts describe, or leave Lua behind."),
    ("study", "study", "Compute many runs: one scene, and parameters that vary."),
    ("geometry", "regression", "Write the study of panel geometries that regress takes."),
    ("regress", "regression", "Regress stacks on panels: models, tables and figures."),
    ("predict", "regression", "Predict a stack's height and length without simulating it."),
    ("season", "season", "Let the snow of a season gather, let go and pile up."),
    ("sensitivity", "sensitivity", "Find which snow parameters matter for the stack."),
    ("calibrate", "calibration", "Find the snow whose simulated stacks are those measured."),
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
        What follows the program's name.  [default: as the process was given them]
    command
        What to run; other programs than snowshed itself end in the same ways.
    name
        The program, as its help calls it.
    """
    with warnings.catch_warnings():
        warnings.showwarning = _note
        return _run(command, arguments, name)


def _run(command: click.Command, arguments: Optional[Sequence[str]], name: str) -> int:
    try:
        settings = cli.context_settings
        return command.main(arguments, prog_name=name, standalone_mode=False, **settings) or 0
    except click.ClickException as error:
        return _fail(error.format_message(), max(error.exit_code, 2))
    except OSError as error:
        return _fail(f"{error.filename}: {error.strerror}" if error.filename else str(error), 2)
    except _core.InputError as error:
        return _fail(str(error), 2)
    except _core.SimulationError as error:
        return _fail(str(error), 3)
    except (KeyboardInterrupt, click.Abort):
        return _fail("interrupted", 130)
    return 0


def _note(message: Union[Warning, str], category: type[Warning], *where: object) -> None:
    """Print a warning for users, which needs no place in the code."""
    print("note:", message, file=sys.stderr)


def _fail(message: str, code: int) -> int:
    print("error:", " ".join(message.split()), file=sys.stderr)
    return code
