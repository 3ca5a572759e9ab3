"""Options without effect: refused, or noted where they follow from others."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

import click
from click.core import ParameterSource

from snowshed.base.notes import InputNote, issue_note
from snowshed.cli.options.scene import option_name


def refuse_without_effect(names: Sequence[str], reason: str) -> None:
    """Refuse options of the current command that are given, because they would be ignored.

    Parameters
    ----------
    names
        Parameters of the command.
    reason
        Reason why they are ineffective, such as "without --range".

    Raises
    ------
    click.UsageError
        Naming the first such option.
    """
    refuse_given(names, f"has no effect {reason}")


def refuse_given(names: Sequence[str], complaint: str) -> None:
    """Refuse options of the current command that are given; the complaint follows their name.

    Raises
    ------
    click.UsageError
        Naming the first such option.
    """
    context = click.get_current_context()
    for parameter in context.command.params:
        name = str(parameter.name)
        if name in names and context.get_parameter_source(name) is ParameterSource.COMMANDLINE:
            raise click.UsageError(f"{longest_name(parameter)} {complaint}")


def longest_name(parameter: click.Parameter) -> str:
    """Return the longest name of an option, such as ``--output``."""
    return max(parameter.opts, key=len)


def note_options_without_effect(
    given: Collection[str], scene: Mapping[str, Any], *, events_known: bool = True
) -> None:
    """Issue a note on each given option of a scene that its other options make ineffective.

    The core notes frictions that sticky parts do not use.

    Parameters
    ----------
    given
        Paths of the parameters whose options are given.
    scene
        Complete scene data.
    events_known
        Whether the scene has the number of events; that of a season follows from the weather.
    """
    reasons: dict[str, str] = {}
    if scene["dimension"] == 2:
        reasons.update(dict.fromkeys(("panel.width", "slab.width"), "the scene is 2D (--dim 2)"))
    if events_known and scene["events"]["count"] == 1:
        reasons["events.between"] = "there is a single event (--events 1)"
    for path, reason in reasons.items():
        if path in given:
            issue_note(f"{option_name(path)} has no effect: {reason}", InputNote)
