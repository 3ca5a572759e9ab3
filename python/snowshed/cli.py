"""The command line: ``snowshed panel|run|plan|scene|schema|compare``.

Exit codes: 0 done, 2 bad input, 3 the simulation could not go on, 130 interrupted. Errors are one
line on stderr.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, TypeVar

import click

from snowshed import _core
from snowshed.interrupt import Interrupted
from snowshed.scene import InitialisedScene
from snowshed.scene_options import in_terms_of_options, scene_from_options, scene_options

if TYPE_CHECKING:
    import pandas as pd

    from snowshed.events import Reporter

Command = TypeVar("Command", bound=Callable[..., Any])


def run_options(command: Command) -> Command:
    """Add the options of commands that run a scene."""
    folder = click.Path(path_type=Path)
    output = click.option(
        "-o", "--output", "folder", type=folder, required=True, help="Results folder, new or empty."
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
@scene_options
def panel(
    folder: Path,
    resume: bool,
    quiet: bool,
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
    _run(_initialise(preset, snow_preset, options), folder, resume, quiet)


@cli.command()
@click.argument("scene", type=click.Path(path_type=Path))
@run_options
def run(scene: Path, folder: Path, resume: bool, quiet: bool) -> None:
    """Run a scene file."""
    _run(InitialisedScene.load(scene), folder, resume, quiet)


@cli.command()
@click.argument("scene", type=click.Path(path_type=Path))
def plan(scene: Path) -> None:
    """Say what running a scene file would use and cost, without running it."""
    from snowshed import console

    ready = InitialisedScene.load(scene)
    console.print_plan(_core.plan(ready.json, ready.base_dir))


@cli.command()
@click.option(
    "-o", "--output", "file", type=click.Path(path_type=Path), help="File to write; else stdout."
)
@scene_options
def scene(
    file: Optional[Path], preset: Optional[str], snow_preset: Optional[str], **options: Any
) -> None:
    """Write the scene that the same options of ``panel`` would run."""
    ready = _initialise(preset, snow_preset, options)
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
    from snowshed import console
    from snowshed.compare import compare_folders

    console.print_ratios(compare_folders(one, other))


def main(arguments: Optional[Sequence[str]] = None) -> int:
    """Run the command line and return its exit code."""
    try:
        cli.main(arguments, prog_name="snowshed", standalone_mode=False)
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


class _Stopped(click.ClickException):
    """An interrupted run; click would swallow the exception itself and its message."""

    exit_code = 130


def _fail(message: str, code: int) -> int:
    print("error:", " ".join(message.split()), file=sys.stderr)
    return code


def _initialise(
    preset: Optional[str], snow_preset: Optional[str], options: dict[str, Any]
) -> InitialisedScene:
    try:
        return scene_from_options(preset, snow_preset, options).initialise()
    except _core.InputError as error:
        raise in_terms_of_options(error) from None


def _run(ready: InitialisedScene, folder: Path, resume: bool, quiet: bool) -> None:
    from snowshed.events import run_events

    try:
        with _progress(quiet) as progress:
            table = run_events(ready, folder, resume=resume, progress=progress)
    except Interrupted as interrupted:
        raise _Stopped(str(interrupted)) from None
    if not quiet:
        _show(table, folder)


@contextmanager
def _progress(quiet: bool) -> Iterator[Optional[Reporter]]:
    if quiet:
        yield None
        return
    from snowshed import console

    with console.progress_bar() as report:
        yield report


def _show(table: pd.DataFrame, folder: Path) -> None:
    from snowshed import console

    console.print_events(table, folder)
