"""The scene that the options of a command describe."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Optional

from snowshed._core import InputError
from snowshed.cli.options.accuracy import check_alone, choose
from snowshed.cli.options.no_effect import note_options_without_effect
from snowshed.cli.options.scene import given_options, in_terms_of_options, scene_from_options
from snowshed.cli.output.terminal import say
from snowshed.scene.scene import ResolvedScene, Scene


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
            scene = with_accuracy(scene, accuracy, quiet=quiet)
        resolved = scene.resolve()
    except InputError as error:
        raise in_terms_of_options(error) from None
    note_options_without_effect(given_options(options), resolved.data)
    return resolved


def with_accuracy(scene: Scene, accuracy: float, *, quiet: bool = False) -> Scene:
    """Return the scene with dx and scheme chosen for an accuracy, and print the choice.

    Raises
    ------
    InputError
        If no recorded run was that accurate; the message names the best recorded accuracy.
    """
    choice = choose(accuracy, scene)
    if not choice.reached:
        raise InputError(choice.reason)
    if not quiet:
        say(choice.reason, err=True)
    return scene.update(choice.values)
