"""The command line.

One event loop: ``snowshed panel|run|lua``; scenes and forecasts: ``scene|plan|schema``; many runs:
``study``; a winter: ``season``; questions about them: ``compare|sensitivity|calibrate``; the data
set of panels: ``geometry|regress|predict``; what it can be trusted in:
``verify|reproduce``.

Exit codes: 0 done, 1 verified and something does not hold, 2 bad input, 3 the simulation could not
go on, 130 interrupted. Errors are one line on stderr.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, TypeVar

import click

from snowshed import _core
from snowshed.cli.accuracy import accuracy_option, check_alone, choose
from snowshed.cli.exit_codes import Stopped
from snowshed.cli.scene_options import in_terms_of_options, scene_from_options, scene_options
from snowshed.run.interrupt import Interrupted
from snowshed.scene.scene import ResolvedScene, Scene

if TYPE_CHECKING:
    import pandas as pd

    from snowshed.run.events import Reporter

Command = TypeVar("Command", bound=Callable[..., Any])


def run_options(command: Command, *, required: bool = True) -> Command:
    """Add the options of commands that run a scene; `required`: that they cannot do without."""
    folder = click.Path(path_type=Path)
    output = click.option(
        "-o",
        "--output",
        "folder",
        type=folder,
        required=required,
        help="Results folder, new or empty.",
    )
    resume = click.option("--resume", is_flag=True, help="Go on from the checkpoint in the folder.")
    quiet = click.option("-q", "--quiet", is_flag=True, help="Print nothing but errors.")
    return output(resume(quiet(command)))


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(_core.version, prog_name="snowshed")
def cli() -> None:
    """Simulate snow that slides off a solar panel, event after event, and measure the stack."""


@cli.command()
@run_options
@accuracy_option
@scene_options
def panel(
    folder: Path,
    resume: bool,
    quiet: bool,
    accuracy: Optional[float],
    preset: Optional[str],
    snow_preset: Optional[str],
    **options: Any,
) -> None:
    """Run slide-offs from a panel described by options.

    \b
    Example:
      snowshed panel --height 0.33 --length 0.245 --width 0.213 --tilt 50 \\
          --thickness 0.02 --events 5 --dim 3 --friction 0.3 -o results
    """  # noqa: D301 - click wants the control character
    ready = _resolve(preset, snow_preset, options, accuracy, quiet=quiet)
    _run(ready, folder, resume, quiet)


@cli.command()
@click.argument("scene", type=click.Path(path_type=Path))
@run_options
def run(scene: Path, folder: Path, resume: bool, quiet: bool) -> None:
    """Run a scene file."""
    _run(ResolvedScene.load(scene), folder, resume, quiet)


@cli.command()
@click.argument("scene", type=click.Path(path_type=Path))
@accuracy_option
def plan(scene: Path, accuracy: Optional[float]) -> None:
    """Say what running a scene file would use and cost, without running it."""
    from snowshed.cli import console

    ready = ResolvedScene.load(scene)
    if accuracy is not None:
        ready = _accurate(Scene.load(scene), accuracy).resolve()
    console.print_plan(_core.plan(ready.json, ready.base_dir))


@cli.command()
@click.option(
    "-o", "--output", "file", type=click.Path(path_type=Path), help="File to write; else stdout."
)
@accuracy_option
@scene_options
def scene(
    file: Optional[Path],
    accuracy: Optional[float],
    preset: Optional[str],
    snow_preset: Optional[str],
    **options: Any,
) -> None:
    """Write the scene that the same options of ``panel`` would run."""
    ready = _resolve(preset, snow_preset, options, accuracy)
    if file is None:
        click.echo(ready.json)
    else:
        ready.save(file)


@cli.command()
def schema() -> None:
    """Print the JSON Schema of a scene."""
    click.echo(_core.scene_schema())


@cli.command()
@click.argument("one", type=click.Path(path_type=Path))
@click.argument("other", type=click.Path(path_type=Path))
def compare(one: Path, other: Path) -> None:
    """Compare the stack heights of a 3D and a 2D results folder."""
    from snowshed.analysis.dimension_ratio import compare_folders
    from snowshed.cli import console

    console.print_ratios(compare_folders(one, other))


@cli.command()
@click.argument("init", type=click.Path(path_type=Path))
@click.argument("update", type=click.Path(path_type=Path), required=False)
@click.option(
    "--to-json",
    "file",
    type=click.Path(path_type=Path),
    help="Write the scene to this file; if the scripts name runs, one file each to this folder.",
)
@partial(run_options, required=False)
def lua(
    init: Path,
    update: Optional[Path],
    file: Optional[Path],
    folder: Optional[Path],
    resume: bool,
    quiet: bool,
) -> None:
    """Run a scene that Lua scripts describe, or leave Lua behind.

    UPDATE runs after INIT; its values override those before. Needs the extra snowshed[lua].
    """
    from snowshed.cli.commands.lua import load, run_all, save_all

    if file is None and folder is None:
        raise click.UsageError("give -o DIR to run the scene, or --to-json FILE to write it")
    runs = load(init, update, quiet=quiet)
    if file is not None:
        save_all(runs, file)
    if folder is not None:
        run_all(runs, folder, partial(_run, quiet=quiet), resume=resume, quiet=quiet)


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


DEFERRED = (
    ("study", "study", "Compute many runs: one scene, and parameters that vary."),
    ("geometry", "regression", "Write the study of panel geometries that regress takes."),
    ("regress", "regression", "Regress stacks on panels: models, tables and figures."),
    ("predict", "regression", "Predict a stack's height and length without simulating it."),
    ("season", "season", "Let the snow of a season gather, let go and pile up."),
    ("sensitivity", "sensitivity", "Find which snow parameters matter for the stack."),
    ("calibrate", "calibration", "Find the snow whose simulated stacks are those measured."),
    ("vdb", "vdb", "Write the snow of a run as OpenVDB files."),
)
for name, module, short_help in DEFERRED:
    cli.add_command(Deferred(name, f"snowshed.cli.commands.{module}", short_help))


def main(arguments: Optional[Sequence[str]] = None) -> int:
    """Run the command line and return its exit code."""
    try:
        return cli.main(arguments, prog_name="snowshed", standalone_mode=False) or 0
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


def _fail(message: str, code: int) -> int:
    print("error:", " ".join(message.split()), file=sys.stderr)
    return code


def _resolve(
    preset: Optional[str],
    snow_preset: Optional[str],
    options: dict[str, Any],
    accuracy: Optional[float],
    *,
    quiet: bool = False,
) -> ResolvedScene:
    try:
        scene = scene_from_options(preset, snow_preset, options)
        if accuracy is not None:
            check_alone(options)
            scene = _accurate(scene, accuracy, quiet=quiet)
        return scene.resolve()
    except _core.InputError as error:
        raise in_terms_of_options(error) from None


def _accurate(scene: Scene, accuracy: float, *, quiet: bool = False) -> Scene:
    """Return the scene with dx and scheme chosen for an accuracy, and say so."""
    choice = choose(accuracy, scene)
    if not quiet:
        click.echo(choice.reason, err=True)
    return scene.update(choice.values)


def _run(ready: ResolvedScene, folder: Path, resume: bool, quiet: bool) -> None:
    from snowshed.run.events import run_events

    try:
        with _progress(quiet) as progress:
            table = run_events(ready, folder, resume=resume, progress=progress)
    except Interrupted as interrupted:
        raise Stopped(str(interrupted)) from None
    if not quiet:
        _show(table, folder)


@contextmanager
def _progress(quiet: bool) -> Iterator[Optional[Reporter]]:
    if quiet:
        yield None
        return
    from snowshed.cli import console

    with console.progress_bar() as report:
        yield report


def _show(table: pd.DataFrame, folder: Path) -> None:
    from snowshed.cli import console

    console.print_events(table, folder)
