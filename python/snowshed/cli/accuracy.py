"""The option ``--accuracy``: grid and scheme for a wanted accuracy, from recorded measurements.

Accuracy means the errors of the stack's height and length. They are recorded for runs of the
laboratory experiment on several grids and with several schemes. The size of cells counts relative
to the thickness of the slab.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import nan
from typing import TYPE_CHECKING, Any, Optional

import click

from snowshed._core import InputError
from snowshed.base.formatting import percent
from snowshed.cli.scene_options import option_name
from snowshed.methods.registry import resolution_path
from snowshed.scene.accuracy_settings import ACCURACY
from snowshed.scene.scene import Scene
from snowshed.scene.schema import current_path

if TYPE_CHECKING:
    from snowshed.analysis.accuracy.measurements import Measurement, Value
    from snowshed.analysis.accuracy.recorded_stacks import RecordedStack


def part(text: str) -> float:
    """Return a fraction, given as ``5%`` or ``0.05``.

    Examples
    --------
    >>> [part(text) for text in ("5%", "0.05", "2.5 %")]
    [0.05, 0.05, 0.025]
    """
    text = text.strip()
    try:
        value = float(text[:-1]) / 100 if text.endswith("%") else float(text)
    except ValueError:
        value = nan
    if not 0 < value < 1:
        raise click.BadParameter(f"{text!r} is not an accuracy; give a percentage such as 5%")
    return value


accuracy_option = click.option(
    "--accuracy",
    type=part,
    metavar="PERCENT",
    help="Choose dx and scheme by how far the height and length of stacks may be off, such as 5%, "
    "from recorded runs.",
)


@dataclass(frozen=True)
class Choice:
    """Settings chosen for a wanted accuracy.

    Attributes
    ----------
    reached
        Whether the recorded runs with these settings were accurate enough.
    values
        Chosen values by their paths in a scene; None for a setting that keeps its default.
    reason
        The choice and its reason, in sentences.
    """

    reached: bool
    values: Mapping[str, Optional[Value]]
    reason: str


def choose(
    wanted: float, scene: Scene, measurements: Optional[Iterable[Measurement]] = None
) -> Choice:
    """Choose the quickest settings whose stacks were as accurate as wanted in recorded runs.

    If none was accurate enough, the most accurate settings are chosen, and the reason says so.

    Parameters
    ----------
    wanted
        Largest relative error of the stack's height and length.
    scene
        The scene that the settings are for; it needs a slab.
    measurements
        Measurements of the case "stack_convergence"; by default those of the package.

    Raises
    ------
    InputError
        If the scene has no slab, or there are no measurements.

    Examples
    --------
    >>> choice = choose(0.2, Scene.preset("geometry"))
    >>> choice.values["numerics.dx"] > 0
    True
    """
    from snowshed.analysis.accuracy.recorded import load_recorded
    from snowshed.analysis.accuracy.recorded_stacks import (
        CASE,
        PRESET_THICKNESS,
        circumstances,
        nearest,
        recorded_stacks,
        slab_thickness,
    )
    from snowshed.analysis.accuracy.solutions import quickest

    data = scene.resolve().data
    thickness = slab_thickness(data)
    if thickness is None:
        raise InputError(
            "--accuracy: the scene has no slab, whose thickness determines dx; give --dx"
        )
    listed = load_recorded() if measurements is None else measurements
    stacks = nearest(recorded_stacks(listed), circumstances(data))
    if not stacks:
        raise InputError(
            "--accuracy: nothing is recorded to choose from; in the source of snowshed, "
            f"`python -m validation --full --case {CASE} --record FILE -o DIR` makes it"
        )
    costs, errors = [stack.wall_s for stack in stacks], [stack.error for stack in stacks]
    stack = stacks[quickest(costs, errors, wanted)]
    path = resolution_path(data)
    name = path.rpartition(".")[2]
    share = float(stack.settings[name]) / PRESET_THICKNESS
    # A recorded run used the defaults of unnamed settings, so they must be defaults here, too.
    values = {where: stack.settings.get(key) for key, where in ACCURACY.items()}
    size = float(f"{share * thickness:.3g}")
    values[path] = size
    what = f"{name} {size:g} m ({share:.3g} of the slab's thickness)"
    reason = " ".join(
        [f"--accuracy {percent(wanted)}: {what}", *_reasons(stack, wanted, data, name)]
    )
    return Choice(stack.error <= wanted, values, reason)


def check_alone(options: Mapping[str, Any]) -> None:
    """Raise InputError if an option is given that ``--accuracy`` would override.

    Parameters
    ----------
    options
        Values by the names that `snowshed.cli.scene_options` gives them; None where not given.

    Examples
    --------
    >>> check_alone({"panel__tilt": 50.0, "numerics__basis": None})
    """
    for name, value in options.items():
        given = name.replace("__", ".")
        if value is not None and current_path(given) in ACCURACY.values():
            raise InputError(
                f"{option_name(given)}: --accuracy chooses grid and scheme; give one of the two"
            )


def _reasons(stack: RecordedStack, wanted: float, data: Mapping[str, Any], name: str) -> list[str]:
    """Return the end of the first sentence, after the setting `name`, and the further sentences."""
    from snowshed.analysis.accuracy.recorded_stacks import PRESET, QUANTITIES, circumstances
    from snowshed.analysis.accuracy.setting_labels import settings

    scheme = {k: v for k, v in stack.settings.items() if k in ACCURACY and k != name}
    height, length = (percent(error, 2) for error in stack.errors)
    off = f"the height of the stack was off by {height} and its length by {length}"
    if stack.error <= wanted:
        why = f"These were the quickest in the recorded runs of {PRESET} to stay within it: {off}."
    else:
        why = f"No recorded run of {PRESET} was that accurate. In the best, which this is, {off}."
    reasons = [f"with {settings(scheme) or 'the default scheme'}.", why]
    if len(stack.spreads) == len(QUANTITIES):
        height, length = (percent(spread, 2) for spread in stack.spreads)
        reasons.append(f"Random seedings alone made them differ by {height} and {length}.")
    mine = circumstances(data)
    other = {k: v for k, v in stack.settings.items() if k in mine and v != mine[k]}
    if other:
        reasons.append(f"Unlike this scene, those runs were made with {settings(other)}.")
    return reasons
