"""The commands that describe a scene: ``snowshed scene|plan|schema|compare``."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Optional

import click

import snowshed._core as _core
from snowshed._core import InputError
from snowshed.base.notes import tell
from snowshed.cli.accuracy import accuracy_option, check_alone, choose
from snowshed.cli.quiet import quiet_option
from snowshed.cli.scene_options import in_terms_of_options, scene_from_options, scene_options
from snowshed.cli.terminal import say, write_out
from snowshed.running.scene_notes import notes_of_beginning
from snowshed.scene.scene import ResolvedScene, Scene

PATH = click.Path(path_type=Path)


@click.command()
@click.argument("scene", type=PATH)
@accuracy_option
def plan(scene: Path, accuracy: Optional[float]) -> None:
    """Print the features and the cost of a scene file, without running it."""
    from snowshed.cli import console

    ready = ResolvedScene.load(scene)
    if accuracy is not None:
        ready = _accurate(Scene.load(scene), accuracy).resolve()
    console.print_plan(_core.plan(ready.core, ready.base_dir))
    _tell_of_beginning(ready)


def _tell_of_beginning(ready: ResolvedScene) -> None:
    """Say what a run of a scene would say before its first step."""
    for note in notes_of_beginning(ready):
        tell(note)


@click.command()
@click.option("-o", "--output", "file", type=PATH, help="File to write; else stdout.")
@quiet_option
@accuracy_option
@scene_options
def scene(
    file: Optional[Path],
    quiet: bool,
    accuracy: Optional[float],
    preset: Optional[str],
    snow_preset: Optional[str],
    **options: Any,
) -> None:
    """Write the scene that the same options of ``panel`` would run."""
    ready = resolve_options(preset, snow_preset, options, accuracy, quiet=quiet)
    _tell_of_beginning(ready)
    if file is None:
        write_out(ready.json)
    else:
        ready.save(file)


@click.command()
def schema() -> None:
    """Print the JSON Schema of a scene."""
    write_out(_core.scene_schema())


@click.command()
@click.argument("one", type=PATH)
@click.argument("other", type=PATH)
def compare(one: Path, other: Path) -> None:
    """Compare the stack heights of two results folders.

    Of a 3D and a 2D run the ratio stands beside the rule of thumb of the thesis.
    """
    from snowshed.cli import console
    from snowshed.results.dimension_ratio import compare_folders, height_ratio, same_dimension

    if same_dimension(one, other):
        console.print_heights(height_ratio(one, other), one.name, other.name)
    else:
        console.print_ratios(compare_folders(one, other))


def resolve_options(
    preset: Optional[str],
    snow_preset: Optional[str],
    options: Mapping[str, Any],
    accuracy: Optional[float],
    *,
    quiet: bool = False,
) -> ResolvedScene:
    """Return the scene that options describe; errors name the options."""
    try:
        scene = scene_from_options(preset, snow_preset, options)
        if accuracy is not None:
            check_alone(options)
            scene = _accurate(scene, accuracy, quiet=quiet)
        return scene.resolve()
    except InputError as error:
        raise in_terms_of_options(error) from None


def _accurate(scene: Scene, accuracy: float, *, quiet: bool = False) -> Scene:
    """Return the scene with dx and scheme chosen for an accuracy, and print the choice."""
    choice = choose(accuracy, scene)
    if not quiet:
        say(choice.reason, err=True)
    return scene.update(choice.values)
